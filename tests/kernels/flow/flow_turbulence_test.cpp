#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "kernels/flow/make_grid.hpp"
#include "kernels/flow/turbulence/eddy_viscosity.hpp"
#include "tests/support/flow_case.hpp"
#include "tests/support/profiled.hpp"

// Eddy-viscosity models: values for random gradients, their stress, and their absence.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests

constexpr const auto& backend = testing::tested_backend;

Parameters box(const std::array<int, 3>& cells, Turbulence model) {
  Parameters p = periodic_box(cells);
  p.turbulence = model;
  p.advection = Advection::central;
  p.fixed_dt = 0.01;
  return p;
}

TEST(FlowTurbulence, EddyViscosityMatchesTheInvariantsOfRandomGradients) {
  std::mt19937 engine(4);
  std::normal_distribution<double> normal;
  Parameters p = periodic_box({8, 10, 16});
  const MacGrid grid = make_grid(p);
  const double width[] = {1.0 / 8.0, 1.0 / 10.0, 1.0 / 16.0};
  for (int sample = 0; sample < 50; ++sample) {
    double g[3][3], strain = 0.0, norm = 0.0, beta[3][3] = {}, trace = 0.0, squares = 0.0;
    for (auto& row : g)
      for (double& value : row) value = normal(engine);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        strain += 2.0 * std::pow(0.5 * (g[i][j] + g[j][i]), 2);
        norm += g[i][j] * g[i][j];
        for (int m = 0; m < 3; ++m) beta[i][j] += width[m] * width[m] * g[i][m] * g[j][m];
      }
    for (int i = 0; i < 3; ++i) {
      trace += beta[i][i];
      for (int j = 0; j < 3; ++j) squares += beta[i][j] * beta[j][i];
    }
    p.turbulence = Turbulence::smagorinsky;
    const double mean_width = std::cbrt(width[0] * width[1] * width[2]);
    const double smagorinsky = std::pow(0.17 * mean_width, 2) * std::sqrt(strain);
    EXPECT_NEAR(eddy_viscosity(make_eddy_model(p, grid), g), smagorinsky, 1e-13 * smagorinsky);
    p.turbulence = Turbulence::vreman;
    // The second invariant of a matrix: half of the squared trace less the trace of the square.
    const double vreman = 0.07 * std::sqrt(0.5 * (trace * trace - squares) / norm);
    EXPECT_NEAR(eddy_viscosity(make_eddy_model(p, grid), g), vreman, 1e-12 * vreman);
  }
}

/// Change of a shear flow u(y) in one Euler step by Smagorinsky's stress, m/s, from its definition.
std::vector<double> change_of_shear(const std::vector<double>& u, double h, double squared_width, double dt) {
  const std::size_t n = u.size();
  const auto at = [n](std::size_t j, int shift) {
    return (j + n + static_cast<std::size_t>(shift + static_cast<int>(n))) % n;
  };
  std::vector<double> slope(n), viscosity(n), change(n);
  for (std::size_t j = 0; j < n; ++j) slope[j] = (u[j] - u[at(j, -1)]) / h;
  for (std::size_t j = 0; j < n; ++j)
    viscosity[j] = 0.17 * 0.17 * squared_width * std::abs(0.5 * (slope[j] + slope[at(j, 1)]));
  const auto stress = [&](std::size_t j) { return 0.5 * (viscosity[j] + viscosity[at(j, -1)]) * slope[j]; };
  for (std::size_t j = 0; j < n; ++j) change[j] = dt * (stress(at(j, 1)) - stress(j)) / h;
  return change;
}

TEST(FlowTurbulence, StressOfAShearFlowIsThatOfItsDefinition) {
  Parameters p = box({8, 12, 1}, Turbulence::smagorinsky);
  p.time_scheme = TimeScheme::ab2;  // whose first step is Euler's
  const FlowDomain domain(p);
  std::vector<double> profile(12);
  for (std::size_t j = 0; j < 12; ++j)
    profile[j] =
        std::sin(2.0 * M_PI * (static_cast<double>(j) + 0.5) / 12.0) + 0.1 * static_cast<double>(j % 3);
  const StaggeredField initial = sampled_field(domain, [&](std::size_t c, const reference::Point& x) {
    return c == 0 ? profile[static_cast<std::size_t>(x[1] * 12.0)] : 0.0;
  });
  const auto solver = started(backend, p, initial);
  ASSERT_EQ(solver->advance(endless, 1, {}), Stop::pause);
  const StaggeredField now = velocity(*solver);
  const std::vector<double> change = change_of_shear(profile, 1.0 / 12.0, 1.0 / (8.0 * 12.0), p.fixed_dt);
  EXPECT_GT(largest(change), 1e-3);
  for (std::size_t j = 0; j < 12; ++j)
    for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(now[0][i + 8 * j] - profile[j], change[j], 1e-14);
}

TEST(FlowTurbulence, VremansModelLeavesLaminarShearAlone) {
  Parameters p = box({8, 12, 10}, Turbulence::vreman);
  const FlowDomain domain(p);
  const StaggeredField initial = sampled_field(domain, [](std::size_t c, const reference::Point& x) {
    return c == 0 ? std::sin(2.0 * M_PI * x[1]) : 0.0;
  });
  const auto solver = started(backend, p, initial);
  ASSERT_EQ(solver->advance(endless, 5, {}), Stop::pause);
  EXPECT_LT(largest_difference(velocity(*solver), initial), 1e-14);
}

TEST(FlowTurbulence, ModelsTakeEnergyFromRandomFlowAndKeepItsMomentum) {
  Parameters p = box({12, 10, 9}, Turbulence::none);
  p.time_scheme = TimeScheme::rk3;
  p.fixed_dt = 1e-3;
  const FlowDomain domain(p);
  const StaggeredField initial = random_field(domain, 5);
  const auto without = started(backend, p, initial);
  ASSERT_EQ(without->advance(endless, 5, {}), Stop::pause);
  for (const Turbulence model : {Turbulence::smagorinsky, Turbulence::vreman}) {
    p.turbulence = model;
    const auto with = started(backend, p, initial);
    const Totals before = with->totals();
    ASSERT_EQ(with->advance(endless, 5, {}), Stop::pause);
    const Totals after = with->totals();
    EXPECT_LT(after.kinetic_energy, without->totals().kinetic_energy - 1e-4 * before.kinetic_energy);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(after.momentum[c], before.momentum[c], 1e-13);
  }
}

TEST(FlowTurbulence, LaunchAtMostTwoKernelsPerStage) {
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
    std::int64_t launches[2] = {};
    for (const bool asked : {false, true}) {
      Parameters p = box({12, 10, 9}, asked ? Turbulence::vreman : Turbulence::none);
      p.time_scheme = time;
      p.driver = Driver::plain;
      const auto solver = started(backend, p, random_field(FlowDomain(p), 6));
      ASSERT_EQ(solver->advance(endless, 1, {}), Stop::pause);
      const auto before = profiled();
      ASSERT_EQ(solver->advance(endless, 2, {}), Stop::pause);
      launches[asked ? 1 : 0] = profiled().kernel_launches - before.kernel_launches;
    }
    EXPECT_LE(launches[1], launches[0] + 2 * (time == TimeScheme::ab2 ? 1 : 3));
  }
}

}  // namespace
}  // namespace drogue::flow
