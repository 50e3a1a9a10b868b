#pragma once

#include <vector>

#include "kernels/coupling/sheet/parameters.hpp"

namespace drogue::coupling {

/// Division of the time to `flow::Parameters::horizon` by the prescribed motion of the cloth, each motion
/// sampled at up to nine of its vertices; empty without one. Throws std::bad_alloc.
[[nodiscard]] std::vector<stepping::MotionInterval> vertex_motion(const Parameters& parameters);

}  // namespace drogue::coupling
