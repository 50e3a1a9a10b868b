#pragma once

#include <array>

#include "kernels/device/expression_program.hpp"

namespace drogue::stepping {

/// Value of an expression of time, and its first and second derivative by time.
struct MotionJet {
  double value = 0.0, rate = 0.0, acceleration = 0.0;
};

/// Jet of an expression at a place, m, and a time, s, by the chain rule, without differences: a kink or a
/// jump leaves no trace at other times. Derivatives are not finite where they have no limit. Evaluates both
/// branches of a `select`. Runs on the host. Does not throw.
[[nodiscard]] MotionJet motion_jet(const device::ExpressionProgram& program,
                                   const std::array<double, 3>& place, double time);

}  // namespace drogue::stepping
