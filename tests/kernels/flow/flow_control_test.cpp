#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "tests/support/flow_case.hpp"
#if defined(DROGUE_HAVE_HYPRE)
#include "tests/support/hypre_session.hpp"
#endif
#include "tests/support/profiled.hpp"

// Step size, stopping criteria, costs of a step, restarts, and rejected parameters.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests

constexpr const auto& backend = testing::tested_backend;

/// Maximum over the cells of |u|/hx + |v|/hy + |w|/hz at their low faces, 1/s.
double rate(const FlowDomain& domain, const StaggeredField& u) {
  double most = 0.0;
  domain.for_each_cell([&](const reference::GridIndex& cell) {
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) sum += std::abs(u[c][domain.at(c, cell)]) / domain.width(c, cell[c]);
    most = std::max(most, sum);
  });
  return most;
}

/// Box with an outflow at each low side, an inflow, and slip sides.
Parameters mixed_box() {
  Parameters p = periodic_box({9, 8, 7});
  p.viscosity = 0.01;
  const BoundaryKind kinds[] = {BoundaryKind::outflow, BoundaryKind::outflow, BoundaryKind::outflow,
                                BoundaryKind::slip,    BoundaryKind::inflow,  BoundaryKind::outflow};
  for (std::size_t side = 0; side < 6; ++side) p.boundary[side].kind = kinds[side];
  p.boundary[4].velocity = {0.0, 0.1, 0.6};
  return p;
}

/// Largest stable dt without implicit diffusion, s.
double stable_dt_of(const Parameters& p, double rate) {
  const bool is_rk3 = p.time_scheme == TimeScheme::rk3;
  double squares = 0.0;
  for (const int n : p.cells) squares += n > 1 ? static_cast<double>(n) * n : 0.0;
  return 1.0 / (rate / (is_rk3 ? 1.4 : 0.7) + 4.0 * p.viscosity * squares / (is_rk3 ? 2.5 : 1.0));
}

TEST(FlowControl, StepSizeFollowsTheVelocity) {
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3})
    for (const double cfl : {0.5, 0.1}) {
      Parameters p = periodic_box({12, 10, 9});
      p.time_scheme = time;
      p.cfl = cfl;
      const FlowDomain domain(p);
      const auto solver = started(backend, p, random_field(domain, 1));
      for (std::int64_t step = 1; step <= 3; ++step) {
        const double expected = cfl / rate(domain, velocity(*solver));
        ASSERT_EQ(solver->advance(endless, step, {}), Stop::pause);
        EXPECT_NEAR(solver->progress().last_dt, expected, 1e-14 * expected);
      }
      EXPECT_LE(solver->progress().dt_min, solver->progress().last_dt);
      EXPECT_GE(solver->progress().dt_max, solver->progress().last_dt);
    }
}

TEST(FlowControl, StepSizesOfMirrorImagesAreEqual) {
  // Fluid enters on one side and leaves on the next; it is fastest on both.
  for (std::size_t in = 0; in < 3; ++in) {
    const std::size_t out = (in + 1) % 3;
    std::vector<double> steps;
    for (std::size_t orientation = 0; orientation < 4; ++orientation) {
      Parameters p = periodic_box({8, 8, 8});
      const std::size_t inflow = 2 * in + orientation % 2, outflow = 2 * out + orientation / 2;
      for (const std::size_t axis : {in, out})
        p.boundary[2 * axis].kind = p.boundary[2 * axis + 1].kind = BoundaryKind::slip;
      p.boundary[inflow].kind = BoundaryKind::inflow;
      p.boundary[inflow].velocity[in] = orientation % 2 == 0 ? 3.0 : -3.0;
      p.boundary[outflow].kind = BoundaryKind::outflow;
      const auto solver = started(backend, p, FlowDomain(p).zero_field());
      ASSERT_EQ(solver->advance(endless, 2, {}), Stop::pause);
      EXPECT_LT(solver->progress().dt_max, 1.0 / (3.0 * 8.0));
      EXPECT_NEAR(solver->progress().dt_max, steps.empty() ? solver->progress().dt_max : steps[0], 1e-12);
      EXPECT_NEAR(solver->progress().last_dt, steps.empty() ? solver->progress().last_dt : steps[1], 1e-12);
      steps.insert(steps.end(), {solver->progress().dt_max, solver->progress().last_dt});
    }
  }
}

TEST(FlowControl, RatesOfAdvectionAndDiffusionAddUp) {
  // The standard CFL number is 1 for RK3 and 0.5 for AB2, the limit of diffusion 2.5 and 1.
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3})
    for (const double cfl : {0.0, 0.3}) {
      Parameters p = periodic_box({12, 10, 9});
      p.density = 2.0;
      p.viscosity = 0.2;
      p.time_scheme = time;
      p.cfl = cfl;
      const bool is_rk3 = time == TimeScheme::rk3;
      const double used = cfl > 0.0 ? cfl : is_rk3 ? 1.0 : 0.5, interval = is_rk3 ? 2.5 : 1.0;
      const FlowDomain domain(p);
      const auto solver = started(backend, p, random_field(domain, 1));
      const double diffusion = 4.0 * 0.1 * (144.0 + 100.0 + 81.0) / (0.9 * interval);  // a tenth in reserve
      const double expected = 1.0 / (rate(domain, velocity(*solver)) / used + diffusion);
      ASSERT_EQ(solver->advance(endless, 1, {}), Stop::pause);
      EXPECT_NEAR(solver->progress().last_dt, expected, 1e-13 * expected);
    }
}

TEST(FlowControl, ImplicitDiffusionLimitsTheStepSizeByItsAccuracyAlone) {
  // Noise in a box with walls. Steps begin at a part of the bound of explicit diffusion and exceed it once
  // the noise has decayed.
  Parameters p = mixed_box();
  for (Boundary& side : p.boundary) side = {BoundaryKind::wall, {0.0, 0.0, 0.0}, {}};
  p.viscosity = 2.0;
  p.time_scheme = TimeScheme::ab2;
  p.diffusion = Diffusion::crank_nicolson;
  const FlowDomain domain(p);
  const auto solver = started(backend, p, random_field(domain, 1));
  double energy = solver->totals().kinetic_energy;
  const double explicit_dt = stable_dt_of(p, 0.0);
  for (int step = 1; step <= 200; ++step) {
    const double largest = 0.5 / rate(domain, velocity(*solver));
    ASSERT_EQ(solver->advance(endless, step, {}), Stop::pause);
    if (step == 1) {
      EXPECT_NEAR(solver->progress().last_dt, 0.1 * explicit_dt, 1e-13 * explicit_dt);
    }
    EXPECT_LE(solver->progress().last_dt, largest * (1.0 + 1e-13));
    EXPECT_LT(solver->totals().kinetic_energy, energy);
    energy = solver->totals().kinetic_energy;
  }
  EXPECT_GT(solver->progress().last_dt, explicit_dt);
  // A steady flow, which pressure drives between walls.
  p.boundary[0] = p.boundary[1] = {BoundaryKind::periodic, {}, {}};
  p.boundary[4] = p.boundary[5] = {BoundaryKind::periodic, {}, {}};
  p.pressure_drop[0] = 8.0 * p.viscosity * 0.1;
  const auto steady = started(backend, p, FlowDomain(p).zero_field());
  ASSERT_EQ(steady->advance(endless, 400, {}), Stop::pause);
  const double expected = 0.5 / rate(FlowDomain(p), velocity(*steady));
  EXPECT_GT(expected, 100.0 * explicit_dt);
  EXPECT_NEAR(steady->progress().last_dt, expected, 0.01 * expected);
}

TEST(FlowControl, FailedImplicitStepKeepsThePressureBeforeTheStep) {
  Parameters p = periodic_box({8, 7, 1});
  p.viscosity = 0.1;
  p.time_scheme = TimeScheme::ab2;
  p.diffusion = Diffusion::crank_nicolson;
  p.fixed_dt = 0.01;
  const auto solver = started(backend, p, random_field(FlowDomain(p), 2));
  ASSERT_EQ(solver->advance(endless, 3, {}), Stop::pause);
  const std::vector<double> before = download(*solver, "pressure");
  EXPECT_GT(largest(before), 0.01);
  std::vector<double> rate = download(*solver, "rate_x");
  rate[5] = std::numeric_limits<double>::quiet_NaN();
  solver->upload("rate_x", rate);
  ASSERT_EQ(solver->advance(endless, 4, {}), Stop::failed);
  EXPECT_EQ(download(*solver, "pressure"), before);
}

std::vector<std::pair<Advection, double>> advections_and_viscosities() {
  std::vector<std::pair<Advection, double>> pairs;
  for (const Advection scheme : {Advection::central, Advection::weno_js, Advection::weno_z})
    for (const double viscosity : {0.003, 0.01, 0.03, 0.1}) pairs.emplace_back(scheme, viscosity);
  return pairs;
}

TEST(FlowControl, ViscousNoiseDecays) {
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3})
    for (const auto& [scheme, viscosity] : advections_and_viscosities()) {
      Parameters p = periodic_box({37, 1, 14});
      p.time_scheme = time;
      p.advection = scheme;
      p.viscosity = viscosity;
      const auto solver = started(backend, p, random_field(FlowDomain(p), 6));
      double before = solver->totals().kinetic_energy;
      for (int steps = 20; steps <= 100; steps += 20) {
        ASSERT_EQ(solver->advance(endless, steps, {}), Stop::pause);
        const double after = solver->totals().kinetic_energy;
        EXPECT_LT(after, before) << static_cast<int>(scheme) << " viscosity " << viscosity;
        before = after;
      }
    }
}

TEST(FlowControl, FixedAndLargestStepSizesHold) {
  Parameters p = periodic_box({8, 8, 1});
  p.fixed_dt = 3e-3;
  const auto fixed = started(backend, p, random_field(FlowDomain(p), 1));
  ASSERT_EQ(fixed->advance(endless, 4, {}), Stop::pause);
  EXPECT_EQ(fixed->progress().dt_min, 3e-3);
  EXPECT_EQ(fixed->progress().dt_max, 3e-3);
  p.fixed_dt = 0.0;
  p.max_dt = 2e-4;
  const auto limited = started(backend, p, FlowDomain(p).zero_field());
  ASSERT_EQ(limited->advance(endless, 4, {}), Stop::pause);
  EXPECT_EQ(limited->progress().last_dt, 2e-4);
}

TEST(FlowControl, MeetsTargetsAndPausesExactly) {
  Parameters p = periodic_box({8, 7, 6});
  const auto solver = started(backend, p, random_field(FlowDomain(p), 2));
  for (const double target : {0.1, 0.1000001, 0.37}) {
    ASSERT_EQ(solver->advance(target, -1, {}), Stop::target);
    EXPECT_EQ(solver->progress().time, target);
  }
  const std::int64_t step = solver->progress().step;
  EXPECT_EQ(solver->advance(0.37, -1, {}), Stop::target);
  EXPECT_EQ(solver->progress().step, step);
  ASSERT_EQ(solver->advance(endless, step + 3, {}), Stop::pause);
  EXPECT_EQ(solver->progress().step, step + 3);
}

TEST(FlowControl, StopsAtTheLargestNumberOfStepsAndOnInterrupt) {
  Parameters p = periodic_box({8, 7, 6});
  p.max_steps = 5;
  const auto solver = started(backend, p, random_field(FlowDomain(p), 2));
  EXPECT_EQ(solver->advance(endless, -1, {}), Stop::max_steps);
  EXPECT_EQ(solver->progress().step, 5);
  p.max_steps = 1'000'000'000;
  const auto interrupted = started(backend, p, random_field(FlowDomain(p), 2));
  EXPECT_EQ(interrupted->advance(endless, -1, [](const Status&) { return false; }), Stop::interrupted);
}

#if defined(DROGUE_HAVE_HYPRE)
TEST(FlowControl, IterativePressureSolverGivesTheVelocityOfTheDirectOne) {
  testing::start_hypre();
  Parameters p = mixed_box();
  const FlowDomain domain(p);
  const StaggeredField initial = random_field(domain, 7);
  const auto direct = started(backend, p, initial);
  p.pressure_solver = PressureSolver::hypre_pfmg;
  p.pressure_tolerance = 1e-12;
  const auto iterative = started(backend, p, initial);
  EXPECT_STREQ(iterative->pressure_solver(), "hypre-pfmg");
  EXPECT_STREQ(iterative->driver(), "plain");
  ASSERT_EQ(direct->advance(endless, 5, {}), Stop::pause);
  ASSERT_EQ(iterative->advance(endless, 5, {}), Stop::pause);
  EXPECT_LT(largest_difference(velocity(*iterative), velocity(*direct)), 1e-9);
}

TEST(FlowControl, ReportsAPressureSolverThatDoesNotConverge) {
  testing::start_hypre();
  Parameters p = periodic_box({12, 10, 9});
  p.pressure_solver = PressureSolver::hypre_pfmg;
  p.pressure_tolerance = 1e-300;
  const FlowDomain domain(p);
  const auto solver = started(backend, p, random_field(domain, 8));
  EXPECT_EQ(solver->advance(endless, 3, {}), Stop::failed);
  EXPECT_EQ(solver->failure().reason, FailureReason::pressure_solver);
}

TEST(FlowControl, FirstPressureOfImplicitDiffusionThatDoesNotConvergeFailsTheStart) {
  testing::start_hypre();
  // Only a force at right angles to two walls sets the fluid in motion, whose initial projection is exact.
  Parameters p = periodic_box({12, 10, 9});
  p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::wall;
  p.body_force = {0.0, -9.81, 0.0};
  p.viscosity = 0.1;
  time_integrations[2].set(p);
  p.pressure_solver = PressureSolver::hypre_pfmg;
  for (const double tolerance : {1e-10, 1e-300}) {
    p.pressure_tolerance = tolerance;
    const auto solver = started(backend, p, FlowDomain(p).zero_field());
    const double residual = solver->last_pressure_solve()->residual;
    if (tolerance == 1e-10) {
      EXPECT_LT(residual, tolerance);
      EXPECT_EQ(solver->advance(endless, 3, {}), Stop::pause);
      continue;
    }
    ASSERT_GT(residual, tolerance);
    EXPECT_EQ(solver->advance(endless, 3, {}), Stop::failed);
    EXPECT_EQ(solver->failure().reason, FailureReason::pressure_solver);
    EXPECT_EQ(solver->failure().step, 1);
    EXPECT_EQ(solver->failure().pressure_residual, residual);
    EXPECT_TRUE(std::isnan(solver->failure().dt));  // before any step
  }
}
#endif

TEST(FlowControl, ReportsTheFirstCellOfAnInitialVelocityThatIsNotFinite) {
  const Parameters p = periodic_box({8, 7, 5});
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    StaggeredField u = random_field(FlowDomain(p), 2);
    u[1][58] = bad;  // the face below cell (2, 0, 1), and above the last one of the row
    const auto solver = started(backend, p, u);
    EXPECT_EQ(solver->advance(1.0, -1, {}), Stop::failed);
    EXPECT_EQ(solver->failure().reason, FailureReason::not_finite);
    EXPECT_EQ(solver->failure().step, 1);
    EXPECT_EQ(solver->failure().index, 58);
  }
}

TEST(FlowControl, FailsWhereTheStepSizeDoesNotChangeTheTime) {
  const Parameters p = periodic_box({8, 7, 1});
  const auto solver = started(backend, p, random_field(FlowDomain(p), 2));
  Progress progress = solver->progress();
  progress.time = 1e20;
  solver->restore(progress);
  EXPECT_EQ(solver->advance(2e20, -1, {}), Stop::failed);
  EXPECT_EQ(solver->failure().reason, FailureReason::time_step);
  EXPECT_EQ(solver->failure().index, -1);
}

TEST(FlowControl, FluidAtRestMeetsAnyTarget) {
  const Parameters p = periodic_box({8, 7, 1});
  const auto solver = started(backend, p, FlowDomain(p).zero_field());
  EXPECT_EQ(solver->advance(1.0, -1, {}), Stop::target);
  EXPECT_EQ(velocity(*solver), FlowDomain(p).zero_field());
}

TEST(FlowControl, NonFiniteRateFailsAndKeepsTheVelocityBeforeTheStep) {
  Parameters p = periodic_box({8, 7, 1});
  p.time_scheme = TimeScheme::ab2;
  const auto solver = started(backend, p, random_field(FlowDomain(p), 2));
  ASSERT_EQ(solver->advance(endless, 2, {}), Stop::pause);
  const StaggeredField before = velocity(*solver);
  std::vector<double> rate = download(*solver, "rate_x");
  rate[20] = HUGE_VAL;
  solver->upload("rate_x", rate);
  ASSERT_EQ(solver->advance(endless, 5, {}), Stop::failed);
  EXPECT_EQ(solver->failure().reason, FailureReason::not_finite);
  EXPECT_EQ(solver->failure().step, 3);
  EXPECT_GE(solver->failure().index, 0);
  EXPECT_EQ(velocity(*solver), before);
}

TEST(FlowControl, FixedStepsBeyondTheStabilityLimitFailAndNameTheLimit) {
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3})
    for (const double viscosity : {0.0, 0.02}) {
      Parameters p = periodic_box({9, 8, 7});
      p.time_scheme = time;
      p.viscosity = viscosity;
      const FlowDomain domain(p);
      const StaggeredField initial = random_field(domain, 2);
      const StaggeredField before = velocity(*started(backend, p, initial));
      const double limit = stable_dt_of(p, rate(domain, before));
      for (const double dt : {1.001 * limit, 1e30}) {
        p.fixed_dt = dt;
        const auto solver = started(backend, p, initial);
        ASSERT_EQ(solver->advance(endless, 1, {}), Stop::failed);
        EXPECT_EQ(solver->failure().reason, FailureReason::time_step);
        EXPECT_EQ(solver->failure().step, 1);
        EXPECT_NEAR(solver->failure().dt, limit, 1e-13 * limit);
        EXPECT_EQ(velocity(*solver), before);
      }
      p.fixed_dt = 0.999 * limit;
      const auto stable = started(backend, p, initial);
      EXPECT_EQ(stable->advance(endless, 1, {}), Stop::pause);
      // A short way to the target is one stable step.
      p.fixed_dt = 1e30;
      const auto shortened = started(backend, p, initial);
      EXPECT_EQ(shortened->advance(0.9 * limit, -1, {}), Stop::target);
    }
}

TEST(FlowControl, FixedStepsOfFluidAtRestFailOnceItMovesTooFast) {
  Parameters p = periodic_box({8, 1, 1});
  p.body_force = {1.0, 0.0, 0.0};
  p.fixed_dt = 0.25;
  const FlowDomain domain(p);
  const auto solver = started(backend, p, domain.zero_field());
  // After n steps the CFL number of the next one is n / 2.
  ASSERT_EQ(solver->advance(endless, 10, {}), Stop::failed);
  EXPECT_EQ(solver->failure().reason, FailureReason::time_step);
  EXPECT_EQ(solver->failure().step, 4);
  EXPECT_NEAR(solver->failure().dt, 1.4 / (0.75 * 8.0), 1e-12);
}

TEST(FlowControl, ImplicitDiffusionAdmitsLargerFixedSteps) {
  Parameters p = periodic_box({9, 8, 7});
  p.time_scheme = TimeScheme::ab2;
  p.diffusion = Diffusion::crank_nicolson;
  p.viscosity = 1.0;
  const FlowDomain domain(p);
  const StaggeredField initial = random_field(domain, 2);
  const double most = rate(domain, velocity(*started(backend, p, initial)));
  // Twice the viscosity over the square of the largest spacing, 1/7, and of the rate.
  const double limit = 2.0 * 49.0 / (most * most);
  ASSERT_GT(limit, 0.7 / most);
  p.fixed_dt = 0.999 * limit;
  EXPECT_EQ(started(backend, p, initial)->advance(endless, 1, {}), Stop::pause);
  p.fixed_dt = 1.001 * limit;
  const auto unstable = started(backend, p, initial);
  ASSERT_EQ(unstable->advance(endless, 1, {}), Stop::failed);
  EXPECT_NEAR(unstable->failure().dt, limit, 1e-13 * limit);
}

TEST(FlowControl, StartKeepsAVelocityFreeOfDivergence) {
  for (const Parameters& p : {periodic_box({9, 8, 7}), mixed_box()}) {
    const auto first = started(backend, p, random_field(FlowDomain(p), 3));
    const StaggeredField u = velocity(*first);
    EXPECT_LT(largest_difference(velocity(*started(backend, p, u)), u), 1e-13);
  }
}

TEST(FlowControl, RestartContinuesBitForBit) {
  for (const TimeIntegration& integration : time_integrations)
    for (Parameters p : {periodic_box({9, 8, 7}), mixed_box()}) {
      integration.set(p);
      p.viscosity = 0.5;
      const auto solver = started(backend, p, random_field(FlowDomain(p), 4));
      ASSERT_EQ(solver->advance(endless, 3, {}), Stop::pause);
      const auto restarted = create_solver(backend, p);
      const std::vector<stepping::StateArray> state = solver->state();
      EXPECT_EQ(state.size(), p.time_scheme == TimeScheme::ab2 ? 7U : 4U);
      for (const stepping::StateArray& array : state) EXPECT_EQ(array.whole, array.extent);
      copy_state(*solver, *restarted);
      restarted->restore(solver->progress());
      ASSERT_EQ(solver->advance(endless, 6, {}), Stop::pause);
      ASSERT_EQ(restarted->advance(endless, 6, {}), Stop::pause);
      EXPECT_EQ(velocity(*restarted), velocity(*solver));
      EXPECT_EQ(download(*restarted, "pressure"), download(*solver, "pressure"));
      EXPECT_EQ(restarted->progress().time, solver->progress().time);
    }
}

// Blocks divide the columns of cells among teams.
TEST(FlowControl, BlockSizeDoesNotChangeTheResult) {
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
    Parameters p = mixed_box();
    p.cells = {40, 24, 9};
    p.time_scheme = time;
    const StaggeredField start = random_field(FlowDomain(p), 1);
    const auto after = [&](int block) {
      p.block = block;
      const auto solver = started(backend, p, start);
      EXPECT_EQ(solver->advance(endless, 3, {}), Stop::pause);
      return velocity(*solver);
    };
    const StaggeredField usual = after(0);
    for (const int block : {32, 96, 512}) EXPECT_EQ(after(block), usual) << block;
  }
}

TEST(FlowControl, RejectsArraysThatTheStateLacks) {
  Parameters p = periodic_box({8, 7, 1});
  p.time_scheme = TimeScheme::rk3;
  const auto solver = create_solver(backend, p);
  std::vector<double> cells(56), wrong(57);
  EXPECT_THROW(solver->upload("velocity_x", wrong), std::invalid_argument);
  EXPECT_THROW(solver->download("pressure", wrong), std::invalid_argument);
  EXPECT_THROW(solver->upload("rate_x", cells), std::invalid_argument);
  EXPECT_THROW(solver->download("rate_x", cells), std::invalid_argument);
  EXPECT_THROW(solver->sample(CellField::velocity, wrong), std::invalid_argument);
}

TEST(FlowControl, RejectsParametersWithoutASolution) {
  const auto rejects = [](const auto& change) {
    Parameters p = periodic_box({8, 7, 6});
    change(p);
    EXPECT_THROW(check_parameters(p), std::invalid_argument);
  };
  rejects([](Parameters& p) { p.cells = {1, 1, 1}; });
  rejects([](Parameters& p) { p.cells[0] = 3; });
  rejects([](Parameters& p) { p.cells[2] = -4; });
  rejects([](Parameters& p) { p.high[1] = p.low[1]; });
  rejects([](Parameters& p) { p.density = 0.0; });
  rejects([](Parameters& p) { p.viscosity = -1.0; });
  rejects([](Parameters& p) { p.viscosity = std::nan(""); });
  rejects([](Parameters& p) { p.cfl = -0.5; });
  rejects([](Parameters& p) { p.cfl = std::nan(""); });
  rejects([](Parameters& p) { p.cfl = HUGE_VAL; });
  rejects([](Parameters& p) { p.cfl = 1.5; });
  rejects([](Parameters& p) { p.block = 48; });
  rejects([](Parameters& p) { p.block = 544; });
  rejects([](Parameters& p) {
    p.cfl = 0.8;
    p.time_scheme = TimeScheme::ab2;
  });
  rejects([](Parameters& p) { p.boundary[0].kind = BoundaryKind::wall; });
  rejects([](Parameters& p) {
    p.boundary[0].kind = p.boundary[1].kind = BoundaryKind::slip;
    p.pressure_drop[0] = 1.0;
  });
  rejects([](Parameters& p) {
    p.boundary[0].kind = BoundaryKind::inflow;
    p.boundary[1].kind = BoundaryKind::wall;
    p.boundary[0].velocity = {1.0, 0.0, 0.0};
  });
  rejects([](Parameters& p) {
    p.cells[2] = 1;
    p.boundary[4].kind = p.boundary[5].kind = BoundaryKind::wall;
  });
  rejects([](Parameters& p) {
    p.time_scheme = TimeScheme::rk3;
    p.diffusion = Diffusion::crank_nicolson;
  });
  EXPECT_NO_THROW(check_parameters(periodic_box({8, 7, 6})));
}

TEST(FlowLaunches, StepsDoNotFenceAllocateOrCopy) {
  for (const TimeIntegration& integration : time_integrations)
    for (Parameters p : {periodic_box({9, 8, 7}), mixed_box()}) {
      integration.set(p);
      const bool captured = backend == device::Backend::cuda;
      if (!captured) p.pressure_solver = PressureSolver::fft;
      const auto solver = started(backend, p, random_field(FlowDomain(p), 4));
      ASSERT_EQ(solver->advance(endless, 1, {}), Stop::pause);
      const auto cost = [&](std::int64_t steps) {
        const std::int64_t now = solver->progress().step;
        const auto before = profiled();
        EXPECT_EQ(solver->advance(endless, now + steps, {}), Stop::pause);
        const auto after = profiled();
        EXPECT_EQ(after.allocations - before.allocations, 0);
        EXPECT_EQ(after.copies - before.copies, 0);
        return std::pair{after.kernel_launches - before.kernel_launches, after.fences - before.fences};
      };
      const auto few = cost(10), many = cost(60);
      EXPECT_EQ(many.second, few.second);
      // Momentum, divergence, six transforms, scaling, correction and ghost cells a stage; boundary faces
      // where the box is bounded. Implicit diffusion: source, six transforms, scaling and update of each
      // component. A captured step is one launch.
      const std::int64_t stages = p.time_scheme == TimeScheme::ab2 ? 1 : 3;
      const std::int64_t a_stage = 11 + (p.boundary[0].kind == BoundaryKind::periodic ? 0 : 1) +
                                   (p.diffusion == Diffusion::crank_nicolson ? 3 * 9 : 0);
      EXPECT_LE(many.first - few.first, 50 * (captured ? 1 : stages * a_stage + 1));
    }
}

}  // namespace
}  // namespace drogue::flow
