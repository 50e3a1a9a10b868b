#pragma once

#include <vector>

namespace drogue::parachute_app {

/// Value between rows and its first derivative, in the unit of the value and in that per second.
struct InterpolatedRow {
  double value, derivative;
};

/// Cubic polynomial through the four rows around a time, s: two at each side of it, or those at an end of the
/// history (Lagrange). NaN for fewer than four rows and for times outside of them. Times increase. Does not
/// throw.
[[nodiscard]] InterpolatedRow interpolate_rows(const std::vector<double>& time,
                                               const std::vector<double>& value, double at);

}  // namespace drogue::parachute_app
