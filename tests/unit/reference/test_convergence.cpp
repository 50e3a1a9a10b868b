// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "kernels/reference/gas/advection.hpp"
#include "kernels/reference/gas/run.hpp"

namespace drogue::reference {
namespace {

using std::numbers::pi;

/// Errors by number of cells.
using Errors = std::map<std::size_t, double>;

/// Least-squares slope of -log(error) against log(cells).
double order(const Errors& errors) {
  const double n = static_cast<double>(errors.size());
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (const auto& [cells, error] : errors) {
    const double x = std::log2(static_cast<double>(cells));
    const double y = -std::log2(error);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void expect_within(const Errors& errors, const Errors& published, double tolerance) {
  for (const auto& [cells, error] : published)
    EXPECT_NEAR(errors.at(cells), error, tolerance * error) << cells << " cells";
}

/// Mean |error| of the density of the entropy wave after one period.
double entropy_wave_error(std::size_t cells, gas::Weno weno, int power) {
  gas::Parameters p;
  p.cells = static_cast<std::int64_t>(cells);
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

Errors entropy_wave_errors(gas::Weno weno, int power) {
  Errors errors;
  for (const std::size_t cells : {20u, 28u, 40u, 56u, 80u})
    errors[cells] = entropy_wave_error(cells, weno, power);
  return errors;
}

TEST(Convergence, JsConvergesOnTheEntropyWave) {
  const Errors errors = entropy_wave_errors(gas::Weno::js, 1);
  expect_within(errors, {{20, 2.871e-4}, {40, 8.949e-6}, {80, 2.783e-7}}, 0.05);
  EXPECT_GE(order(errors), 4.8);
}

TEST(Convergence, Z2ConvergesOnTheEntropyWave) {
  const Errors errors = entropy_wave_errors(gas::Weno::z, 2);
  expect_within(errors, {{20, 4.023e-5}, {40, 1.272e-6}, {80, 3.990e-8}}, 0.05);
  EXPECT_GE(order(errors), 4.8);
}

TEST(Convergence, JsConvergesOnScalarAdvection) {
  Errors errors;
  for (const std::size_t cells : {10u, 20u, 40u, 80u, 160u, 320u}) {
    const auto wave = [](double x) { return std::sin(pi * x); };
    const std::vector<double> u = advect(cells, wave, 1.0, gas::Weno::js, 1, 1.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < cells; ++i) {
      const double x = -1.0 + 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(cells);
      sum += std::abs(u[i] - wave(x - 1.0));
    }
    errors[cells] = sum / static_cast<double>(cells);
  }
  expect_within(errors,
                {{10, 1.72e-2}, {20, 7.62e-4}, {40, 2.33e-5}, {80, 7.23e-7}, {160, 2.26e-8}, {320, 7.04e-10}},
                0.01);
  EXPECT_GE(order(errors), 4.8);
}

}  // namespace
}  // namespace drogue::reference
