#pragma once

#include "common/program/communicator.hpp"
#include "common/program/mini_app_options.hpp"

namespace drogue::parachute_app {

/// Work of a rank other than 0: does what `SharedSolver` requests until rank 0 sends an empty message. Leaves
/// reports of failures to rank 0. Throws only for a faulty message.
void serve(Communicator& communicator, const MiniAppOptions& options);

}  // namespace drogue::parachute_app
