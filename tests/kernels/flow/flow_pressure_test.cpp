// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/expression_program.hpp"
#include "tests/support/flow_case.hpp"
#if defined(DROGUE_HAVE_HYPRE)
#include "tests/support/hypre_session.hpp"
#endif

// Pressure in time, at the start and through outflows.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests

constexpr const auto& backend = testing::tested_backend;

/// Vortices of Taylor and Green that drift with a uniform flow.
Parameters vortices(int n) {
  Parameters p = periodic_box({n, n, 1});
  p.high = {2.0 * std::numbers::pi, 2.0 * std::numbers::pi, 1.0};
  p.viscosity = 0.02;
  return p;
}

std::unique_ptr<Solver> started_vortices(const Parameters& p) {
  return started(backend, p, sampled_field(FlowDomain(p), [](std::size_t c, const auto& point) {
                   const double x = point[0], y = point[1];
                   if (c == 0) return 0.8 + std::sin(x) * std::cos(y);
                   return c == 1 ? -0.5 - std::cos(x) * std::sin(y) : 0.0;
                 }));
}

/// Pressure of the present velocity, Pa; x fastest for a grid with one cell along z.
std::vector<double> sampled_pressure(Solver& solver, const Parameters& p) {
  const auto nx = static_cast<std::size_t>(p.cells[0]), ny = static_cast<std::size_t>(p.cells[1]);
  std::vector<double> samples(nx * ny), values(nx * ny);
  solver.sample(CellField::pressure, samples);
  for (std::size_t i = 0; i < nx; ++i)
    for (std::size_t j = 0; j < ny; ++j) values[i + nx * j] = samples[i * ny + j];
  return values;
}

void expect_orders(const std::vector<double>& errors, double least) {
  for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_GE(std::log2(errors[i - 1] / errors[i]), least);
}

TEST(FlowPressure, IsOfSecondOrderInSpaceAtTheStart) {
  std::vector<double> errors;
  for (const int n : {16, 32, 64}) {
    const Parameters p = vortices(n);
    const auto solver = started_vortices(p);
    std::vector<double> error = sampled_pressure(*solver, p);
    const double h = 2.0 * std::numbers::pi / n;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        error[static_cast<std::size_t>(i + n * j)] -=
            0.25 * (std::cos(2.0 * (i + 0.5) * h) + std::cos(2.0 * (j + 0.5) * h));
    errors.push_back(largest(error));
  }
  EXPECT_LT(errors.back(), 2e-3);
  expect_orders(errors, 1.9);
}

TEST(FlowPressure, SamplesAreOfSecondOrderInTimeAndThoseOfAStepAtItsMiddle) {
  constexpr double end = 0.8;
  for (const TimeIntegration& integration : time_integrations) {
    Parameters p = vortices(16);
    integration.set(p);
    const auto at = [&](double time, double dt) {
      p.fixed_dt = dt;
      auto solver = started_vortices(p);
      EXPECT_EQ(solver->advance(time, -1, {}), Stop::target);
      return solver;
    };
    const std::vector<double> fine = sampled_pressure(*at(end, end / 1024), p);
    std::vector<double> samples, middle, last;
    for (const int steps : {16, 32, 64}) {
      const double dt = end / steps;
      const auto solver = at(end, dt);
      const std::vector<double> of_step = download(*solver, "pressure");
      samples.push_back(largest_difference(sampled_pressure(*solver, p), fine));
      last.push_back(largest_difference(of_step, fine));
      middle.push_back(largest_difference(of_step, sampled_pressure(*at(end - 0.5 * dt, end / 1024), p)));
    }
    expect_orders(samples, 1.9);
    expect_orders(middle, 1.9);
    EXPECT_GT(last.back(), 10.0 * middle.back());
  }
}

TEST(FlowPressure, CrankNicolsonIsStableAndOfSecondOrderThroughAnOutflow) {
  // Poiseuille flow with nu dt / h^2 = 20.
  std::vector<double> errors;
  for (const int n : {8, 16, 32}) {
    Parameters p = periodic_box({2 * n, n, 1});
    p.high[0] = 2.0;
    p.viscosity = 100.0;
    p.time_scheme = TimeScheme::ab2;
    p.diffusion = Diffusion::crank_nicolson;
    p.fixed_dt = 20.0 / (p.viscosity * n * n);
    p.boundary[0].kind = BoundaryKind::inflow;
    p.boundary[0].velocity_expressions = {postfix({4.0, "y", "*", 1.0, "y", "-", "*"}), postfix({0.0}),
                                          postfix({0.0})};
    p.boundary[1].kind = BoundaryKind::outflow;
    p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::wall;
    const FlowDomain domain(p);
    const auto solver = started(backend, p, domain.zero_field());
    ASSERT_EQ(solver->advance(endless, 1000, {}), Stop::pause);
    const auto exact = sampled_field(domain, [](std::size_t c, const auto& point) {
      return c == 0 ? 4.0 * point[1] * (1.0 - point[1]) : 0.0;
    });
    errors.push_back(rms_difference(velocity(*solver), exact));
    const std::vector<double> pressure = download(*solver, "pressure");
    const auto middle = static_cast<std::size_t>(n + n * n);  // in the middle of the channel
    EXPECT_NEAR((pressure[middle + 1] - pressure[middle]) * n, -8.0 * p.viscosity, 16.0 * p.viscosity / n);
  }
  EXPECT_LT(errors.back(), 5e-3);
  expect_orders(errors, 1.8);
}

TEST(FlowPressure, CrankNicolsonDampsNoiseBetweenOutflows) {
  for (const double number : {0.5, 5.0, 50.0, 5000.0}) {
    Parameters p = periodic_box({9, 8, 7});
    p.time_scheme = TimeScheme::ab2;
    p.diffusion = Diffusion::crank_nicolson;
    p.fixed_dt = 1e-3;
    p.viscosity = number / (64.0 * p.fixed_dt);
    const BoundaryKind kinds[] = {BoundaryKind::outflow, BoundaryKind::outflow, BoundaryKind::outflow,
                                  BoundaryKind::slip,    BoundaryKind::wall,    BoundaryKind::outflow};
    for (std::size_t side = 0; side < 6; ++side) p.boundary[side].kind = kinds[side];
    const auto solver = started(backend, p, random_field(FlowDomain(p), 9));
    const double before = solver->totals().kinetic_energy;
    ASSERT_EQ(solver->advance(endless, 400, {}), Stop::pause) << number;
    EXPECT_LT(solver->totals().kinetic_energy, before) << number;
  }
}

#if defined(DROGUE_HAVE_HYPRE)
TEST(FlowPressure, RestartOfAnIterativeSolverContinuesBitForBit) {
  testing::start_hypre();
  for (const TimeIntegration& integration : time_integrations) {
    Parameters p = vortices(12);
    integration.set(p);
    p.pressure_solver = PressureSolver::hypre_pfmg;
    const auto solver = started_vortices(p);
    ASSERT_EQ(solver->advance(endless, 3, {}), Stop::pause);
    const auto restarted = create_solver(backend, p);
    copy_state(*solver, *restarted);
    restarted->restore(solver->progress());
    sampled_pressure(*solver, p);  // leaves the state as it is
    ASSERT_EQ(solver->advance(endless, 6, {}), Stop::pause);
    ASSERT_EQ(restarted->advance(endless, 6, {}), Stop::pause);
    EXPECT_EQ(velocity(*restarted), velocity(*solver));
    EXPECT_EQ(download(*restarted, "pressure"), download(*solver, "pressure"));
  }
}

TEST(FlowPressure, ToleranceBelowRoundOffIsNotReached) {
  testing::start_hypre();
  Parameters p = vortices(12);
  p.pressure_solver = PressureSolver::hypre_pfmg;
  p.pressure_tolerance = 1e-30;
  const auto solver = started_vortices(p);
  EXPECT_EQ(solver->advance(endless, 3, {}), Stop::failed);
  EXPECT_EQ(solver->failure().reason, FailureReason::pressure_solver);
  EXPECT_GT(solver->failure().pressure_residual, 1e-30);
  EXPECT_LT(solver->failure().pressure_residual, 1e-10);
}
#endif

}  // namespace
}  // namespace drogue::flow
