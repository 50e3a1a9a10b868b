#pragma once

#include <array>
#include <span>
#include <vector>

#include "kernels/device/expression_program.hpp"
#include "kernels/stepping/motion_interval.hpp"

namespace drogue::stepping {

/// Division of the time from 0 to `end`, s, > 0, by an expression of time at up to nine of the `places`, m,
/// as `motion_intervals`, with rates of zero. Throws std::bad_alloc.
[[nodiscard]] std::vector<MotionInterval> expression_intervals(const device::ExpressionProgram& program,
                                                               std::span<const std::array<double, 3>> places,
                                                               double end);

/// Least `longest` of the intervals between two times, s; infinite for none. Does not throw.
[[nodiscard]] double shortest_interval(std::span<const MotionInterval> intervals, double begin, double end);

}  // namespace drogue::stepping
