// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "kernels/options/pricer.hpp"
#include "tests/support/priced.hpp"

// Error estimates in cases in which the difference of two grids contains less of the error than usual.

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

constexpr std::array<std::array<double, 4>, 5> jump_parameters = {{{1.0, 8.15, -2.5, 0.767},
                                                                   {-0.5, 15.0, -5.0, 0.5},
                                                                   {2.0, 11.0, -5.0, 0.0},
                                                                   {-1.2, 3.0, -1.5, 0.4},
                                                                   {1.0, 30.0, -8.0, 0.2}}};

Contract put(Style style, double spot, double maturity, double variance, const std::array<double, 4>& jump,
             JumpModel model = JumpModel::generalized_hyperbolic) {
  Contract c{.model = model,
             .style = style,
             .spot = spot,
             .strike = 1.0,
             .rate = 0.05,
             .dividend = 0.01,
             .maturity = maturity,
             .variance = variance};
  std::ranges::copy(jump, c.jump);
  return c;
}

/// Expects that all errors but a `part` are below their estimates, and that the median ratio of estimate and
/// error is at most `most`.
void expect_covered(const std::vector<Price>& prices, const std::vector<Price>& known, const char* what,
                    double most = 10.0, double part = 0.1) {
  std::vector<double> ratio;
  for (std::size_t k = 0; k < prices.size(); ++k) {
    const double error = std::abs(prices[k].price - known[k].price);
    ratio.push_back((prices[k].error + known[k].error) / (error + 1e-9));
  }
  std::ranges::sort(ratio);
  const auto at = [&](double share) {
    return ratio[static_cast<std::size_t>(share * static_cast<double>(ratio.size() - 1))];
  };
  std::printf("%s: stated over true error %.2g, %.2g, %.2g at 2, 10, 50 %% of the rows\n", what, at(0.02),
              at(0.1), at(0.5));
  EXPECT_GE(at(part), 1.0) << what;
  EXPECT_LE(at(0.5), most) << what;
}

// With heavy tails the grid is so coarse that Brownian motion spreads the payoff over few intervals.
TEST(OptionsError, CoversMaturitiesFromAnHourToAWeek) {
  std::vector<Contract> contracts;
  for (const auto& jump : jump_parameters)
    for (const double hours : {1.0, 24.0, 168.0})
      for (const double spot : {1.0, 1.003, 1.02})
        for (const double variance : {0.01, 0.04})
          contracts.push_back(put(Style::european, spot, hours / 8760.0, variance, jump));
  const std::vector<Price> known = priced_by_fourier(contracts);
  expect_covered(priced(on_mesh(256, 64), contracts), known, "256 intervals");
  expect_covered(priced_to(1e-5, contracts), known, "tolerance 1e-5");
}

// Near the boundary the errors of the two grids are not proportional.
TEST(OptionsError, CoversSpotsNearTheExerciseBoundary) {
  std::vector<Contract> contracts;
  for (const auto& jump : jump_parameters)
    for (const double maturity : {0.25, 2.0}) {
      const Contract at_the_money = put(Style::american, 1.0, maturity, 0.04, jump);
      const double boundary = priced(on_mesh(256, 64), {at_the_money}).front().exercise_boundary;
      for (const double above : {0.001, 0.004, 0.01, 0.02, 0.05})
        contracts.push_back(put(Style::american, boundary * (1.0 + above), maturity, 0.04, jump));
    }
  const std::vector<Price> known = priced(on_mesh(1024, 512), contracts);
  for (const int mesh : {128, 256})
    expect_covered(priced(on_mesh(mesh, mesh / 4), contracts), known,
                   mesh == 128 ? "128 intervals" : "256 intervals");
}

// The boundary hardly moves, so that the error of exercise at nodes affects distant spots.
TEST(OptionsError, CoversBoundariesThatHardlyMoveForDecades) {
  std::vector<Contract> contracts;
  for (const double variance : {0.04, 0.09, 0.2})
    for (const double rate : {0.04, 0.06, 0.09})
      for (const double maturity : {15.0, 30.0})
        for (const double spot : {0.95, 1.3}) {
          contracts.push_back(put(Style::american, spot, maturity, variance, {}, JumpModel::black_scholes));
          contracts.back().rate = rate;
        }
  const std::vector<Price> known = priced(on_mesh(2048, 1024), contracts);
  expect_covered(priced_to(3e-6, contracts), known, "a boundary that stands");
}

// Split exercise has an error of first order in time, which the difference of the grids does not contain.
TEST(OptionsError, CoversExerciseBetweenTwoBoundaries) {
  std::vector<Contract> contracts;
  for (const auto& jump : jump_parameters)
    for (const double years : {0.5, 3.0})
      for (const double spot : {0.8, 1.0, 1.25})
        for (const double rate : {-0.005, -0.03}) {
          contracts.push_back(put(Style::american, spot, years, 0.03, jump));
          contracts.back().rate = rate;
          contracts.back().dividend = rate - 0.05;
        }
  const std::vector<Price> known = priced(on_mesh(512, 2048), contracts);
  for (const double tolerance : {1e-4, 1e-5})
    expect_covered(priced_to(tolerance, contracts), known,
                   ("between two boundaries, tolerance " + std::to_string(tolerance)).c_str());
  expect_covered(priced(on_mesh(64, 512), contracts), known, "between two boundaries, many steps");
}

// The kink of the payoff spreads over less than an interval.
TEST(OptionsError, CoversMaturitiesOfHoursAtTheStrike) {
  std::vector<Contract> contracts;
  for (const auto& jump : jump_parameters)
    for (const double hours : {1.0, 3.0})
      for (const double variance : {0.01, 0.02, 0.04})
        contracts.push_back(put(Style::european, 1.0, hours / 8760.0, variance, jump));
  const std::vector<Price> known = priced_by_fourier(contracts);
  expect_covered(priced(on_mesh(128, 32), contracts), known, "an hour at the strike");
  // The order is low, but meshes up to 1024 reach the tolerance.
  Contract heavy = put(Style::european, 1.0, 0.001, 0.002, {-3.0, 8.0, -4.5, 0.12});
  heavy.rate = 0.036;
  EXPECT_EQ(priced_to(1e-4, {heavy}).front().status, PriceStatus::ok);
}

// Near a sharp kink the error of cubic interpolation exceeds its next term.
TEST(OptionsError, CoversInterpolationNearASharpKink) {
  std::vector<Contract> contracts;
  for (const auto& jump : jump_parameters)
    for (const double deviations : {-2.5, -2.0, -1.5, -1.0, 1.0, 1.5, 2.0, 2.5})
      for (const double days : {0.1, 0.3, 1.0}) {
        const double maturity = days / 365.0;
        contracts.push_back(
            put(Style::european, std::exp(deviations * std::sqrt(0.02 * maturity)), maturity, 0.02, jump));
      }
  const std::vector<Price> known = priced_by_fourier(contracts);
  expect_covered(priced(on_mesh(128, 32), contracts), known, "between nodes", 10.0, 0.02);
}

// The boundary is reached with a small probability, so the error of exercise at nodes is small.
TEST(OptionsError, CoversAndIsSmallFarAboveTheBoundary) {
  std::vector<Contract> contracts;
  for (const auto& jump : jump_parameters) contracts.push_back(put(Style::american, 2.0, 0.25, 0.04, jump));
  const std::vector<Price> prices = priced(on_mesh(128, 128), contracts),
                           known = priced(on_mesh(1024, 1024), contracts);
  for (std::size_t k = 0; k < prices.size(); ++k) {
    EXPECT_NEAR(prices[k].price, known[k].price, prices[k].error) << k;
    EXPECT_LT(prices[k].error, 1.2e-6) << k;
  }
}

/// European puts and calls of half a year and two years, with the given spots.
std::vector<Contract> about_the_strike(const std::vector<double>& spots) {
  std::vector<Contract> contracts;
  for (const auto& jump : jump_parameters)
    for (const double maturity : {0.5, 2.0})
      for (const double spot : spots)
        for (const Type type : {Type::put, Type::call}) {
          contracts.push_back(put(Style::european, spot, maturity, 0.04, jump));
          contracts.back().type = type;
        }
  return contracts;
}

// The extrapolation error decreases faster than the difference of the two grids.
TEST(OptionsError, CoversFineGrids) {
  const std::vector<Contract> contracts = about_the_strike({0.8, 0.93, 1.0, 1.1, 1.3});
  const std::vector<Price> known = priced_by_fourier(contracts);
  expect_covered(priced(on_mesh(512, 128), contracts), known, "512 intervals", 8.0);
  expect_covered(priced(on_mesh(1024, 256), contracts), known, "1024 intervals", 8.0);
}

// The error in time dominates, independent of the mesh.
TEST(OptionsError, CoversFewStepsOnAFineMesh) {
  const std::vector<Contract> contracts = about_the_strike({0.8, 0.93, 1.0, 1.1, 1.3});
  const std::vector<Price> known = priced_by_fourier(contracts);
  for (const int steps : {8, 16, 64})
    expect_covered(priced(on_mesh(1024, steps), contracts), known,
                   ("1024 intervals, " + std::to_string(steps) + " steps").c_str());
}

// Only the truncation error is left.
TEST(OptionsError, EqualsTheTruncationErrorFarOutOfTheMoney) {
  std::vector<Contract> contracts;
  for (const auto& jump : jump_parameters) contracts.push_back(put(Style::european, 20.0, 0.02, 0.01, jump));
  for (const int mesh : {128, 512}) {
    const std::vector<Price> prices = priced(on_mesh(mesh, mesh / 4), contracts),
                             known = priced_by_fourier(contracts);
    for (std::size_t k = 0; k < prices.size(); ++k) {
      EXPECT_NEAR(prices[k].price, known[k].price, prices[k].error) << mesh << ' ' << k;
      EXPECT_LT(prices[k].error, 0.01 / (mesh * mesh)) << mesh << ' ' << k;
    }
  }
}

// The price is the payoff, and the boundary is far above the spot: errors at other spots and the truncation
// of the grid are irrelevant.
TEST(OptionsError, IsNegligibleDeepInTheMoney) {
  std::vector<Contract> contracts;
  for (const auto& jump : jump_parameters) contracts.push_back(put(Style::american, 0.3, 0.5, 0.04, jump));
  const std::vector<Price> prices = priced(on_mesh(128, 32), contracts);
  for (std::size_t k = 0; k < prices.size(); ++k) {
    EXPECT_DOUBLE_EQ(prices[k].price, 0.7) << k;
    EXPECT_GT(prices[k].error, 0.0) << k;
    EXPECT_LT(prices[k].error, 1e-6) << k;
  }
}

// The drift moves the solution over many deviations, so that few steps resolve its changes.
TEST(OptionsError, CoversDriftsOverManyDeviations) {
  std::vector<Contract> contracts;
  for (const double rate : {0.1, -0.08})
    for (const double spot : {0.85, 1.0, 1.2})
      for (const double maturity : {10.0, 20.0, 30.0})
        for (const Type type : {Type::put, Type::call}) {
          Contract c = put(Style::european, 1.0, maturity, 0.0009, {}, JumpModel::black_scholes);
          c.rate = rate;
          c.dividend = 0.0;
          c.spot = spot * std::exp(-rate * maturity);
          c.type = type;
          contracts.push_back(c);
        }
  const std::vector<Price> known = priced_by_fourier(contracts);
  expect_covered(priced(on_mesh(512, 64), contracts), known, "drift over many deviations");
}

// Paths that leave the grid upwards may return against the drift until maturity.
TEST(OptionsError, CoversDriftsAwayFromTheStrike) {
  std::vector<Contract> contracts;
  for (const double rate : {0.07, 0.09})
    for (const double spot : {0.55, 0.7, 1.0})
      for (const double maturity : {15.0, 24.0}) {
        contracts.push_back(put(Style::european, spot, maturity, 0.018, {}, JumpModel::black_scholes));
        contracts.back().rate = rate;
        contracts.back().dividend = 0.0;
      }
  const std::vector<Price> known = priced_by_fourier(contracts);
  expect_covered(priced(on_mesh(128, 128), contracts), known, "drift away from the strike", 15.0);
  expect_covered(priced_to(3e-6, contracts), known, "drift away from the strike, tolerance 3e-6");
}

// Asymmetric jumps act for decades.
TEST(OptionsError, CoversAsymmetricJumpsOverDecades) {
  std::vector<Contract> contracts;
  for (const std::array<double, 4>& jump :
       {std::array{-0.5, 12.0, -4.0, 0.3}, std::array{-1.4, 20.0, -13.6, 0.23},
        std::array{1.5, 25.0, 15.0, 0.2}, std::array{-2.8, 30.0, -19.0, 0.3}})
    for (const double maturity : {5.0, 10.0, 20.0})
      for (const double spot : {0.5, 0.8, 1.0, 1.3, 2.0})
        for (const double variance : {0.01, 0.03})
          contracts.push_back(put(Style::european, spot, maturity, variance, jump));
  const std::vector<Price> known = priced_by_fourier(contracts);
  expect_covered(priced(on_mesh(128, 32), contracts), known, "tilted jumps of decades");
  expect_covered(priced_to(1e-5, contracts), known, "tilted jumps of decades, tolerance 1e-5");
}

// Nodes represent these jumps as longer ones, and too many of them occur in a step.
TEST(OptionsError, CoversFrequentShortJumps) {
  std::vector<Contract> contracts;
  for (const double rate : {2000.0, 10000.0, 20000.0})
    for (const double maturity : {0.25, 1.0})
      for (const double spot : {0.4, 0.8, 1.0, 1.3}) {
        contracts.push_back(put(Style::european, spot, maturity, 0.04,
                                {rate, 0.0, std::sqrt(0.3 / rate), 0.0}, JumpModel::merton));
      }
  const std::vector<Price> known = priced_by_fourier(contracts);
  expect_covered(priced_to(1e-3, contracts), known, "many short jumps", 10.0, 0.2);

  // Exercise limits values that grow: both grids agree on the payoff, but the price of this put is 0.7686.
  Contract american = put(Style::american, 0.6, 1.0, 0.04, {10000.0, -0.01, 0.02, 0.0}, JumpModel::merton);
  for (const int mesh : {256, 512})
    EXPECT_GT(priced(on_mesh(mesh, mesh / 4), {american}).front().error, 0.36);
}

// Cells of nodes contain hardly any of these jumps, and the difference of the grids does not contain this
// error.
TEST(OptionsError, CoversKouJumpsShorterThanACell) {
  std::vector<Contract> contracts;
  for (const double rate : {150.0, 400.0, 900.0})
    for (const double maturity : {1.0, 7.0, 20.0})
      for (const double spot : {0.7, 1.0, 1.5}) {
        contracts.push_back(
            put(Style::european, spot, maturity, 0.02, {rate, 0.3, 170.0, 140.0}, JumpModel::kou));
      }
  const std::vector<Price> known = priced_by_fourier(contracts);
  expect_covered(priced(on_mesh(128, 128), contracts), known, "Kou's jumps shorter than a cell");
  expect_covered(priced_to(1e-4, contracts), known, "Kou's jumps shorter than a cell, tolerance 1e-4");
}

// With upward jumps of almost infinite mean the asset falls a hundredfold between jumps.
TEST(OptionsError, CoversKouJumpsWithAlmostNoMean) {
  std::vector<Contract> contracts;
  for (const double up : {1.01, 1.02, 1.05}) {
    contracts.push_back(put(Style::american, 1.0, 3.0, 0.04, {1.0, 0.4, up, 5.0}, JumpModel::kou));
  }
  const std::vector<Price> prices = priced_to(1e-4, contracts),
                           known = priced(on_mesh(1024, 4096), contracts);
  for (std::size_t k = 0; k < prices.size(); ++k)
    EXPECT_NEAR(prices[k].price, known[k].price, prices[k].error + known[k].error) << k;
}

// Jumps of a fixed size end between nodes. They are divided among the neighbouring nodes so that the mean is
// preserved.
TEST(OptionsError, CoversJumpsOfEqualSize) {
  std::vector<Contract> contracts;
  for (const double jump : {-0.5, -0.31, 0.17})
    for (const double deviation : {0.0, 1e-6, 1e-2})
      for (const double spot : {0.8, 1.0, 1.25}) {
        contracts.push_back(
            put(Style::european, spot, 1.0, 0.02, {0.4, jump, deviation, 0.0}, JumpModel::merton));
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
