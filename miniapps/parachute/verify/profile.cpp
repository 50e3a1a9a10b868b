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

Neighbours neighbours(const Lattice& lattice, std::size_t axis, double coordinate, bool periodic) {
  const int n = lattice.n[axis];
  if (n == 1) return {};
  const double position = (coordinate - lattice.first[axis]) / lattice.spacing[axis];
  const int lower = static_cast<int>(std::floor(position));
  if (periodic) return {(lower % n + n) % n, ((lower + 1) % n + n) % n, position - lower};
  const int inner = std::clamp(lower, 0, n - 2);
  return {inner, inner + 1, std::clamp(position - inner, 0.0, 1.0)};
}

}  // namespace

SampledLine::SampledLine(double first, double spacing, std::vector<double> values)
    : _first(first), _spacing(spacing), _values(std::move(values)) {
  if (_values.size() < 4) throw std::invalid_argument("cubic interpolation needs four values");
}

double SampledLine::operator()(double coordinate) const {
  const double position = (coordinate - _first) / _spacing;
  const auto last_start = static_cast<double>(_values.size() - 4);
  const double start = std::clamp(std::floor(position) - 1.0, 0.0, last_start);
  const double s = position - start;
  const double* v = _values.data() + static_cast<std::size_t>(start);
  return -v[0] * (s - 1) * (s - 2) * (s - 3) / 6 + v[1] * s * (s - 2) * (s - 3) / 2 -
         v[2] * s * (s - 1) * (s - 3) / 2 + v[3] * s * (s - 1) * (s - 2) / 6;
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
    const double slope = 0.5 * (_values[top + 1] - _values[top - 1]);
    const double curvature = _values[top + 1] - 2.0 * _values[top] + _values[top - 1];
    if (curvature != 0.0) {
      offset = -slope / curvature;
      value += 0.5 * offset * slope;
    }
  }
  return {_first + (static_cast<double>(top) + offset) * _spacing, value};
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
    const bool periodic = parameters.boundary[2 * across[i]].kind == flow::BoundaryKind::periodic;
    near[i] = neighbours(lattice, across[i], profile.through[across[i]], periodic);
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
  return {lattice.first[along], lattice.spacing[along], std::move(values)};
}

}  // namespace drogue::parachute_app
