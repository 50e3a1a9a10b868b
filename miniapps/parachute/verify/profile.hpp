#pragma once

#include <span>
#include <utility>
#include <vector>

#include "kernels/flow/solver.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// Values along a line, between which cubic polynomials interpolate.
class SampledLine {
 public:
  /// `values` are at `coordinates`, m, ascending. Throws std::invalid_argument for fewer than four values.
  SampledLine(std::vector<double> coordinates, std::vector<double> values);

  /// Value at a coordinate, m: the cubic through the four nearest points (Lagrange). Does not throw.
  [[nodiscard]] double operator()(double coordinate) const;

  /// Coordinate, m, and value of the largest value times `sign`: vertex of the parabola through the largest
  /// sample and its neighbours. NaN if a sample is not finite. Does not throw.
  [[nodiscard]] std::pair<double, double> maximum(double sign) const;

 private:
  std::vector<double> _coordinates, _values;
};

/// Velocity component along the line of a profile, m/s, linearly interpolated across the line. `all`: its
/// array of the state, m/s.
[[nodiscard]] SampledLine sample_line(std::span<const double> all, const flow::Parameters& parameters,
                                      const Profile& profile);

}  // namespace drogue::parachute_app
