#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/expression_program.hpp"
#include "tests/support/flow_case.hpp"

// dt where the velocity of the present does not bound it: fluid at rest that sides, forces and pressure drops
// set in motion, implicit diffusion, and sides whose velocity is an expression of t.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests

constexpr const auto& backend = testing::tested_backend;
constexpr double pi = std::numbers::pi;

/// Periodic in x, with walls at y = 0 and y = 1.
Parameters channel(int cells, double viscosity) {
  Parameters p = periodic_box({4, cells, 1});
  p.viscosity = viscosity;
  p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::wall;
  return p;
}

/// Time integrations with all other parameters as they are by default.
template <class Check>
void for_each_integration(const Check& check) {
  for (const TimeIntegration& integration : time_integrations) {
    SCOPED_TRACE(integration.diffusion == Diffusion::crank_nicolson ? "crank-nicolson"
                 : integration.time == TimeScheme::rk3              ? "rk3"
                                                                    : "ab2");
    check(integration);
  }
}

/// Largest error of the x velocity at faces against a function of y.
template <class Exact>
double error_of(Solver& solver, const Parameters& p, const Exact& exact) {
  const FlowDomain domain(p);
  return largest_difference(velocity(solver), sampled_field(domain, [&](std::size_t c, const auto& point) {
                              return c == 0 ? exact(point[1]) : 0.0;
                            }));
}

TEST(FlowTimeStep, CouetteFlowFromRest) {
  for_each_integration([](const TimeIntegration& integration) {
    Parameters p = channel(32, 0.1);
    integration.set(p);
    p.boundary[3].velocity = {1.0, 0.0, 0.0};
    for (const double end : {0.1, 1.0, 4.0}) {
      const auto solver = started(backend, p, FlowDomain(p).zero_field());
      ASSERT_EQ(solver->advance(end, -1, {}), Stop::target);
      const double error = error_of(*solver, p, [end](double y) {
        double u = y;
        for (int n = 1; n < 60; ++n)
          u += 2.0 / (n * pi) * (n % 2 == 0 ? 1.0 : -1.0) * std::exp(-0.1 * n * n * pi * pi * end) *
               std::sin(n * pi * y);
        return u;
      });
      EXPECT_LT(error, 4e-3) << end;  // 32 cells
    }
  });
}

TEST(FlowTimeStep, PoiseuilleFlowFromRestByForceOrPressureDrop) {
  for_each_integration([](const TimeIntegration& integration) {
    for (const bool by_drop : {false, true})
      for (const double viscosity : {0.05, 20.0}) {
        Parameters p = channel(32, viscosity);
        integration.set(p);
        // The velocity tends to 1 m/s in the middle.
        (by_drop ? p.pressure_drop : p.body_force)[0] = 8.0 * viscosity;
        for (const double share : {0.01, 0.1, 1.0}) {
          const double end = share / viscosity;
          const auto solver = started(backend, p, FlowDomain(p).zero_field());
          ASSERT_EQ(solver->advance(end, -1, {}), Stop::target);
          const double error = error_of(*solver, p, [&](double y) {
            double u = 4.0 * y * (1.0 - y);
            for (int n = 1; n < 80; n += 2)
              u -= 32.0 / std::pow(n * pi, 3) * std::exp(-n * n * pi * pi * share) * std::sin(n * pi * y);
            return u;
          });
          EXPECT_LT(error, 2e-3) << viscosity << " " << share;
        }
      }
  });
}

TEST(FlowTimeStep, ShearWaveDecaysByImplicitDiffusion) {
  Parameters p = periodic_box({4, 64, 1});
  p.viscosity = 0.1;
  p.time_scheme = TimeScheme::ab2;
  p.diffusion = Diffusion::crank_nicolson;
  for (const double mean : {0.0, 0.5}) {
    const FlowDomain domain(p);
    const auto solver = started(backend, p, sampled_field(domain, [&](std::size_t c, const auto& point) {
                                  return c == 0 ? mean + 0.01 * std::sin(2.0 * pi * point[1]) : 0.0;
                                }));
    for (const double end : {0.2, 1.0, 10.0}) {
      ASSERT_EQ(solver->advance(end, -1, {}), Stop::target);
      const double rate = 0.1 * 4.0 * 64.0 * 64.0 * std::pow(std::sin(pi / 64.0), 2);
      const double exact = 0.01 * std::exp(-rate * end);
      EXPECT_LT(error_of(*solver, p, [&](double y) { return mean + exact * std::sin(2.0 * pi * y); }),
                0.02 * std::max(exact, 1e-15) + 1e-15);
    }
  }
}

TEST(FlowTimeStep, LidSetsFluidOfLittleViscosityInMotion) {
  for_each_integration([](const TimeIntegration& integration) {
    Parameters p = periodic_box({32, 32, 1});
    integration.set(p);
    p.viscosity = 2e-5;
    for (std::size_t side = 0; side < 4; ++side) p.boundary[side].kind = BoundaryKind::wall;
    p.boundary[3].velocity = {1.0, 0.0, 0.0};
    const auto solver = started(backend, p, FlowDomain(p).zero_field());
    ASSERT_EQ(solver->advance(2.0, -1, {}), Stop::target);
    p.max_dt = 0.005;
    const auto fine = started(backend, p, FlowDomain(p).zero_field());
    ASSERT_EQ(fine->advance(2.0, -1, {}), Stop::target);
    EXPECT_LT(largest_difference(velocity(*solver), velocity(*fine)), 4e-3);
    EXPECT_LT(solver->progress().step, fine->progress().step);
  });
}

TEST(FlowTimeStep, GrowsByDegreesAndStaysStableWithinEveryStep) {
  for_each_integration([](const TimeIntegration& integration) {
    Parameters p = periodic_box({24, 20, 1});
    integration.set(p);
    p.viscosity = 1e-3;
    for (std::size_t side = 0; side < 4; ++side) p.boundary[side].kind = BoundaryKind::wall;
    p.boundary[3].velocity = {3.0, 0.0, 0.0};
    const auto solver = started(backend, p, FlowDomain(p).zero_field());
    double last = 0.0;
    for (int step = 1; step <= 60; ++step) {
      ASSERT_EQ(solver->advance(endless, step, {}), Stop::pause);
      const double dt = solver->progress().last_dt;
      if (last > 0.0) {
        EXPECT_LE(dt, 1.5 * last * (1.0 + 1e-12)) << step;
      }
      const double rate = std::bit_cast<double>(solver->progress().velocity_rate_bits);
      EXPECT_LE(dt * rate, 1.1 * stable_cfl(p.time_scheme)) << step;
      last = dt;
    }
  });
}

TEST(FlowTimeStep, FailsAfterAStepOfTooMuchGrowthAtTheTargetToo) {
  Parameters p = periodic_box({32, 32, 1});
  p.viscosity = 2e-5;
  for (std::size_t side = 0; side < 4; ++side) p.boundary[side].kind = BoundaryKind::wall;
  p.boundary[3].velocity = {1.0, 0.0, 0.0};
  p.fixed_dt = 2.0;
  const auto solver = started(backend, p, FlowDomain(p).zero_field());
  EXPECT_EQ(solver->advance(2.0, -1, {}), Stop::failed);
  EXPECT_EQ(solver->failure().reason, FailureReason::time_step);
  EXPECT_LT(solver->failure().dt, 1.0);
}

TEST(FlowTimeStep, OscillatingPlateOfImplicitDiffusionIsResolved) {
  // Stokes 1851, between plates, with steps that nothing but the motion bounds.
  for_each_integration([](const TimeIntegration& integration) {
    Parameters p = channel(64, 0.12566370614359174);
    integration.set(p);
    p.horizon = 2.0;
    const auto plate = [](double factor, double phase) {
      return postfix({"t", 2.0 * pi, "*", phase, "-", "cos", factor, "*"});
    };
    p.boundary[2].velocity_expressions = {plate(1.0, 0.0), postfix({0.0}), postfix({0.0})};
    p.boundary[3].velocity_expressions = {plate(std::exp(-5.0), 5.0), postfix({0.0}), postfix({0.0})};
    const auto exact = [](double t) {
      return [t](double y) { return std::exp(-5.0 * y) * std::cos(2.0 * pi * t - 5.0 * y); };
    };
    const auto solver =
        started(backend, p, sampled_field(FlowDomain(p), [&](std::size_t c, const auto& point) {
                  return c == 0 ? exact(0.0)(point[1]) : 0.0;
                }));
    ASSERT_EQ(solver->advance(2.0, -1, {}), Stop::target);
    EXPECT_LT(error_of(*solver, p, exact(2.0)), 4e-3);
  });
}

TEST(FlowTimeStep, InflowThatBeginsLateIsNotOverrun) {
  for_each_integration([](const TimeIntegration& integration) {
    Parameters p = periodic_box({24, 16, 1});
    p.high = {1.5, 1.0, 1.0};
    integration.set(p);
    p.viscosity = 1e-3;
    p.horizon = 2.0;
    p.boundary[0].kind = BoundaryKind::inflow;
    p.boundary[0].velocity_expressions = {postfix({"t", 1.0, "<", 0.0, 1.5, "select"}), postfix({0.0}),
                                          postfix({0.0})};
    p.boundary[1].kind = BoundaryKind::outflow;
    p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::slip;
    const auto solver = started(backend, p, FlowDomain(p).zero_field());
    ASSERT_EQ(solver->advance(0.9, -1, {}), Stop::target);
    EXPECT_LT(solver->progress().step, 12);
    EXPECT_EQ(solver->totals().max_speed, 0.0);
    double most = 0.0;
    for (std::int64_t step = solver->progress().step + 1; solver->advance(2.0, step, {}) == Stop::pause;
         ++step)
      most = std::max(most, solver->totals().max_speed);
    EXPECT_EQ(solver->progress().time, 2.0);
    EXPECT_NEAR(most, 1.5, 1e-10);
  });
}

TEST(FlowTimeStep, ClosedBoxUnderGravityStaysAtRest) {
  for (const double viscosity : {0.0, 1.0, 100.0})
    for (const TimeIntegration& integration : time_integrations) {
      Parameters p = periodic_box({8, 8, 8});
      integration.set(p);
      p.viscosity = viscosity;
      p.density = 1000.0;
      for (Boundary& side : p.boundary) side.kind = BoundaryKind::wall;
      p.body_force = {0.0, 0.0, -9810.0};
      const auto solver = started(backend, p, FlowDomain(p).zero_field());
      ASSERT_EQ(solver->advance(endless, 3, {}), Stop::pause);
      EXPECT_LT(solver->totals().max_speed, 1e-12) << viscosity;
      // Round-off does not limit the steps.
      ASSERT_EQ(solver->advance(10.0, -1, {}), Stop::target);
      EXPECT_LT(solver->totals().max_speed, 1e-11) << viscosity;
      if (p.diffusion == Diffusion::crank_nicolson) {
        EXPECT_LT(solver->progress().step, 300);
      }
    }
}

TEST(FlowTimeStep, RestartsBitForBitWhileStepsGrow) {
  for_each_integration([](const TimeIntegration& integration) {
    Parameters p = channel(16, 0.3);
    integration.set(p);
    p.horizon = 1.0;
    p.boundary[3].velocity_expressions = {postfix({"t", 20.0, "*", "sin"}), postfix({0.0}), postfix({0.0})};
    p.boundary[2].velocity = {1.0, 0.0, 0.0};
    const auto solver = started(backend, p, FlowDomain(p).zero_field());
    for (const std::int64_t step : {0, 1, 4}) {
      if (step > 0) {
        ASSERT_EQ(solver->advance(1.0, step, {}), Stop::pause);
      }
      const auto again = create_solver(backend, p);
      copy_state(*solver, *again);
      again->restore(solver->progress());
      ASSERT_EQ(again->advance(1.0, 9, {}), Stop::pause);
      const auto whole = started(backend, p, FlowDomain(p).zero_field());
      ASSERT_EQ(whole->advance(1.0, 9, {}), Stop::pause);
      EXPECT_EQ(velocity(*again), velocity(*whole)) << step;
      EXPECT_EQ(again->progress().time, whole->progress().time) << step;
    }
  });
}

TEST(FlowTimeStep, PowersOfTwoInUnitsChangeNoBit) {
  // Unit of time 2^k s: velocities, forces and viscosity scale with it.
  for_each_integration([](const TimeIntegration& integration) {
    const auto run = [&](double unit, double& end_time, std::int64_t& steps) {
      Parameters p = channel(16, 0.01 / unit);
      integration.set(p);
      p.horizon = 2.0 * unit;
      p.body_force = {0.125 / (unit * unit), -1.0 / (unit * unit), 0.0};
      p.boundary[3].velocity_expressions = {postfix({"t", unit, "/", 2.0, "*", unit, "/"}), postfix({0.0}),
                                            postfix({0.0})};
      const auto solver = started(backend, p, FlowDomain(p).zero_field());
      std::vector<double> pressures(2 * 64);
      std::vector<double> pressure(64);
      solver->sample(CellField::pressure, pressure);
      std::ranges::copy(pressure, pressures.begin());
      EXPECT_EQ(solver->advance(2.0 * unit, -1, {}), Stop::target);
      solver->sample(CellField::pressure, pressure);
      std::ranges::copy(pressure, pressures.begin() + 64);
      end_time = solver->progress().last_dt / unit;
      steps = solver->progress().step;
      for (double& value : pressures) value *= unit * unit;
      return pressures;
    };
    double dt = 0.0, scaled_dt = 0.0;
    std::int64_t steps = 0, scaled_steps = 0;
    const auto expected = run(1.0, dt, steps);
    for (const int power : {-40, 40}) {
      const auto found = run(std::ldexp(1.0, power), scaled_dt, scaled_steps);
      EXPECT_EQ(scaled_steps, steps) << power;
      EXPECT_EQ(scaled_dt, dt) << power;
      EXPECT_EQ(found, expected) << power;
    }
  });
}

}  // namespace
}  // namespace drogue::flow
