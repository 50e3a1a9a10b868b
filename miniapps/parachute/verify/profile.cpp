#include "miniapps/parachute/verify/profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

/// Index of the lower of two neighbouring points, and the weight of the upper one.
struct Neighbours {
  int lower = 0, upper = 0;
  double weight = 0.0;
};

/// `period`: length of a periodic axis, m; 0 for others.
Neighbours neighbours(const Lattice& lattice, std::size_t axis, double coordinate, double period) {
  const std::vector<double>& at = lattice.coordinates[axis];
  const int n = lattice.n[axis];
  if (n == 1) return {};
  if (period > 0.0) coordinate -= period * std::floor((coordinate - at.front()) / period);
  const auto after = static_cast<int>(std::ranges::upper_bound(at, coordinate) - at.begin());
  if (period > 0.0 && after == n)
    return {n - 1, 0, (coordinate - at.back()) / (at.front() + period - at.back())};
  const int lower = std::clamp(after - 1, 0, n - 2);
  const auto low = static_cast<std::size_t>(lower);
  return {lower, lower + 1, std::clamp((coordinate - at[low]) / (at[low + 1] - at[low]), 0.0, 1.0)};
}

}  // namespace

SampledLine::SampledLine(std::vector<double> coordinates, std::vector<double> values)
    : _coordinates(std::move(coordinates)), _values(std::move(values)) {
  if (_values.size() < 4) throw std::invalid_argument("cubic interpolation needs four values");
}

double SampledLine::operator()(double coordinate) const {
  const auto after = std::ranges::upper_bound(_coordinates, coordinate) - _coordinates.begin();
  const auto last_start = static_cast<std::ptrdiff_t>(_values.size()) - 4;
  const auto start = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after - 2, 0, last_start));
  const double* x = _coordinates.data() + start;
  double value = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    double weight = 1.0;
    for (std::size_t other = 0; other < 4; ++other)
      if (other != k) weight *= (coordinate - x[other]) / (x[k] - x[other]);
    value += weight * _values[start + k];
  }
  return value;
}

std::pair<double, double> SampledLine::maximum(double sign) const {
  if (!std::ranges::all_of(_values, [](double value) { return std::isfinite(value); })) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan};
  }
  std::size_t top = 0;
  for (std::size_t i = 1; i < _values.size(); ++i)
    if (sign * _values[i] > sign * _values[top]) top = i;
  double offset = 0.0, value = _values[top];
  if (top > 0 && top + 1 < _values.size()) {
    const double before = _coordinates[top] - _coordinates[top - 1],
                 after = _coordinates[top + 1] - _coordinates[top],
                 rise = (_values[top] - _values[top - 1]) / before,
                 next_rise = (_values[top + 1] - _values[top]) / after,
                 slope = (after * rise + before * next_rise) / (before + after),
                 curvature = 2.0 * (next_rise - rise) / (before + after);
    if (curvature != 0.0) {
      offset = -slope / curvature;
      value += 0.5 * offset * slope;
    }
  }
  return {_coordinates[top] + offset, value};
}

SampledLine sample_line(std::span<const double> all, const flow::Parameters& parameters,
                        const Profile& profile) {
  const auto along = static_cast<std::size_t>(profile.along);
  const Lattice lattice = lattice_of(parameters, static_cast<std::size_t>(profile.component));
  const std::size_t stride[] = {
      1, static_cast<std::size_t>(lattice.n[0]),
      static_cast<std::size_t>(lattice.n[0]) * static_cast<std::size_t>(lattice.n[1])};
  const std::size_t across[] = {(along + 1) % 3, (along + 2) % 3};
  Neighbours near[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t axis = across[i];
    const bool is_periodic = parameters.boundary[2 * axis].kind == flow::BoundaryKind::periodic;
    const double period = is_periodic ? parameters.high[axis] - parameters.low[axis] : 0.0;
    near[i] = neighbours(lattice, axis, profile.through[axis], period);
  }
  std::vector<double> values(static_cast<std::size_t>(lattice.n[along]), 0.0);
  for (const bool upper_0 : {false, true})
    for (const bool upper_1 : {false, true}) {
      const double weight = (upper_0 ? near[0].weight : 1.0 - near[0].weight) *
                            (upper_1 ? near[1].weight : 1.0 - near[1].weight);
      if (weight == 0.0) continue;
      const std::size_t base =
          static_cast<std::size_t>(upper_0 ? near[0].upper : near[0].lower) * stride[across[0]] +
          static_cast<std::size_t>(upper_1 ? near[1].upper : near[1].lower) * stride[across[1]];
      for (std::size_t i = 0; i < values.size(); ++i) values[i] += weight * all[base + i * stride[along]];
    }
  return {lattice.coordinates[along], std::move(values)};
}

}  // namespace drogue::parachute_app
