// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/flow_case.hpp"

// Orders of convergence in space and time, on flows with exact solutions.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests

constexpr const auto& backend = testing::tested_backend;
constexpr Advection schemes[] = {Advection::central, Advection::weno_js, Advection::weno_z};

constexpr double drift[3] = {0.8, -0.5, 0.0};

/// Two-dimensional vortices of Taylor and Green, m/s, that drift with a uniform flow, s and kinematic
/// viscosity given.
StaggeredField taylor_green(const FlowDomain& domain, double time) {
  const double decay = std::exp(-2.0 * domain.parameters().viscosity * time);
  return sampled_field(domain, [&](std::size_t c, const reference::Point& point) {
    const double x = point[0] - drift[0] * time, y = point[1] - drift[1] * time;
    if (c == 2) return 0.0;
    return drift[c] + decay * (c == 0 ? std::sin(x) * std::cos(y) : -std::cos(x) * std::sin(y));
  });
}

Parameters taylor_green_parameters(int n, Advection advection, TimeScheme time) {
  Parameters p = periodic_box({n, n, 1});
  p.high = {2.0 * std::numbers::pi, 2.0 * std::numbers::pi, 1.0};
  p.viscosity = 0.02;
  p.advection = advection;
  p.time_scheme = time;
  return p;
}

/// Velocity at a time.
StaggeredField solution(const Parameters& p, const StaggeredField& initial, double time) {
  const auto solver = started(backend, p, initial);
  EXPECT_EQ(solver->advance(time, -1, {}), Stop::target);
  return velocity(*solver);
}

/// Orders between consecutive errors, each with half the step of the one before.
std::vector<double> orders(const std::vector<double>& errors) {
  std::vector<double> result;
  for (std::size_t i = 1; i < errors.size(); ++i) result.push_back(std::log2(errors[i - 1] / errors[i]));
  return result;
}

TEST(FlowConvergence, IsOfSecondOrderInSpaceForDriftingVortices) {
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3})
    for (const Advection scheme : schemes) {
      std::vector<double> errors;
      for (const int n : {32, 64, 128}) {
        Parameters p = taylor_green_parameters(n, scheme, time);
        p.cfl = 0.3;
        const FlowDomain domain(p);
        errors.push_back(
            rms_difference(solution(p, taylor_green(domain, 0.0), 1.0), taylor_green(domain, 1.0)));
      }
      // The errors of upwind-biased advection, of fifth order, and of the rest partly cancel on coarse grids.
      EXPECT_GE(orders(errors).back(), 1.9) << static_cast<int>(scheme);
      EXPECT_LT(errors.back(), scheme == Advection::central ? 2e-4 : 2e-5);
    }
}

/// Errors of time integration: differences to a solution with a much smaller step.
std::vector<double> time_errors(Parameters p, const StaggeredField& initial) {
  constexpr double end = 0.8;
  p.fixed_dt = end / 1024;
  const StaggeredField fine = solution(p, initial, end);
  std::vector<double> errors;
  for (const int steps : {16, 32, 64}) {
    p.fixed_dt = end / steps;
    errors.push_back(rms_difference(solution(p, initial, end), fine));
  }
  return errors;
}

std::vector<double> time_errors(const Parameters& p) {
  return time_errors(p, taylor_green(FlowDomain(p), 0.0));
}

TEST(FlowConvergence, AdamsBashforthIsOfSecondOrderInTime) {
  for (const Advection scheme : schemes)
    for (const double order : orders(time_errors(taylor_green_parameters(24, scheme, TimeScheme::ab2))))
      EXPECT_GE(order, 1.9) << static_cast<int>(scheme);
}

TEST(FlowConvergence, RungeKuttaIsOfThirdOrderInTimeWithSmoothFluxes) {
  for (const double order :
       orders(time_errors(taylor_green_parameters(24, Advection::central, TimeScheme::rk3))))
    EXPECT_GE(order, 2.8);
}

TEST(FlowConvergence, RungeKuttaIsOfSecondOrderInTimeAtLeast) {
  for (const Advection scheme : schemes)
    for (const double order : orders(time_errors(taylor_green_parameters(24, scheme, TimeScheme::rk3))))
      EXPECT_GE(order, 1.9) << static_cast<int>(scheme);
}

TEST(FlowConvergence, CrankNicolsonIsOfSecondOrderInTimeInPeriodicBoxes) {
  Parameters p = taylor_green_parameters(24, Advection::weno_z, TimeScheme::ab2);
  p.diffusion = Diffusion::crank_nicolson;
  for (const double order : orders(time_errors(p))) EXPECT_GE(order, 1.9);
}

TEST(FlowConvergence, CrankNicolsonIsOfSecondOrderInTimeBetweenWalls) {
  // A vortex at rest on the walls. Without the pressure of the previous step in the implicit equation the
  // order is one.
  const double pi = std::numbers::pi;
  Parameters p;
  p.cells = {24, 24, 1};
  p.viscosity = 0.05;
  p.time_scheme = TimeScheme::ab2;
  p.diffusion = Diffusion::crank_nicolson;
  for (const std::size_t side : {0U, 1U, 2U, 3U}) p.boundary[side].kind = BoundaryKind::wall;
  const auto vortex = sampled_field(FlowDomain(p), [&](std::size_t c, const reference::Point& at) {
    const double x = at[0], y = at[1];
    if (c == 0) return std::pow(std::sin(pi * x), 2) * std::sin(2.0 * pi * y);
    return c == 1 ? -std::sin(2.0 * pi * x) * std::pow(std::sin(pi * y), 2) : 0.0;
  });
  for (const double order : orders(time_errors(p, vortex))) EXPECT_GE(order, 1.9);
}

TEST(FlowConvergence, PoiseuilleFlowIsOfSecondOrderInSpace) {
  for (const Advection scheme : {Advection::central, Advection::weno_z}) {
    std::vector<double> errors;
    for (const int n : {8, 16, 32}) {
      Parameters p;
      p.cells = {4, n, 1};
      p.viscosity = 0.1;
      p.density = 2.0;
      p.pressure_drop = {0.4, 0.0, 0.0};
      p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::wall;
      p.advection = scheme;
      const FlowDomain domain(p);
      const auto exact = sampled_field(domain, [](std::size_t c, const reference::Point& point) {
        return c == 0 ? 0.4 / (2.0 * 0.1) * point[1] * (1.0 - point[1]) : 0.0;
      });
      errors.push_back(rms_difference(solution(p, domain.zero_field(), 60.0), exact));
    }
    for (const double order : orders(errors)) EXPECT_GE(order, 1.9);
  }
}

TEST(FlowConvergence, OscillatingPlateIsOfSecondOrder) {
  // Second problem of Stokes, u = exp(-k y) cos(w t - k y) with k = sqrt(w / (2 nu)).
  constexpr double omega = 4.0, nu = 0.02, k = 10.0;
  static_assert(k * k * 2.0 * nu == omega);
  const auto velocity_of_plate = [](double y) {
    device::ExpressionBuilder builder;
    builder.push("constant", std::exp(-k * y));
    builder.push("t");
    builder.push("constant", omega);
    builder.push("*");
    builder.push("constant", k * y);
    builder.push("-");
    builder.push("cos");
    builder.push("*");
    return builder.program();
  };
  device::ExpressionBuilder zero;
  zero.push("constant", 0.0);
  for (const TimeIntegration& integration : time_integrations) {
    std::vector<double> errors;
    for (const int n : {32, 64, 128}) {
      Parameters p;
      p.cells = {1, n, 1};
      p.high = {1.0, 0.5, 1.0};
      p.viscosity = nu;
      integration.set(p);
      p.cfl = 0.5;
      // Steps of up to 40 times the bound of explicit diffusion.
      if (p.diffusion == Diffusion::crank_nicolson) p.fixed_dt = 1.0 / n;
      p.horizon = 1.0;
      for (const std::size_t side : {2U, 3U}) {
        p.boundary[side].kind = BoundaryKind::wall;
        p.boundary[side].velocity_expressions = {velocity_of_plate(side == 2 ? 0.0 : 0.5), zero.program(),
                                                 zero.program()};
      }
      const FlowDomain domain(p);
      const auto exact = [&](double t) {
        return sampled_field(domain, [t](std::size_t c, const reference::Point& point) {
          return c == 0 ? std::exp(-k * point[1]) * std::cos(omega * t - k * point[1]) : 0.0;
        });
      };
      errors.push_back(rms_difference(solution(p, exact(0.0), 1.0), exact(1.0)));
    }
    for (const double order : orders(errors)) EXPECT_GE(order, 1.9);
  }
}

}  // namespace
}  // namespace drogue::flow
