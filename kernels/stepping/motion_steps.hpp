#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include <Kokkos_Core.hpp>

#include "kernels/device/expression_program.hpp"
#include "kernels/stepping/motion_interval.hpp"

// Bounds of dt from prescribed motion, known before a run: steps resolve its changes, and none is blind to
// what will move within it.

namespace drogue::stepping {

/// Prescribed motion, sampled before a run.
struct PrescribedMotion {
  /// Values at a time, s: each counts by its own range. Does not throw.
  std::function<void(double time, std::span<double> values)> evaluate;
  std::size_t values = 0;
  /// Speed over cell widths, 1/s, between two times, s, from the values there. Does not throw.
  std::function<double(double dt, std::span<const double> before, std::span<const double> after)> rate;
  std::vector<double> times;  ///< s, at which it may jump, say the constants of its expression
};

/// Divides the time from 0 to `end`, s, > 0. A sine has some 20 intervals a period. A jump takes the time
/// between two neighbouring numbers; its interval begins just before it. `longest` is at most a twentieth of
/// the time between two jumps. Values that are not finite count as
/// zero. Motion that changes too often for a list of a million intervals keeps the shortest `longest` found.
/// Throws std::bad_alloc.
[[nodiscard]] std::vector<MotionInterval> motion_intervals(const PrescribedMotion& motion, double end);

/// Intervals that hold for both motions. Throws std::bad_alloc.
[[nodiscard]] std::vector<MotionInterval> merged(const std::vector<MotionInterval>& a,
                                                 const std::vector<MotionInterval>& b);

/// Constants of expressions of time that may be times of jumps, s. Throws std::bad_alloc.
[[nodiscard]] std::vector<double> constants_of(std::span<const device::ExpressionProgram> programs);

/// Bound of a step from prescribed motion.
struct MotionBound {
  double dt;                  ///< s
  double jump;                ///< s, time of a jump within it, at which a step ends; infinite: none
  bool follows_jump = false;  ///< the step begins with a jump
};

/// Part of the time of a jump by which another time counts as that of the jump.
inline constexpr double jump_width = 1e-12;

/// Number of the interval that holds a time, s. `intervals` has `count` entries, at least one.
KOKKOS_INLINE_FUNCTION int interval_at(const MotionInterval* intervals, int count, double time) {
  int at = 0, end = count;
  while (end - at > 1) {
    const int middle = at + (end - at) / 2;
    (intervals[middle].begin <= time ? at : end) = middle;
  }
  return at;
}

/// Interval whose jump has this time, s; null if there is none. `intervals` has `count` entries, perhaps
/// none.
KOKKOS_INLINE_FUNCTION const MotionInterval* jump_at(const MotionInterval* intervals, int count,
                                                     double time) {
  // Another interval begins just after a jump.
  for (int i = count > 0 ? interval_at(intervals, count, time) : -1; i >= 0; --i) {
    if (time - intervals[i].begin > jump_width * intervals[i].begin) break;
    if (intervals[i].begins_with != 0) return intervals + i;
  }
  return nullptr;
}

/// `time`, s, or just before the jump that has this time: a step that ends there has the values before it.
KOKKOS_INLINE_FUNCTION double time_before_jump(const MotionInterval* intervals, int count, double time) {
  const MotionInterval* jump = jump_at(intervals, count, time);
  return jump != nullptr ? jump->begin : time;
}

/// Shortens `steps` equal steps of `dt` from `time`, s, so that they resolve the motion, and dt times the
/// rate of what moves within them is at most `cfl`. `intervals` has `count` entries, at least one.
KOKKOS_INLINE_FUNCTION MotionBound bound_by_motion(const MotionInterval* intervals, int count, double time,
                                                   double dt, double cfl, double steps = 1.0) {
  const int at = interval_at(intervals, count, time);
  MotionBound bound{dt, Kokkos::Experimental::infinity_v<double>, jump_at(intervals, count, time) != nullptr};
  for (int i = at; i < count; ++i) {
    const MotionInterval interval = intervals[i];
    const double left = (interval.begin - time) / steps;
    if (left >= bound.dt) break;
    if (interval.begins_with != 0) {
      const double round_off = jump_width * interval.begin;
      if (i > at && left > round_off) {
        bound.jump = interval.begin;
        break;
      }
      if (time - interval.begin <= round_off) bound.follows_jump = true;
    }
    double longest = interval.longest;
    if (longest * interval.rate > cfl) longest = cfl / interval.rate;
    if (longest < left) longest = left;
    if (longest < bound.dt) bound.dt = longest;
  }
  return bound;
}

}  // namespace drogue::stepping
