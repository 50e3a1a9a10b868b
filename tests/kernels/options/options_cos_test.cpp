#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "kernels/options/cos/american.hpp"
#include "kernels/options/cos/pricer.hpp"
#include "kernels/reference/options/cos.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/option_sets.hpp"

// Bermudan solver against the reference implementation, and American prices against reference data.

namespace drogue::options {
namespace {

constexpr const auto& backend = testing::tested_backend;

std::vector<Price> cos_prices(const std::vector<Contract>& contracts, double tolerance) {
  Settings settings;
  settings.method = Method::cos;
  settings.tolerance = tolerance;
  settings.greeks = true;
  std::vector<Price> prices(contracts.size());
  create_cos_pricer(backend, settings)->price(contracts, prices);
  return prices;
}

/// Continuation values on the same interval with the same dates.
TEST(OptionsBermudan, MatchesReferenceImplementation) {
  const int dates = 4;
  const auto solver = create_bermudan_solver(backend);
  for (const std::size_t which : {0, 5}) {
    const auto& set = testing::option_sets()[which];
    for (const double spot : {0.6, 0.95, 1.2}) {
      Contract c = testing::contract_of(set, 0, Style::american);
      c.spot = spot;
      AmericanPut put(c);
      put.prepare(c.maturity, dates, 1e-6);
      std::vector<BermudanPut> puts = {put.puts[0]};
      std::vector<BermudanValue> values(1);
      solver->solve(puts, put.psi_re, put.psi_im, values);
      std::vector<double> years;
      for (int k = 1; k <= dates; ++k) years.push_back(exercise_date(c.maturity, k, dates));
      const std::vector<double> expected = reference::bermudan_put(
          {c.rate, 0.0, c.variance, set.lambda, set.alpha, set.beta, set.delta}, years, puts[0].low,
          puts[0].width, 160, 12000, {puts[0].x, puts[0].x + 1e-3, puts[0].x - 1e-3});
      EXPECT_NEAR(values[0].value, expected[0], 1e-6) << set.name << ' ' << spot;
      EXPECT_NEAR(values[0].first_derivative, (expected[1] - expected[2]) / 2e-3, 1e-5);
      EXPECT_NEAR(values[0].second_derivative, (expected[1] - 2.0 * expected[0] + expected[2]) / 1e-6, 1e-4);
    }
  }
}

// Teams of other sizes sum in another order.
TEST(OptionsCos, BlockSizeChangesRoundingOnly) {
  const std::vector<Contract> contracts = {
      testing::contract_of(testing::option_sets()[0], 3, Style::american)};
  const auto price = [&](int block) {
    std::vector<Price> prices(1);
    create_pricer(backend, {.method = Method::cos, .block = block})->price(contracts, prices);
    return prices[0].price;
  };
  for (const int block : {32, 512}) EXPECT_NEAR(price(block), price(0), 1e-11 * contracts[0].strike) << block;
  EXPECT_THROW(price(48), std::invalid_argument);
}

// ctest-label: no-sanitizer
TEST(OptionsCos, AmericanPricesMatchReferenceData) {
  for (const auto& set : testing::option_sets()) {
    std::vector<Contract> contracts;
    for (std::size_t spot = 0; spot < 7; spot += 3)
      contracts.push_back(testing::contract_of(set, spot, Style::american));
    const std::vector<Price> prices = cos_prices(contracts, 1e-3);
    for (std::size_t k = 0; k < prices.size(); ++k) {
      const double error = std::abs(prices[k].price - set.american[3 * k]);
      EXPECT_LE(error, 1e-3) << set.name << ' ' << contracts[k].spot;
      EXPECT_LE(error, prices[k].error + 1e-7) << set.name << ' ' << contracts[k].spot;
    }
  }
}

/// A smaller tolerance requires more dates.
TEST(OptionsCos, ErrorStaysWithinTolerance) {
  const auto& set = testing::option_sets()[0];
  const std::vector<Contract> contracts = {testing::contract_of(set, 3, Style::american)};
  const Price coarse = cos_prices(contracts, 1e-3)[0], fine = cos_prices(contracts, 1e-5)[0];
  EXPECT_GT(fine.steps, coarse.steps);
  EXPECT_LT(fine.error, 1e-5);
  EXPECT_NEAR(fine.price, set.american[3], 1e-5);
}

// A perpetual put of strike 1 is worth (1 - b) (S/b)^{-g}, g = 2 r/sigma^2, b = g/(1 + g) (Merton 1973). With
// dates centuries apart all levels would miss nearly the whole value.
TEST(OptionsCos, LongMaturitiesApproachPerpetualPut) {
  for (const double rate : {0.02, 0.05, 0.1})
    for (const double years : {300.0, 1e4, 1e7}) {
      const Contract c{.model = JumpModel::black_scholes,
                       .style = Style::american,
                       .spot = 100.0,
                       .strike = 95.0,
                       .rate = rate,
                       .maturity = years,
                       .variance = 0.04};
      const double g = 2.0 * rate / c.variance, b = g / (1.0 + g);
      const double perpetual = c.strike * (1.0 - b) * std::pow(c.spot / (c.strike * b), -g);
      const Price price = cos_prices({c}, 1e-3)[0];
      EXPECT_NEAR(price.price, perpetual, price.error) << rate << ' ' << years;
      EXPECT_LT(price.error, 0.02 * perpetual) << rate << ' ' << years;
    }
}

// Exercise pays within a small part of an interval between dates, which no level resolves.
TEST(OptionsCos, StatesLargeErrorForTooFewDates) {
  Contract c{.model = JumpModel::black_scholes,
             .style = Style::american,
             .spot = 1.0,
             .strike = 1.0,
             .rate = 1e-4,
             .dividend = -0.05,
             .maturity = 4000.0,
             .variance = 0.04};
  const Price sparse_dates = cos_prices({c}, 1e-3)[0];
  EXPECT_EQ(sparse_dates.status, PriceStatus::coarse);
  EXPECT_GT(sparse_dates.error, 0.5);

  // A perpetual put at the strike, with g and b as above, whose drift dominates its diffusion.
  c.dividend = 0.0;
  c.rate = 0.05;
  c.maturity = 30.0;
  c.variance = 1e-4;
  const double g = 2.0 * c.rate / c.variance, b = g / (1.0 + g), perpetual = (1.0 - b) * std::pow(b, g);
  const Price drifting = cos_prices({c}, 1e-3)[0];
  EXPECT_NEAR(drifting.price, perpetual, drifting.error);
  EXPECT_LT(drifting.error, 0.02);
}

/// C(S, K, r, q, beta) = P(K, S, q, r, -beta - 1), including the Greeks.
TEST(OptionsCos, CallEqualsDualPut) {
  Contract call;
  call.type = Type::call;
  call.spot = 0.9, call.strike = 1.1, call.rate = 0.03, call.dividend = 0.06, call.variance = 0.03;
  call.jump[0] = -0.5, call.jump[1] = 9.0, call.jump[2] = -3.0, call.jump[3] = 0.3;
  Contract put = call;
  put.type = Type::put;
  std::swap(put.spot, put.strike);
  std::swap(put.rate, put.dividend);
  put.jump[2] = -call.jump[2] - 1.0;
  Contract up = call, down = call;
  const double h = 1e-3;
  up.spot += h, down.spot -= h;
  const std::vector<Price> prices = cos_prices({call, put, up, down}, 1e-4);
  EXPECT_NEAR(prices[0].price, prices[1].price, 1e-12);
  EXPECT_NEAR(prices[0].delta, (prices[2].price - prices[3].price) / (2.0 * h), 1e-4);
  EXPECT_NEAR(prices[0].gamma, (prices[2].price - 2.0 * prices[0].price + prices[3].price) / (h * h), 1e-2);
}

TEST(OptionsCos, EqualsEuropeanPriceIfExerciseNeverPays) {
  Contract american = testing::contract_of(testing::option_sets()[0], 3, Style::american);
  american.type = Type::call;
  Contract european = american;
  european.style = Style::european;
  Contract negative = american;
  negative.type = Type::put, negative.rate = -0.02;
  Contract negative_european = negative;
  negative_european.style = Style::european;
  const std::vector<Price> prices = cos_prices({american, european, negative, negative_european}, 1e-4);
  EXPECT_EQ(prices[0].price, prices[1].price);
  EXPECT_EQ(prices[2].price, prices[3].price);
}

TEST(OptionsCos, FarOutOfTheMoneyPutIsNotExercised) {
  Contract far = testing::contract_of(testing::option_sets()[0], 3, Style::american);
  far.maturity = 1.0 / 365.0;
  far.spot = 3.0 * far.strike;
  EXPECT_GT(cos_prices({far}, 1e-4)[0].delta, -0.01);
}

/// For q < r < 0 exercise is optimal between two critical spots only.
TEST(OptionsCos, HandlesTwoExerciseBoundaries) {
  Contract c = testing::contract_of(testing::option_sets()[1], 3, Style::american);
  c.rate = -0.02, c.dividend = -0.08, c.variance = 0.02;
  std::vector<Contract> contracts;
  for (const double spot : {0.02, 0.7, 1.0}) {
    c.spot = spot;
    contracts.push_back(c);
    contracts.back().style = Style::european;
    contracts.push_back(c);
  }
  const std::vector<Price> prices = cos_prices(contracts, 1e-3);
  for (std::size_t k = 0; k < prices.size(); k += 2) {
    EXPECT_GE(prices[k + 1].price, prices[k].price - 1e-9);
    EXPECT_GE(prices[k + 1].price, 1.0 - contracts[k].spot - 1e-12);
  }
  EXPECT_GT(prices[1].price, 1.0 - 0.02 + 1e-3);  // not exercised deep in the money
}

TEST(OptionsCos, ReportsCoarseForTailsBeyondTheInterval) {
  // The left tail of the jump density decays as e^(-0.001 |x|), too slowly for any interval.
  Contract heavy = testing::contract_of(testing::option_sets()[0], 3, Style::american);
  heavy.jump[2] = 0.001 - heavy.jump[1];
  const Price price = cos_prices({heavy}, 1e-4)[0];
  EXPECT_EQ(price.status, PriceStatus::coarse);
  EXPECT_GT(price.error, 0.05);
}

TEST(OptionsCos, PriceHasSameBitsInAnyBatch) {
  std::vector<Contract> contracts;
  for (std::size_t spot = 0; spot < 7; spot += 2)
    for (const std::size_t set : {0, 3})
      contracts.push_back(testing::contract_of(testing::option_sets()[set], spot, Style::american));
  const std::vector<Price> batch_prices = cos_prices(contracts, 1e-3);
  for (std::size_t k = 0; k < contracts.size(); k += 3)
    EXPECT_EQ(batch_prices[k].price, cos_prices({contracts[k]}, 1e-3)[0].price);
}

TEST(OptionsCos, RejectsMeshAndNonPositiveTolerance) {
  Settings settings;
  settings.mesh = 128;
  EXPECT_THROW((void)create_cos_pricer(backend, settings), std::invalid_argument);
  settings = {};
  settings.tolerance = 0.0;
  EXPECT_THROW((void)create_cos_pricer(backend, settings), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::options
