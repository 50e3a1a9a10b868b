#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "kernels/reference/flow/domain.hpp"
#include "kernels/reference/flow/step.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/flow_state.hpp"

namespace drogue::testing {

using reference::FlowDomain;
using reference::StaggeredField;

inline constexpr double endless = std::numeric_limits<double>::max();

/// Values at all faces, uniformly distributed in [-1, 1].
inline StaggeredField random_field(const FlowDomain& domain, unsigned seed) {
  std::mt19937 engine(seed);
  StaggeredField field = domain.zero_field();
  for (std::vector<double>& component : field)
    for (double& value : component) value = 2.0 * std::generate_canonical<double, 53>(engine) - 1.0;
  return field;
}

/// Values of three functions (component, point) at the faces.
template <class Function>
StaggeredField sampled_field(const FlowDomain& domain, const Function& function) {
  StaggeredField field = domain.zero_field();
  domain.for_each_face([&](std::size_t c, const reference::GridIndex& face) {
    reference::Point point{};
    for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = domain.coordinate(c, axis, face[axis]);
    field[c][domain.at(c, face)] = function(c, point);
  });
  return field;
}

inline StaggeredField velocity(flow::Solver& solver) {
  return {download(solver, "velocity_x"), download(solver, "velocity_y"), download(solver, "velocity_z")};
}

/// Rates of change of the previous step, with AB2.
inline StaggeredField rates(flow::Solver& solver) {
  return {download(solver, "rate_x"), download(solver, "rate_y"), download(solver, "rate_z")};
}

inline void upload_velocity(flow::Solver& solver, const StaggeredField& u) {
  for (std::size_t c = 0; c < 3; ++c) solver.upload(flow::velocity_name(c), u[c]);
}

/// Solver that has started from a velocity field.
inline std::unique_ptr<flow::Solver> started(device::Backend backend, const flow::Parameters& p,
                                             const StaggeredField& u) {
  auto solver = flow::create_solver(backend, p);
  upload_velocity(*solver, u);
  solver->start();
  return solver;
}

inline double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::isfinite(value) ? std::max(most, std::abs(value)) : endless;
  return most;
}

inline double largest_difference(std::vector<double> a, const std::vector<double>& b) {
  if (a.size() != b.size()) return endless;
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return largest(a);
}

inline double largest_difference(const StaggeredField& a, const StaggeredField& b) {
  return std::max(
      {largest_difference(a[0], b[0]), largest_difference(a[1], b[1]), largest_difference(a[2], b[2])});
}

/// Root mean square of the difference over all faces.
inline double rms_difference(const StaggeredField& a, const StaggeredField& b) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < a[c].size(); ++i, ++count) sum += (a[c][i] - b[c][i]) * (a[c][i] - b[c][i]);
  return std::sqrt(sum / static_cast<double>(count));
}

/// Time integration of advection and of diffusion.
struct TimeIntegration {
  flow::TimeScheme time;
  flow::Diffusion diffusion;

  void set(flow::Parameters& p) const {
    p.time_scheme = time;
    p.diffusion = diffusion;
  }
};
inline constexpr TimeIntegration time_integrations[] = {
    {flow::TimeScheme::ab2, flow::Diffusion::explicit_},
    {flow::TimeScheme::rk3, flow::Diffusion::explicit_},
    {flow::TimeScheme::ab2, flow::Diffusion::crank_nicolson}};

/// Unit cube of the given cells with periodic sides.
inline flow::Parameters periodic_box(const std::array<int, 3>& cells) {
  flow::Parameters p;
  p.cells = cells;
  return p;
}

}  // namespace drogue::testing
