#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "kernels/options/pricer.hpp"
#include "tests/support/option_sets.hpp"
#include "tests/support/priced.hpp"

// Prices against known prices, and error estimates against true errors.

namespace drogue::options {
namespace {

using testing::contract_of;
using testing::option_sets;
using testing::OptionSet;
using testing::priced;

struct Known {
  std::vector<Contract> contracts;
  std::vector<double> values;
  std::vector<std::string> names;
};

Known known_sets() {
  Known known;
  for (const OptionSet& set : option_sets())
    for (std::size_t k = 0; k < set.spot.size(); ++k)
      for (const Style style : {Style::american, Style::european}) {
        known.contracts.push_back(contract_of(set, k, style));
        known.values.push_back(style == Style::american ? set.american[k] : set.european[k]);
        known.names.push_back(set.name + " at " + std::to_string(set.spot[k]));
      }
  return known;
}

void expect_known(const Settings& settings, double tolerance) {
  const Known known = known_sets();
  const std::vector<Price> prices = priced(settings, known.contracts);
  std::size_t covered = 0;
  double worst = 0.0;
  for (std::size_t k = 0; k < prices.size(); ++k) {
    const double error = std::abs(prices[k].price - known.values[k]);
    EXPECT_LT(error, tolerance) << known.names[k];
    if (error <= prices[k].error + 1e-7) ++covered;
    worst = std::max(worst, error);
  }
  std::printf("largest error %.1e, %zu of %zu covered\n", worst, covered, prices.size());
  EXPECT_GE(10 * covered, 9 * prices.size()) << covered << " of " << prices.size();
}

TEST(OptionsReference, MatchesKnownPricesOnAMeshOf128) {
  Settings settings;
  settings.mesh = 128;
  settings.steps = 32;
  expect_known(settings, 7.5e-5);
}

// ctest-label: no-sanitizer
TEST(OptionsReference, ToleranceIsKept) {
  Settings settings;
  settings.tolerance = 1e-5;
  expect_known(settings, 1e-5);
}

// Nine of ten true errors are below their estimates; the median ratio of estimate and error is at most ten.
// ctest-label: no-sanitizer
TEST(OptionsReference, StatedErrorsCoverAndDoNotExaggerate) {
  const auto contracts = testing::random_contracts(120, 12);
  Settings settings;
  settings.mesh = 512;
  settings.steps = 128;
  const std::vector<Price> known = priced(settings, contracts);
  for (const int mesh : {64, 128}) {
    settings.mesh = mesh;
    settings.steps = mesh / 4;
    const std::vector<Price> prices = priced(settings, contracts);
    std::vector<double> ratio;
    for (std::size_t k = 0; k < prices.size(); ++k)
      ratio.push_back(prices[k].error /
                      (std::abs(prices[k].price - known[k].price) + 1e-7 * contracts[k].strike));
    std::sort(ratio.begin(), ratio.end());
    EXPECT_GE(ratio[ratio.size() / 10], 1.0) << mesh;
    EXPECT_LE(ratio[ratio.size() / 2], 10.0) << mesh;
    std::printf("mesh %d: stated over true error %.2g, %.2g, %.2g at 10, 50, 90 %% of the rows\n", mesh,
                ratio[ratio.size() / 10], ratio[ratio.size() / 2], ratio[ratio.size() * 9 / 10]);
  }
}

struct Literature {
  JumpModel model;
  double spot, price;
};

// American put with maturity 0.25 years, strike 100, r = 0.05, sigma = 0.15.
Contract merton_or_kou(const Literature& row) {
  Contract c;
  c.model = row.model;
  c.spot = row.spot;
  c.strike = 100.0;
  c.rate = 0.05;
  c.maturity = 0.25;
  c.variance = 0.15 * 0.15;
  const double merton[4] = {0.1, -0.9, 0.45, 0.0}, kou[4] = {0.1, 0.3445, 3.0465, 3.0775};
  for (int k = 0; k < 4; ++k) c.jump[k] = row.model == JumpModel::merton ? merton[k] : kou[k];
  return c;
}

// d'Halluin, Forsyth and Labahn (2004) and Toivanen (2008), with the digits of their tables.
// ctest-label: no-sanitizer
TEST(OptionsReference, MatchesMertonAndKouPricesOfTheLiterature) {
  const std::vector<Literature> rows = {
      {JumpModel::merton, 90.0, 10.0038},  {JumpModel::merton, 100.0, 3.24125},
      {JumpModel::merton, 110.0, 1.41980}, {JumpModel::kou, 90.0, 10.0051},
      {JumpModel::kou, 100.0, 2.80788},    {JumpModel::kou, 110.0, 0.561877}};
  std::vector<Contract> contracts;
  for (const Literature& row : rows) contracts.push_back(merton_or_kou(row));
  Settings settings;
  settings.tolerance = 2e-6;
  const std::vector<Price> prices = priced(settings, contracts);
  for (std::size_t k = 0; k < rows.size(); ++k) EXPECT_NEAR(prices[k].price, rows[k].price, 1e-4) << k;
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

// Difficult processes: large order, no Brownian part for a few days, the heaviest tails, and jumps of equal
// size. Reference: European prices by a mixture of normal laws or Merton's series.
// ctest-label: no-sanitizer
TEST(OptionsReference, StatedErrorsCoverHardProcesses) {
  struct Hard {
    Contract contract;
    double value;
  };
  const auto put = [](double strike, double rate, double dividend, double maturity, double variance,
                      std::array<double, 4> jump) {
    Contract c{.style = Style::european,
               .type = Type::put,
               .spot = 100.0,
               .strike = strike,
               .rate = rate,
               .dividend = dividend,
               .maturity = maturity,
               .variance = variance};
    std::ranges::copy(jump, c.jump);
    return c;
  };
  std::vector<Hard> hard = {{put(90.0, 0.05, 0.02, 1.0, 0.0, {-100.0, 30.0, -2.5, 10.0}), 12.28734},
                            {put(100.0, 0.05, 0.0, 0.01, 0.0, {2.0, 11.0, -5.0, 0.0}), 0.28357},
                            {put(90.0, 0.05, 0.02, 1.0, 0.04, {1.0, 8.15, -8.149, 0.767}), 85.1442},
                            {put(100.0, 0.03, 0.01, 1.0, 1e-4, {5.0, 0.3, 1e-4, 0.0}), 26.7213}};
  hard.back().contract.model = JumpModel::merton;
  for (const double tolerance : {1e-4, 1e-5}) {
    Settings settings;
    settings.tolerance = tolerance;
    for (const Hard& one : hard) {
      const Price price = priced(settings, {one.contract}).front();
      EXPECT_NEAR(price.price, one.value, price.error + 1e-4) << one.value;
      EXPECT_TRUE(price.status == PriceStatus::coarse || price.error <= tolerance * one.contract.strike);
    }
  }
}

// For orders beyond 5 the Hankel function has a zero close to the real axis. Reference: Fourier integrals,
// which use Bessel functions of the exponent. Errors are within the tolerance, and nine of ten within the
// estimates.
// ctest-label: no-sanitizer
TEST(OptionsReference, LargeOrdersHaveNoBias) {
  std::vector<Contract> contracts;
  for (const double lambda : {-127.0, -50.0, -30.0, -12.0, -6.0, 6.0, 15.0, 50.0, 100.0})
    for (const auto& [alpha, beta, delta] :
         {std::array{30.0, -2.5, 10.0}, {12.0, -4.0, 1.5}, {8.15, -2.5, 0.767}})
      for (const double strike : {0.9, 1.1}) {
        Contract c{
            .style = Style::european, .strike = strike, .rate = 0.05, .dividend = 0.02, .maturity = 0.5};
        std::ranges::copy(std::array{lambda, alpha, beta, delta}, c.jump);
        contracts.push_back(c);
      }
  Settings settings;
  settings.tolerance = 3e-6;
  const std::vector<Price> prices = priced(settings, contracts);
  settings.method = Method::cos;
  const std::vector<Price> known = priced(settings, contracts);
  std::size_t covered = 0;
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    EXPECT_EQ(prices[k].status, PriceStatus::ok) << contracts[k].jump[0];
    const double error = std::abs(prices[k].price - known[k].price);
    EXPECT_LT(error, 6e-6 * contracts[k].strike) << contracts[k].jump[0];
    if (error <= prices[k].error) ++covered;
  }
  EXPECT_GE(10 * covered, 9 * contracts.size());
}

// Every model without jumps is Black and Scholes', with a closed form for European prices.
TEST(OptionsReference, MatchesBlackAndScholesWithoutJumps) {
  std::vector<Contract> contracts(6);
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    Contract& c = contracts[k];
    c.model = k < 2 ? JumpModel::black_scholes : k < 4 ? JumpModel::merton : JumpModel::kou;
    c.style = Style::european;
    c.type = k % 2 == 0 ? Type::put : Type::call;
    c.spot = 95.0;
    c.strike = 100.0;
    c.rate = 0.03;
    c.dividend = 0.01;
    c.variance = 0.09;
    c.jump[1] = c.model == JumpModel::kou ? 0.4 : -0.1;
    c.jump[2] = c.jump[3] = 5.0;
  }
  Settings settings;
  settings.tolerance = 1e-6;
  settings.greeks = true;
  const std::vector<Price> prices = priced(settings, contracts);
  const double d1 = (std::log(0.95) + 0.03 - 0.01 + 0.045) / 0.3, d2 = d1 - 0.3;
  const double density = std::exp(-0.5 * d1 * d1) / std::sqrt(2.0 * 3.141592653589793);
  const double call = 95.0 * std::exp(-0.01) * normal_cdf(d1) - 100.0 * std::exp(-0.03) * normal_cdf(d2);
  const double put = call - 95.0 * std::exp(-0.01) + 100.0 * std::exp(-0.03);
  const double gamma = std::exp(-0.01) * density / (95.0 * 0.3);
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    const bool is_put = k % 2 == 0;
    EXPECT_NEAR(prices[k].price, is_put ? put : call, 1e-4) << k;
    EXPECT_NEAR(prices[k].delta, std::exp(-0.01) * (normal_cdf(d1) - (is_put ? 1.0 : 0.0)), 1e-5) << k;
    EXPECT_NEAR(prices[k].gamma, gamma, 1e-5 * gamma + 1e-6) << k;
    // Theta follows from Black and Scholes' equation.
    const double theta = 0.03 * prices[k].price - 0.02 * 95.0 * prices[k].delta - 0.045 * 95.0 * 95.0 * gamma;
    EXPECT_NEAR(prices[k].theta, theta, 1e-2) << k;
    EXPECT_TRUE(std::isnan(prices[k].exercise_boundary));
  }
}

}  // namespace
}  // namespace drogue::options
