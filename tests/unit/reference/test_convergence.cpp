#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "kernels/reference/gas/advection.hpp"
#include "kernels/reference/gas/run.hpp"

namespace drogue::reference {
namespace {

using std::numbers::pi;

/// Least-squares slope of -log(error) against log(cells), cells doubling.
double order(const std::vector<double>& errors) {
  const double n = static_cast<double>(errors.size());
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const double x = static_cast<double>(k);
    const double y = -std::log2(errors[k]);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void expect_within(const std::vector<double>& errors, const std::vector<double>& published,
                   double tolerance) {
  ASSERT_EQ(errors.size(), published.size());
  for (std::size_t k = 0; k < errors.size(); ++k)
    EXPECT_NEAR(errors[k], published[k], tolerance * published[k]) << "mesh " << k;
}

/// Mean |error| of the density of the entropy wave after one period.
double entropy_wave_error(std::int64_t cells, gas::Weno weno, int power) {
  gas::Parameters p;
  p.cells = cells;
  p.weno = weno;
  p.weno_power = power;
  p.left = p.right = gas::Boundary::periodic;
  p.positivity = gas::Positivity::off;
  const double largest_speed = 1.0 + std::sqrt(1.4 / 0.8);
  p.fixed_dt = 0.5 * std::pow(2.0 / static_cast<double>(cells), 5.0 / 3.0) / largest_speed;
  const auto rho = [](double x) { return 1.0 + 0.2 * std::sin(pi * x); };
  const GasRun run = reference_run(
      p,
      [&](double x) {
        return Primitive{rho(x), 1.0, 1.0};
      },
      2.0);
  return l1_density(run, p, rho) / 2.0;
}

TEST(Convergence, EntropyWaveJs) {
  std::vector<double> errors;
  for (const std::int64_t cells : {20, 40, 80, 160})
    errors.push_back(entropy_wave_error(cells, gas::Weno::js, 1));
  expect_within(errors, {2.871e-4, 8.949e-6, 2.783e-7, 8.603e-9}, 0.05);
  EXPECT_GE(order(errors), 4.8);
}

TEST(Convergence, EntropyWaveZ2) {
  std::vector<double> errors;
  for (const std::int64_t cells : {20, 40, 80, 160})
    errors.push_back(entropy_wave_error(cells, gas::Weno::z, 2));
  expect_within(errors, {4.023e-5, 1.272e-6, 3.990e-8, 1.248e-9}, 0.05);
  EXPECT_GE(order(errors), 4.8);
}

TEST(Convergence, ScalarAdvectionJs) {
  std::vector<double> errors;
  for (const std::size_t cells : {10u, 20u, 40u, 80u, 160u, 320u}) {
    const auto wave = [](double x) { return std::sin(pi * x); };
    const std::vector<double> u = advect(cells, wave, 1.0, gas::Weno::js, 1, 1.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < cells; ++i) {
      const double x = -1.0 + 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(cells);
      sum += std::abs(u[i] - wave(x - 1.0));
    }
    errors.push_back(sum / static_cast<double>(cells));
  }
  expect_within(errors, {1.72e-2, 7.62e-4, 2.33e-5, 7.23e-7, 2.26e-8, 7.04e-10}, 0.01);
  EXPECT_GE(order(errors), 4.8);
}

}  // namespace
}  // namespace drogue::reference
