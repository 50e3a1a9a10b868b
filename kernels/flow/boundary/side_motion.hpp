#pragma once

#include <vector>

#include "kernels/flow/parameters.hpp"

namespace drogue::flow {

/// Division of the time to `Parameters::horizon` by the motion of the sides, sampled at up to nine points
/// along each axis of a side, and by `Parameters::motion`; empty without prescribed motion. Throws
/// std::bad_alloc.
[[nodiscard]] std::vector<stepping::MotionInterval> side_motion(const Parameters& parameters);

/// Largest |u|/hx + |v|/hy + |w|/hz of the sides whose velocity is constant, 1/s, without axes of one cell.
/// Does not throw.
[[nodiscard]] double rate_of_constant_sides(const Parameters& parameters);

}  // namespace drogue::flow
