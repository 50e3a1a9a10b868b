#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/expression_program.hpp"
#include "tests/support/flow_case.hpp"

// Steps that fail, the state that they leave, and bounds of dt that prevent failures.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests

constexpr const auto& backend = testing::tested_backend;

/// sqrt(0.105 - t), which is not finite from t = 0.11 on.
device::ExpressionProgram ending() { return postfix({0.105, "t", "-", "sqrt"}); }
device::ExpressionProgram zero() { return postfix({0.0}); }

/// Channel between walls along x with steps of 0.01 s.
Parameters channel() {
  Parameters p = periodic_box({8, 7, 1});
  p.viscosity = 0.05;
  p.fixed_dt = 0.01;
  p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::wall;
  return p;
}

/// Everything that a solver gives out.
struct Outputs {
  StaggeredField velocity;
  std::vector<double> pressure, vorticity, present_pressure;
  double kinetic_energy;
  bool operator==(const Outputs&) const = default;
};

Outputs outputs(Solver& solver) {
  Outputs all;
  all.velocity = velocity(solver);
  all.pressure = download(solver, "pressure");
  all.present_pressure.resize(all.pressure.size());
  all.vorticity.resize(3 * all.pressure.size());
  solver.sample(CellField::pressure, all.present_pressure);
  solver.sample(CellField::vorticity, all.vorticity);
  all.kinetic_energy = solver.totals().kinetic_energy;
  return all;
}

/// Expects the step to 0.11 s to fail by the velocity of a side, and to leave the state before it.
void expect_failed_side(Parameters p, int side) {
  for (const TimeIntegration& integration : time_integrations) {
    integration.set(p);
    const auto solver = started(backend, p, sampled_field(FlowDomain(p), [](std::size_t, const auto& point) {
                                  return 0.1 * std::sin(7.0 * point[0] + 3.0 * point[1]);
                                }));
    ASSERT_EQ(solver->advance(endless, 10, {}), Stop::pause);
    const Outputs before = outputs(*solver);
    EXPECT_LT(largest(before.pressure), 1e3);
    EXPECT_LT(largest(before.vorticity), 1e3);
    EXPECT_LT(largest(before.present_pressure), 1e3);
    ASSERT_EQ(solver->advance(0.14, -1, {}), Stop::failed);
    EXPECT_EQ(solver->failure().reason, FailureReason::side_velocity);
    EXPECT_EQ(solver->failure().index, side);
    EXPECT_EQ(solver->failure().step, 11);
    EXPECT_EQ(outputs(*solver), before);
  }
}

TEST(FlowFailure, TangentialVelocityOfAWallThatIsNotFiniteFailsTheStep) {
  Parameters p = channel();
  p.boundary[2].velocity_expressions = {ending(), zero(), zero()};
  expect_failed_side(p, 2);
}

TEST(FlowFailure, WallVelocityAlongAnAxisOfOneCellThatIsNotFiniteFailsTheStep) {
  Parameters p = channel();
  p.boundary[3].velocity_expressions = {zero(), zero(), ending()};
  expect_failed_side(p, 3);
}

TEST(FlowFailure, InflowThatIsNotFiniteFailsTheStep) {
  Parameters p = channel();
  p.boundary[0].kind = BoundaryKind::inflow;
  p.boundary[0].velocity_expressions = {ending(), zero(), zero()};
  p.boundary[1].kind = BoundaryKind::outflow;
  expect_failed_side(p, 0);
}

/// Inflow that pulses between 0.085 s and 0.125 s and leaves through the opposite side, `excess` times as
/// fast.
Parameters pulse(double excess) {
  Parameters p = channel();
  const auto speed = [](double factor) {
    return postfix({0.085, "t", "<", "t", 0.125, "<", "&&", factor, "*", "y", "*"});
  };
  for (const std::size_t side : {0U, 1U}) {
    p.boundary[side].kind = BoundaryKind::inflow;
    p.boundary[side].velocity_expressions = {speed(side == 0 ? 1.0 : excess), zero(), zero()};
  }
  return p;
}

TEST(FlowFailure, NetInflowWithoutAnOutflowFailsTheStep) {
  for (const TimeIntegration& integration : time_integrations) {
    Parameters p = pulse(0.75);
    integration.set(p);
    const auto solver = started(backend, p, FlowDomain(p).zero_field());
    ASSERT_EQ(solver->advance(endless, 8, {}), Stop::pause);
    const Outputs before = outputs(*solver);
    ASSERT_EQ(solver->advance(endless, 20, {}), Stop::failed);
    EXPECT_EQ(solver->failure().reason, FailureReason::net_inflow);
    EXPECT_EQ(solver->failure().step, 9);
    EXPECT_NEAR(solver->failure().net_inflow, 0.5 * (1.0 - 0.75), 1e-14);
    EXPECT_EQ(outputs(*solver), before);
    p = pulse(1.0);
    integration.set(p);
    const auto balanced = started(backend, p, FlowDomain(p).zero_field());
    EXPECT_EQ(balanced->advance(endless, 20, {}), Stop::pause);
  }
}

TEST(FlowFailure, NetInflowFromTheBeginningFailsTheFirstStep) {
  Parameters p = channel();
  for (const std::size_t side : {0U, 1U}) p.boundary[side].kind = BoundaryKind::wall;
  p.boundary[0].velocity_expressions = {postfix({1.0, "t", "+"}), zero(), zero()};
  const auto solver = started(backend, p, FlowDomain(p).zero_field());
  EXPECT_EQ(solver->advance(endless, 1, {}), Stop::failed);
  EXPECT_EQ(solver->failure().reason, FailureReason::net_inflow);
  EXPECT_EQ(solver->failure().net_inflow, 1.0);
}

TEST(FlowFailure, ChecksOfSidesStopAtTheirEnds) {
  Parameters p = channel();
  // Undefined in ghost cells, where y < 0 or y > 1.
  p.boundary[0].kind = BoundaryKind::inflow;
  p.boundary[0].velocity_expressions = {postfix({"y", 1.0, "y", "-", "*", "sqrt"}), zero(), zero()};
  p.boundary[1].kind = BoundaryKind::outflow;
  const auto solver = started(backend, p, FlowDomain(p).zero_field());
  EXPECT_EQ(solver->advance(endless, 5, {}), Stop::pause);
}

TEST(FlowFailure, NormalVelocityAtTheEdgeOfASideThatIsNotFiniteFailsTheStep) {
  for (const double edge : {0.0, 1.0}) {
    Parameters p = channel();
    p.boundary[0].kind = BoundaryKind::inflow;
    p.boundary[0].velocity_expressions = {postfix({1.0}), postfix({"y", edge, "-", "abs", "log"}), zero()};
    p.boundary[1].kind = BoundaryKind::outflow;
    const auto solver = started(backend, p, FlowDomain(p).zero_field());
    EXPECT_EQ(solver->advance(endless, 1, {}), Stop::failed);
    EXPECT_EQ(solver->failure().reason, FailureReason::side_velocity);
    EXPECT_EQ(solver->failure().index, 0);
  }
}

/// Inflow along x into a domain of length 1.3 along y, with a velocity along x and y.
Parameters inflow(BoundaryKind beside, const device::ExpressionProgram& profile) {
  Parameters p = periodic_box({8, 16, 1});
  p.high[1] = 1.3;
  p.viscosity = 0.01;
  p.boundary[0].kind = BoundaryKind::inflow;
  p.boundary[0].velocity_expressions = {profile, profile, zero()};
  p.boundary[1].kind = BoundaryKind::outflow;
  p.boundary[2].kind = p.boundary[3].kind = beside;
  return p;
}

TEST(FlowSides, ProfilesThatEndAtTheSidesOfTheDomainGiveFiniteOutputs) {
  for (const auto& profile : {postfix({"y", 1.3, "y", "-", "*", "sqrt"}), postfix({"y", 1.0, 7.0, "/", "^"})})
    for (const BoundaryKind beside : {BoundaryKind::wall, BoundaryKind::slip, BoundaryKind::periodic})
      for (const Turbulence model : {Turbulence::none, Turbulence::smagorinsky, Turbulence::vreman}) {
        Parameters p = inflow(beside, profile);
        p.turbulence = model;
        const auto solver = started(backend, p, FlowDomain(p).zero_field());
        ASSERT_EQ(solver->advance(endless, 3, {}), Stop::pause);
        const Outputs all = outputs(*solver);
        EXPECT_LT(largest(all.vorticity), 100.0);
        EXPECT_LT(largest(all.present_pressure), 1e3);
        const Totals totals = solver->totals();
        EXPECT_GT(totals.enstrophy, 0.0);
        EXPECT_LT(totals.enstrophy, 100.0);
        EXPECT_GT(totals.dissipation, 0.0);
        EXPECT_LT(totals.dissipation, 100.0);
      }
}

TEST(FlowSides, ShiftedProfileBesideAPeriodicAxisShiftsTheFlow) {
  for (const TimeIntegration& integration : time_integrations)
    for (const Turbulence model : {Turbulence::none, Turbulence::vreman}) {
      // The coordinates are multiples of 1/32.
      Parameters p = inflow(BoundaryKind::periodic, postfix({"y"}));
      Parameters shifted =
          inflow(BoundaryKind::periodic, postfix({"y", 0.75, "+", "y", 0.75, "+", "floor", "-"}));
      Outputs found[2];
      for (Parameters* each : {&p, &shifted}) {
        each->high[1] = 1.0;
        each->turbulence = model;
        each->fixed_dt = 0.005;
        integration.set(*each);
        const auto solver = started(backend, *each, FlowDomain(*each).zero_field());
        ASSERT_EQ(solver->advance(endless, 20, {}), Stop::pause);
        found[each == &shifted] = outputs(*solver);
      }
      EXPECT_NEAR(found[0].kinetic_energy, found[1].kinetic_energy, 1e-12);
      double largest_error = 0.0;
      for (std::size_t i = 0; i < 8; ++i)
        for (std::size_t j = 0; j < 16; ++j)
          largest_error =
              std::max(largest_error, std::abs(found[0].vorticity[3 * (16 * i + j) + 2] -
                                               found[1].vorticity[3 * (16 * i + (j + 4) % 16) + 2]));
      EXPECT_GT(largest(found[0].vorticity), 1.0);
      EXPECT_LT(largest_error, 1e-10);
    }
}

TEST(FlowFailure, VelocityAlongAnAxisOfOneCellThatIsNotFiniteFailsTheStep) {
  for (const double bad : {std::nan(""), HUGE_VAL})
    for (const TimeIntegration& integration : time_integrations) {
      Parameters p = channel();
      integration.set(p);
      StaggeredField u = random_field(FlowDomain(p), 3);
      u[2][19] = bad;
      const auto solver = started(backend, p, u);
      EXPECT_EQ(solver->advance(endless, 1, {}), Stop::failed);
      EXPECT_EQ(solver->failure().reason, FailureReason::not_finite);
      EXPECT_EQ(solver->failure().index, 19);
    }
}

TEST(FlowFailure, LastStepTowardsATargetIsChecked) {
  Parameters p = channel();
  p.boundary[2].velocity_expressions = {ending(), zero(), zero()};
  const auto solver = started(backend, p, FlowDomain(p).zero_field());
  EXPECT_EQ(solver->advance(0.11, -1, {}), Stop::failed);
}

/// Flow between a wall at rest and one that moves with 10 m/s, of uniform shear; flat cells.
Parameters shear() {
  Parameters p = periodic_box({16, 32, 1});
  p.high = {10.0, 1.0, 1.0};
  p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::wall;
  p.boundary[3].velocity = {10.0, 0.0, 0.0};
  return p;
}

TEST(FlowStepSize, IncludesTheEddyViscosity) {
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
    Parameters p = shear();
    p.time_scheme = time;
    p.turbulence = Turbulence::smagorinsky;
    const FlowDomain domain(p);
    const auto u = sampled_field(
        domain, [](std::size_t c, const auto& point) { return c == 0 ? 10.0 * point[1] : 0.0; });
    const auto solver = started(backend, p, u);
    const double hx = 10.0 / 16.0, hy = 1.0 / 32.0;
    const double eddy_viscosity = 0.17 * 0.17 * hx * hy * 10.0;
    const bool is_rk3 = time == TimeScheme::rk3;
    const double advection = 10.0 * (1.0 - 0.5 * hy) / hx / (is_rk3 ? 1.0 : 0.5);
    const double diffusion =
        4.0 * eddy_viscosity * (1.0 / (hx * hx) + 1.0 / (hy * hy)) / (0.9 * (is_rk3 ? 2.5 : 1.0));
    const double expected = 1.0 / (advection + diffusion);
    EXPECT_GT(diffusion, 0.5 * advection);
    for (int step = 1; step <= 3; ++step) {
      ASSERT_EQ(solver->advance(endless, step, {}), Stop::pause);
      EXPECT_NEAR(solver->progress().last_dt, expected, 1e-10 * expected);
    }
  }
}

TEST(FlowStepSize, KeepsSmagorinskysModelStableInFlatCells) {
  Parameters p = periodic_box({32, 32, 1});
  p.high = {10.0, 1.0, 1.0};
  p.viscosity = 1e-5;
  p.time_scheme = TimeScheme::ab2;
  p.turbulence = Turbulence::smagorinsky;
  p.turbulence_constant = 0.5;
  p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::wall;
  const auto u = sampled_field(FlowDomain(p), [](std::size_t c, const auto& point) {
    const double x = point[0], y = point[1];
    if (c == 0) return 4.0 * y * (1.0 - y) + 0.1 * std::sin(0.628318 * x);
    return c == 1 ? 0.05 * std::sin(6.28318 * y) : 0.0;
  });
  const auto solver = started(backend, p, u);
  double before = solver->totals().kinetic_energy;
  for (const double time : {1.0, 2.0, 3.0, 4.0, 5.0}) {
    ASSERT_EQ(solver->advance(time, -1, {}), Stop::target);
    const Totals totals = solver->totals();
    EXPECT_LT(totals.kinetic_energy, before);
    EXPECT_LT(totals.max_speed, 1.2);
    before = totals.kinetic_energy;
  }
}

TEST(FlowStepSize, RestartRestoresTheEddyViscosity) {
  Parameters p = shear();
  p.turbulence = Turbulence::vreman;
  const auto solver = started(backend, p, random_field(FlowDomain(p), 5));
  ASSERT_EQ(solver->advance(endless, 3, {}), Stop::pause);
  const auto restarted = create_solver(backend, p);
  copy_state(*solver, *restarted);
  restarted->restore(solver->progress());
  ASSERT_EQ(solver->advance(endless, 6, {}), Stop::pause);
  ASSERT_EQ(restarted->advance(endless, 6, {}), Stop::pause);
  EXPECT_EQ(velocity(*restarted), velocity(*solver));
  EXPECT_EQ(restarted->progress().time, solver->progress().time);
}

TEST(FlowStepSize, DoesNotDependOnTheThicknessOfOneCell) {
  std::vector<double> steps;
  for (const double thickness : {1.0, 1e-3}) {
    Parameters p = periodic_box({9, 8, 1});
    p.high[2] = thickness;
    const auto solver = started(backend, p, random_field(FlowDomain(p), 6));
    ASSERT_EQ(solver->advance(endless, 1, {}), Stop::pause);
    steps.push_back(solver->progress().last_dt);
  }
  EXPECT_EQ(steps[0], steps[1]);
}

TEST(FlowStepSize, FirstStepFromRestFollowsTheInflow) {
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
    Parameters p = periodic_box({48, 8, 1});
    p.high = {6.0, 1.0, 1.0};
    p.time_scheme = time;
    p.boundary[0].kind = BoundaryKind::inflow;
    p.boundary[0].velocity_expressions = {postfix({"t", 3.0, "*", "sin", 10.0, "*"}), zero(), zero()};
    p.horizon = 10.25;
    p.boundary[1].kind = BoundaryKind::outflow;
    p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::slip;
    const auto solver = started(backend, p, FlowDomain(p).zero_field());
    const double cfl = time == TimeScheme::rk3 ? 1.0 : 0.5;
    for (int step = 1; step <= 400; ++step) {
      ASSERT_EQ(solver->advance(10.25, step, {}), Stop::pause);
      EXPECT_LE(solver->progress().last_dt * solver->totals().max_speed / 0.125, 1.5 * cfl) << step;
    }
  }
}

TEST(FlowStepSize, FirstStepFromRestFollowsTheBodyForce) {
  Parameters p = periodic_box({16, 4, 1});
  p.body_force = {2.0, 0.0, 0.0};
  const auto solver = started(backend, p, FlowDomain(p).zero_field());
  ASSERT_EQ(solver->advance(100.0, 1, {}), Stop::pause);
  EXPECT_NEAR(solver->progress().last_dt, std::sqrt(1.0 / (2.0 * 16.0)), 1e-14);
}

TEST(FlowSides, SlipSidesOfOneCellLeaveNoVelocityThroughThem) {
  Parameters p = periodic_box({8, 7, 1});
  p.boundary[4].kind = p.boundary[5].kind = BoundaryKind::slip;
  const auto solver = started(backend, p, random_field(FlowDomain(p), 3));
  EXPECT_EQ(largest(velocity(*solver)[2]), 0.0);
  p.body_force[2] = 1.0;
  EXPECT_THROW(check_parameters(p), std::invalid_argument);
  p.body_force[2] = 0.0;
  p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::wall;
  EXPECT_NO_THROW(check_parameters(p));
  p.boundary[3].velocity = {0.0, 0.0, 1.0};
  EXPECT_THROW(check_parameters(p), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::flow
