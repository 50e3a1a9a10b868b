#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "kernels/options/pricer.hpp"
#include "tests/support/priced.hpp"

// Stated errors where two grids tell less of them than elsewhere.

namespace drogue::options {
namespace {

using testing::on_mesh;
using testing::priced;
using testing::priced_by_fourier;

std::vector<Price> priced_to(double tolerance, const std::vector<Contract>& contracts) {
  Settings settings;
  settings.tolerance = tolerance;
  return priced(settings, contracts);
}

constexpr std::array<std::array<double, 4>, 5> laws = {{{1.0, 8.15, -2.5, 0.767},
                                                        {-0.5, 15.0, -5.0, 0.5},
                                                        {2.0, 11.0, -5.0, 0.0},
                                                        {-1.2, 3.0, -1.5, 0.4},
                                                        {1.0, 30.0, -8.0, 0.2}}};

Contract put(Style style, double spot, double maturity, double variance, const std::array<double, 4>& jump) {
  Contract c{.style = style,
             .spot = spot,
             .strike = 1.0,
             .rate = 0.05,
             .dividend = 0.01,
             .maturity = maturity,
             .variance = variance};
  std::ranges::copy(jump, c.jump);
  return c;
}

/// Expects that nine of ten errors are below what is stated and that half are not ten times as small.
void expect_covered(const std::vector<Price>& prices, const std::vector<Price>& known, const char* what) {
  std::vector<double> ratio;
  for (std::size_t k = 0; k < prices.size(); ++k) {
    const double error = std::abs(prices[k].price - known[k].price);
    ratio.push_back((prices[k].error + known[k].error) / (error + 1e-9));
  }
  std::ranges::sort(ratio);
  const auto at = [&](double part) {
    return ratio[static_cast<std::size_t>(part * static_cast<double>(ratio.size() - 1))];
  };
  std::printf("%s: stated over true error %.2g, %.2g, %.2g at 2, 10, 50 %% of the rows\n", what, at(0.02),
              at(0.1), at(0.5));
  EXPECT_GE(at(0.1), 1.0) << what;
  EXPECT_LE(at(0.5), 10.0) << what;
}

// Heavy tails make steps so long that Brownian motion spreads the payoff over few of them.
TEST(OptionsError, AnHourToAWeek) {
  std::vector<Contract> contracts;
  for (const auto& law : laws)
    for (const double hours : {1.0, 24.0, 168.0})
      for (const double spot : {1.0, 1.003, 1.02})
        for (const double variance : {0.01, 0.04})
          contracts.push_back(put(Style::european, spot, hours / 8760.0, variance, law));
  const std::vector<Price> known = priced_by_fourier(contracts);
  expect_covered(priced(on_mesh(256, 64), contracts), known, "256 intervals");
  expect_covered(priced_to(1e-5, contracts), known, "tolerance 1e-5");
}

// There the errors of two grids do not follow from one another.
TEST(OptionsError, BesideTheBoundaryOfExercise) {
  std::vector<Contract> contracts;
  for (const auto& law : laws)
    for (const double maturity : {0.25, 2.0}) {
      const Contract at_the_money = put(Style::american, 1.0, maturity, 0.04, law);
      const double boundary = priced(on_mesh(256, 64), {at_the_money}).front().exercise_boundary;
      for (const double above : {0.001, 0.004, 0.01, 0.02, 0.05})
        contracts.push_back(put(Style::american, boundary * (1.0 + above), maturity, 0.04, law));
    }
  const std::vector<Price> known = priced(on_mesh(1024, 512), contracts);
  for (const int mesh : {128, 256})
    expect_covered(priced(on_mesh(mesh, mesh / 4), contracts), known,
                   mesh == 128 ? "128 intervals" : "256 intervals");
}

// A jump that is the same every time falls between nodes. It is shared by them so that its mean stays.
TEST(OptionsError, JumpsThatAreAlike) {
  std::vector<Contract> contracts;
  for (const double jump : {-0.5, -0.31, 0.17})
    for (const double deviation : {0.0, 1e-6, 1e-2})
      for (const double spot : {0.8, 1.0, 1.25}) {
        contracts.push_back(put(Style::european, spot, 1.0, 0.02, {0.4, jump, deviation, 0.0}));
        contracts.back().model = Model::merton;
      }
  const std::vector<Price> known = priced_by_fourier(contracts);
  const auto largest = [&](int mesh) {
    const std::vector<Price> prices = priced(on_mesh(mesh, mesh), contracts);
    double error = 0.0;
    for (std::size_t k = 0; k < prices.size(); ++k)
      error = std::max(error, std::abs(prices[k].price - known[k].price));
    return error;
  };
  const double rough = largest(128), fine = largest(512);
  std::printf("alike jumps: %.1e with 128 intervals, %.1e with 512\n", rough, fine);
  EXPECT_LT(rough, 2e-4);
  EXPECT_GT(rough / fine, 12.0);
  expect_covered(priced_to(1e-5, contracts), known, "alike jumps, tolerance 1e-5");
}

}  // namespace
}  // namespace drogue::options
