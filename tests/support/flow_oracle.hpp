#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "kernels/flow/axis_lines.hpp"
#include "kernels/reference/flow/momentum.hpp"
#include "tests/support/flow_case.hpp"

// Rates and whole steps of a flow solver against the oracle on random data.

namespace drogue::testing {

/// Of rates, as part of the largest one, and of velocities, m/s.
inline constexpr double oracle_tolerance = 2e-12;

/// Conditions of the two sides of an axis.
struct Sides {
  flow::BoundaryKind low, high;
};

/// All pairs of sides that an axis may have.
inline std::vector<Sides> all_sides() {
  std::vector<Sides> pairs{{flow::BoundaryKind::periodic, flow::BoundaryKind::periodic}};
  const flow::BoundaryKind kinds[] = {flow::BoundaryKind::slip, flow::BoundaryKind::wall,
                                      flow::BoundaryKind::inflow, flow::BoundaryKind::outflow};
  for (const flow::BoundaryKind low : kinds)
    for (const flow::BoundaryKind high : kinds) pairs.push_back({low, high});
  return pairs;
}

inline std::string text(const flow::Parameters& p) {
  std::string kinds;
  for (const flow::Boundary& side : p.boundary) kinds += "pswio"[static_cast<std::size_t>(side.kind)];
  return std::to_string(p.cells[0]) + "x" + std::to_string(p.cells[1]) + "x" + std::to_string(p.cells[2]) +
         " " + kinds + " advection " + std::to_string(static_cast<int>(p.advection));
}

/// Viscous fluid under a body force; walls move along themselves, inflows have a normal velocity if there is
/// an outflow, and the fluid outside of outflows moves.
inline flow::Parameters parameters_of(const std::array<int, 3>& cells, const std::array<Sides, 3>& sides,
                                      flow::Advection advection) {
  flow::Parameters p;
  p.cells = cells;
  p.low = {-0.3, 0.2, 1.0};
  p.high = {0.9, 1.1, 2.5};
  p.density = 1.3;
  p.viscosity = 0.02;
  p.body_force = {0.4, -0.3, 0.7};
  p.advection = advection;
  p.fixed_dt = 0.01;
  bool has_outflow = false;
  for (std::size_t side = 0; side < 6; ++side) {
    const Sides& pair = sides[side / 2];
    p.boundary[side].kind = side % 2 == 0 ? pair.low : pair.high;
    if (cells[side / 2] > 1)
      has_outflow = has_outflow || p.boundary[side].kind == flow::BoundaryKind::outflow;
  }
  for (std::size_t side = 0; side < 6; ++side) {
    flow::Boundary& boundary = p.boundary[side];
    if (cells[side / 2] == 1) boundary.kind = flow::BoundaryKind::periodic;
    if (boundary.kind == flow::BoundaryKind::outflow) boundary.velocity = {0.3, 0.2, -0.1};
    if (boundary.kind != flow::BoundaryKind::wall && boundary.kind != flow::BoundaryKind::inflow) continue;
    boundary.velocity = {0.5, -0.4, 0.3};
    boundary.velocity[side / 2] = boundary.kind == flow::BoundaryKind::inflow && has_outflow ? 0.6 : 0.0;
  }
  return p;
}

inline constexpr flow::Advection schemes[] = {flow::Advection::central, flow::Advection::weno_js,
                                              flow::Advection::weno_z};

/// Expects the rates of a first step at all faces without a prescribed velocity to equal those of the oracle.
inline void expect_equal_rates(flow::Parameters p, unsigned seed) {
  p.time_scheme = flow::TimeScheme::ab2;  // which keeps the rates
  p.fixed_dt = 1e-3;                      // stable on the finest grid
  const FlowDomain domain(p);
  const auto solver = started(tested_backend, p, random_field(domain, seed));
  const StaggeredField u = velocity(*solver);
  ASSERT_EQ(solver->advance(endless, 1, {}), flow::Stop::pause);
  const StaggeredField expected = reference::momentum_rate(domain, u, 0.0);
  const double scale = std::max({largest(expected[0]), largest(expected[1]), largest(expected[2])});
  const StaggeredField found = rates(*solver);
  domain.for_each_face([&](std::size_t c, const reference::GridIndex& face) {
    const int side = domain.side_of(c, face);
    if (side >= 0 && domain.kind(static_cast<std::size_t>(side)) != flow::BoundaryKind::outflow) return;
    ASSERT_NEAR(found[c][domain.at(c, face)], expected[c][domain.at(c, face)], oracle_tolerance * scale)
        << text(p) << ": component " << c << " at " << face[0] << " " << face[1] << " " << face[2];
  });
}

/// Expects the initial projection and some steps to equal those of the oracle.
inline void expect_equal_steps(const flow::Parameters& p, unsigned seed,
                               const reference::SideVelocity& side_velocity = {}) {
  const FlowDomain domain(p, side_velocity);
  const StaggeredField initial = random_field(domain, seed);
  const auto solver = started(tested_backend, p, initial);
  const bool is_implicit = p.diffusion == flow::Diffusion::crank_nicolson;
  reference::FlowState state;
  state.velocity = reference::with_side_velocity(domain, initial, 0.0);
  state.pressure = reference::project(domain, state.velocity, 1.0);
  if (is_implicit) {
    // Pressure of the present velocity, but for differences over 1e-4 dt, without viscosity in long steps.
    state.pressure = download(*solver, "pressure");
    double squares = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (p.cells[axis] > 1) squares += std::pow(flow::core_of(p).spacing[axis], -2);
    flow::Parameters short_step = p;
    if (4.0 * p.fixed_dt * p.viscosity / p.density * squares > 1.0) short_step.viscosity = 0.0;
    const std::vector<double> present =
        reference::present_pressure(FlowDomain(short_step, side_velocity), state.velocity, 0.0);
    for (std::size_t i = 0; i < present.size(); ++i)
      ASSERT_NEAR(state.pressure[i], present[i], 0.01 * largest(present)) << text(p);
  }
  ASSERT_LT(largest_difference(velocity(*solver), state.velocity), oracle_tolerance)
      << text(p) << ": initial projection";
  double time = 0.0;
  // The first step is shortened by its target.
  for (const double dt : {0.7 * p.fixed_dt, p.fixed_dt}) {
    ASSERT_EQ(solver->advance(time + dt, -1, {}), flow::Stop::target) << text(p);
    state = is_implicit ? reference::crank_nicolson_step(domain, state, time, dt)
            : p.time_scheme == flow::TimeScheme::ab2
                ? reference::adams_bashforth_step(domain, state, time, dt)
                : reference::runge_kutta_step(domain, state, time, dt);
    time += dt;
    ASSERT_EQ(solver->progress().time, time);
    ASSERT_LT(largest_difference(velocity(*solver), state.velocity), oracle_tolerance)
        << text(p) << " at " << time;
    ASSERT_LT(largest_difference(download(*solver, "pressure"), state.pressure),
              100.0 * oracle_tolerance * (1.0 + largest(state.pressure)))
        << text(p) << " at " << time;
  }
}

}  // namespace drogue::testing
