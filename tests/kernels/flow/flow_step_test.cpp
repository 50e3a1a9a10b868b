#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "kernels/reference/flow/momentum.hpp"
#include "tests/support/flow_case.hpp"

// Momentum rates, projection and whole steps against the oracle on random data.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests
using reference::FlowState;
using reference::GridIndex;

constexpr const auto& backend = testing::tested_backend;
constexpr double tolerance = 2e-12;

/// Conditions of the two sides of an axis.
struct Sides {
  BoundaryKind low, high;
};

/// All pairs of sides that an axis may have.
std::vector<Sides> all_sides() {
  std::vector<Sides> pairs{{BoundaryKind::periodic, BoundaryKind::periodic}};
  const BoundaryKind kinds[] = {BoundaryKind::slip, BoundaryKind::wall, BoundaryKind::inflow,
                                BoundaryKind::outflow};
  for (const BoundaryKind low : kinds)
    for (const BoundaryKind high : kinds) pairs.push_back({low, high});
  return pairs;
}

std::string text(const Parameters& p) {
  std::string kinds;
  for (const Boundary& side : p.boundary) kinds += "pswio"[static_cast<std::size_t>(side.kind)];
  return std::to_string(p.cells[0]) + "x" + std::to_string(p.cells[1]) + "x" + std::to_string(p.cells[2]) +
         " " + kinds + " advection " + std::to_string(static_cast<int>(p.advection));
}

/// Viscous fluid under a body force; walls move along themselves, inflows have a normal velocity if there is
/// an outflow, and the fluid outside of outflows moves.
Parameters parameters_of(const std::array<int, 3>& cells, const std::array<Sides, 3>& sides,
                         Advection advection) {
  Parameters p;
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
    if (cells[side / 2] > 1) has_outflow = has_outflow || p.boundary[side].kind == BoundaryKind::outflow;
  }
  for (std::size_t side = 0; side < 6; ++side) {
    Boundary& boundary = p.boundary[side];
    if (cells[side / 2] == 1) boundary.kind = BoundaryKind::periodic;
    if (boundary.kind == BoundaryKind::outflow) boundary.velocity = {0.3, 0.2, -0.1};
    if (boundary.kind != BoundaryKind::wall && boundary.kind != BoundaryKind::inflow) continue;
    boundary.velocity = {0.5, -0.4, 0.3};
    boundary.velocity[side / 2] = boundary.kind == BoundaryKind::inflow && has_outflow ? 0.6 : 0.0;
  }
  return p;
}

constexpr Advection schemes[] = {Advection::central, Advection::weno_js, Advection::weno_z};

/// Expects the rates of a first step at all faces without a prescribed velocity to equal those of the oracle.
void expect_equal_rates(Parameters p, unsigned seed) {
  p.time_scheme = TimeScheme::ab2;  // which keeps the rates
  p.fixed_dt = 1e-3;                // stable on the finest grid
  const FlowDomain domain(p);
  const auto solver = started(backend, p, random_field(domain, seed));
  const StaggeredField u = velocity(*solver);
  ASSERT_EQ(solver->advance(endless, 1, {}), Stop::pause);
  const StaggeredField expected = reference::momentum_rate(domain, u, 0.0);
  const double scale = std::max({largest(expected[0]), largest(expected[1]), largest(expected[2])});
  const StaggeredField found = rates(*solver);
  domain.for_each_face([&](std::size_t c, const GridIndex& face) {
    const int side = domain.side_of(c, face);
    if (side >= 0 && domain.kind(static_cast<std::size_t>(side)) != BoundaryKind::outflow) return;
    ASSERT_NEAR(found[c][domain.at(c, face)], expected[c][domain.at(c, face)], tolerance * scale)
        << text(p) << ": component " << c << " at " << face[0] << " " << face[1] << " " << face[2];
  });
}

TEST(FlowMomentum, RatesInPeriodicBoxesEqualThoseOfTheReference) {
  const Sides periodic{BoundaryKind::periodic, BoundaryKind::periodic};
  for (const Advection scheme : schemes)
    for (const std::array<int, 3>& cells : {std::array<int, 3>{13, 9, 7},
                                            {33, 5, 6},
                                            {67, 4, 4},
                                            {4, 4, 4},
                                            {12, 1, 9},
                                            {17, 10, 1},
                                            {1, 8, 6},
                                            {19, 1, 1}})
      expect_equal_rates(parameters_of(cells, {periodic, periodic, periodic}, scheme), 11);
}

// ctest-label: smoke
TEST(FlowMomentum, RatesBetweenBoundedSidesEqualThoseOfTheReference) {
  const Sides walls{BoundaryKind::wall, BoundaryKind::slip},
      through{BoundaryKind::inflow, BoundaryKind::outflow};
  for (const Advection scheme : schemes)
    for (const std::array<int, 3>& cells :
         {std::array<int, 3>{13, 9, 7}, {33, 5, 6}, {12, 1, 9}, {17, 10, 1}}) {
      expect_equal_rates(parameters_of(cells, {through, walls, walls}, scheme), 12);
      expect_equal_rates(parameters_of(cells, {walls, walls, through}, scheme), 13);
    }
}

TEST(FlowMomentum, RatesWithEddyViscositiesEqualThoseOfTheReference) {
  const Sides periodic{BoundaryKind::periodic, BoundaryKind::periodic},
      walls{BoundaryKind::wall, BoundaryKind::slip}, through{BoundaryKind::inflow, BoundaryKind::outflow};
  for (const Turbulence model : {Turbulence::smagorinsky, Turbulence::vreman})
    for (const std::array<int, 3>& cells : {std::array<int, 3>{13, 9, 7}, {12, 1, 9}, {17, 10, 1}, {1, 8, 6}})
      for (const std::array<Sides, 3>& sides : {std::array<Sides, 3>{periodic, periodic, periodic},
                                                {through, walls, walls},
                                                {walls, through, periodic},
                                                {periodic, walls, through}}) {
        Parameters p = parameters_of(cells, sides, Advection::central);
        p.turbulence = model;
        p.turbulence_constant = 0.6;  // larger than usual, so that its stress matters
        expect_equal_rates(p, 14);
        if (HasFatalFailure()) return;
      }
}

/// Expects the initial projection and some steps to equal those of the oracle.
void expect_equal_steps(const Parameters& p, unsigned seed,
                        const reference::SideVelocity& side_velocity = {}) {
  const FlowDomain domain(p, side_velocity);
  const StaggeredField initial = random_field(domain, seed);
  const auto solver = started(backend, p, initial);
  const bool is_implicit = p.diffusion == Diffusion::crank_nicolson;
  FlowState state;
  state.velocity = reference::with_side_velocity(domain, initial, 0.0);
  state.pressure = reference::project(domain, state.velocity, 1.0);
  if (is_implicit) {
    // Pressure of the present velocity, but for differences over 1e-4 dt, without viscosity in long steps.
    state.pressure = download(*solver, "pressure");
    double squares = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (p.cells[axis] > 1) squares += 1.0 / (domain.spacing(axis) * domain.spacing(axis));
    Parameters short_step = p;
    if (4.0 * p.fixed_dt * p.viscosity / p.density * squares > 1.0) short_step.viscosity = 0.0;
    const std::vector<double> present =
        reference::present_pressure(FlowDomain(short_step, side_velocity), state.velocity, 0.0);
    for (std::size_t i = 0; i < present.size(); ++i)
      ASSERT_NEAR(state.pressure[i], present[i], 0.01 * largest(present)) << text(p);
  }
  ASSERT_LT(largest_difference(velocity(*solver), state.velocity), tolerance)
      << text(p) << ": initial projection";
  double time = 0.0;
  // The first step is shortened by its target.
  for (const double dt : {0.7 * p.fixed_dt, p.fixed_dt}) {
    ASSERT_EQ(solver->advance(time + dt, -1, {}), Stop::target) << text(p);
    state = is_implicit                        ? reference::crank_nicolson_step(domain, state, time, dt)
            : p.time_scheme == TimeScheme::ab2 ? reference::adams_bashforth_step(domain, state, time, dt)
                                               : reference::runge_kutta_step(domain, state, time, dt);
    time += dt;
    ASSERT_EQ(solver->progress().time, time);
    ASSERT_LT(largest_difference(velocity(*solver), state.velocity), tolerance) << text(p) << " at " << time;
    ASSERT_LT(largest_difference(download(*solver, "pressure"), state.pressure),
              100.0 * tolerance * (1.0 + largest(state.pressure)))
        << text(p) << " at " << time;
  }
}

TEST(FlowStep, EqualsTheReferenceForAllPairsOfSidesInTwoDimensions) {
  const Sides periodic{BoundaryKind::periodic, BoundaryKind::periodic};
  unsigned seed = 100;
  for (const Sides& x : all_sides())
    for (const Sides& y : all_sides())
      for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
        Parameters p = parameters_of({6, 5, 1}, {x, y, periodic}, schemes[seed % 3]);
        p.time_scheme = time;
        expect_equal_steps(p, ++seed);
        if (HasFatalFailure()) return;
      }
}

TEST(FlowStep, EqualsTheReferenceForPairsOfSidesInThreeDimensions) {
  const std::vector<Sides> sides = all_sides();
  unsigned seed = 1000;
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
      Parameters p =
          parameters_of({5, 4, 6}, {sides[i], sides[(i + 5) % 17], sides[(i + 11) % 17]}, schemes[seed % 3]);
      p.time_scheme = time;
      expect_equal_steps(p, ++seed);
      if (HasFatalFailure()) return;
    }
}

TEST(FlowStep, EqualsTheReferenceByDiagonalization) {
  const Sides through{BoundaryKind::inflow, BoundaryKind::outflow},
      walls{BoundaryKind::wall, BoundaryKind::wall};
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3})
    for (const Sides& x : {through, walls}) {
      Parameters p = parameters_of({7, 5, 6}, {x, walls, {BoundaryKind::periodic, BoundaryKind::periodic}},
                                   Advection::weno_z);
      p.time_scheme = time;
      p.pressure_solver = PressureSolver::diagonalization;
      expect_equal_steps(p, 2000);
    }
}

TEST(FlowStep, EqualsTheReferenceWithImplicitDiffusionForAllPairsOfSides) {
  const Sides periodic{BoundaryKind::periodic, BoundaryKind::periodic};
  unsigned seed = 4000;
  for (const Sides& x : all_sides())
    for (const Sides& y : all_sides()) {
      Parameters p = parameters_of({6, 5, 1}, {x, y, periodic}, schemes[seed % 3]);
      p.time_scheme = TimeScheme::ab2;
      p.diffusion = Diffusion::crank_nicolson;
      p.viscosity = 2.0;  // nu dt / h^2 is 0.4
      if (seed % 2 == 0) p.pressure_solver = PressureSolver::diagonalization;
      expect_equal_steps(p, ++seed);
      if (HasFatalFailure()) return;
    }
}

TEST(FlowStep, EqualsTheReferenceWithImplicitDiffusionInThreeDimensions) {
  const std::vector<Sides> sides = all_sides();
  unsigned seed = 5000;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    Parameters p =
        parameters_of({5, 4, 6}, {sides[i], sides[(i + 5) % 17], sides[(i + 11) % 17]}, schemes[seed % 3]);
    p.time_scheme = TimeScheme::ab2;
    p.diffusion = Diffusion::crank_nicolson;
    p.viscosity = 2.0;
    expect_equal_steps(p, ++seed);
    if (HasFatalFailure()) return;
  }
}

TEST(FlowStep, EqualsTheReferenceWithEddyViscositiesForPairsOfSides) {
  const std::vector<Sides> sides = all_sides();
  unsigned seed = 6000;
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (const TimeIntegration& integration : time_integrations) {
      Parameters p =
          parameters_of({5, 4, 6}, {sides[i], sides[(i + 5) % 17], sides[(i + 11) % 17]}, schemes[seed % 3]);
      integration.set(p);
      p.turbulence = seed % 2 == 0 ? Turbulence::smagorinsky : Turbulence::vreman;
      expect_equal_steps(p, ++seed);
      if (HasFatalFailure()) return;
    }
}

TEST(FlowStep, EvaluatesExpressionsOfSidesAtTheTimesOfTheStages) {
  const Sides through{BoundaryKind::inflow, BoundaryKind::outflow},
      walls{BoundaryKind::wall, BoundaryKind::slip};
  const Sides periodic{BoundaryKind::periodic, BoundaryKind::periodic};
  for (const TimeIntegration& integration : time_integrations)
    for (const Sides& beside : {walls, periodic}) {
      Parameters p = parameters_of({6, 5, 4}, {through, beside, beside}, Advection::weno_z);
      integration.set(p);
      // Component c is 1 + 40 t y + (c + 1) z.
      for (int c = 0; c < 3; ++c) {
        device::ExpressionBuilder builder;
        builder.push("constant", 40.0);
        builder.push("t");
        builder.push("*");
        builder.push("y");
        builder.push("*");
        builder.push("constant", c + 1.0);
        builder.push("z");
        builder.push("*");
        builder.push("+");
        builder.push("constant", 1.0);
        builder.push("+");
        p.boundary[0].velocity_expressions.push_back(builder.program());
      }
      expect_equal_steps(
          p, 3000, [&](std::size_t side, std::size_t component, const reference::Point& point, double t) {
            if (side != 0) return p.boundary[side].velocity[component];
            return 1.0 + 40.0 * t * point[1] + (static_cast<double>(component) + 1.0) * point[2];
          });
    }
}

}  // namespace
}  // namespace drogue::flow
