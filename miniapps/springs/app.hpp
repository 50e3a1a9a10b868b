#pragma once

#include "common/program/failure.hpp"
#include "common/program/mini_app_options.hpp"

namespace drogue::springs_app {

/// Does what the command line asks for. Throws Failure; the exit code of an interrupted run is returned.
ExitCode run_app(const MiniAppOptions& options);

}  // namespace drogue::springs_app
