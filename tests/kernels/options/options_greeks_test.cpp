// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/options/sensitivities.hpp"
#include "tests/support/priced.hpp"
#include "tests/support/random_americans.hpp"

// Greeks of both methods on random contracts of all models and beside exercise boundaries: bounds that hold
// for every process, exercised rows, and sensitivities against differences of prices on fine grids.

namespace drogue::options {
namespace {

using testing::on_mesh;
using testing::priced;
using testing::random_americans;

double payoff_of(const Contract& c) { return c.type == Type::put ? c.strike - c.spot : c.spot - c.strike; }

/// Delta in [-1, 0] (puts) or [0, 1], gamma >= 0, theta <= 0; the payoff's where the price is the payoff.
void expect_possible(const std::vector<Contract>& contracts, const std::vector<Price>& prices) {
  int exercised = 0;
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    const Contract& c = contracts[k];
    const Price& price = prices[k];
    const double sign = c.type == Type::put ? -1.0 : 1.0;
    EXPECT_TRUE(sign * price.delta >= 0.0 && sign * price.delta <= 1.0) << k << ' ' << price.delta;
    EXPECT_GE(price.gamma, 0.0) << k;
    EXPECT_LE(price.theta, 0.0) << k;
    if (price.price > payoff_of(c) + 1e-12 * (c.spot + c.strike)) continue;
    ++exercised;
    EXPECT_EQ(price.delta, sign) << k;
    EXPECT_EQ(price.gamma, 0.0) << k;
    EXPECT_EQ(price.theta, 0.0) << k;
    EXPECT_FALSE(std::signbit(price.gamma) || std::signbit(price.theta)) << k;
  }
  EXPECT_GT(exercised, static_cast<int>(contracts.size()) / 10);
}

TEST(OptionsGreeks, FiniteDifferencesGivePossibleGreeks) {
  const std::vector<Contract> contracts = random_americans(400, 1);
  expect_possible(contracts, priced({}, contracts));
}

Settings cosines() {
  Settings settings;
  settings.method = Method::cos;
  settings.greeks = true;
  return settings;
}

TEST(OptionsGreeks, CosinesGivePossibleGreeksAndCoverTheirErrors) {
  const std::vector<Contract> contracts = random_americans(40, 2);
  const std::vector<Price> prices = priced(cosines(), contracts);
  expect_possible(contracts, prices);
  const std::vector<Price> fine = priced(on_mesh(2048, 1024), contracts);
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    EXPECT_LE(std::abs(prices[k].price - fine[k].price), prices[k].error + fine[k].error) << k;
    // Spots that are exercised, farther from the boundary than its uncertainty.
    const bool is_exercised = fine[k].price <= payoff_of(contracts[k]) + 1e-12 * contracts[k].strike;
    if (is_exercised && std::abs(contracts[k].spot / fine[k].exercise_boundary - 1.0) > 0.002) {
      EXPECT_EQ(std::abs(prices[k].delta), 1.0) << k;
    }
  }
}

// Strike 100, r 0.05, q 0.02, half a year, variance 0.04: the boundary is 81.665.
TEST(OptionsGreeks, CosinesResolveTheExerciseBoundary) {
  std::vector<Contract> contracts;
  for (int k = 0; k < 40; ++k)
    contracts.push_back({.model = JumpModel::black_scholes,
                         .spot = 72.0 + 0.5 * k,
                         .strike = 100.0,
                         .rate = 0.05,
                         .dividend = 0.02,
                         .maturity = 0.5,
                         .variance = 0.04});
  const std::vector<Price> prices = priced(cosines(), contracts),
                           fine = priced(on_mesh(2048, 2048), contracts);
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    const double spot = contracts[k].spot;
    EXPECT_LE(std::abs(prices[k].price - fine[k].price), prices[k].error + fine[k].error) << spot;
    EXPECT_LE(std::abs(prices[k].price - fine[k].price), 3e-3) << spot;
    if (spot == 82.0) continue;  // its premium of 0.002 is within the error
    EXPECT_NEAR(prices[k].delta, fine[k].delta, 0.005) << spot;
    EXPECT_NEAR(prices[k].gamma, fine[k].gamma, 0.006) << spot;
    EXPECT_NEAR(prices[k].theta, fine[k].theta, 0.7) << spot;
  }
}

// The gamma of finite differences is 6.73e-4; the series gives 1.27e-3.
TEST(OptionsGreeks, CosinesGiveNoGammaOfPureVarianceGamma) {
  Contract c{.spot = 1369.41, .strike = 1200.0, .rate = 0.0541, .dividend = 0.012, .maturity = 0.56164};
  const double jump[] = {1.9914368216668328, 11.00863799607121, -5.33254111089244, 0.0};
  std::copy_n(jump, 4, c.jump);
  Contract exercised = c, with_brownian = c;
  exercised.spot = 600.0;
  with_brownian.variance = 0.01;
  const std::vector<Price> prices = priced(cosines(), {c, exercised, with_brownian}),
                           fine = priced(on_mesh(1024, 512), {c, exercised, with_brownian});
  EXPECT_NEAR(prices[0].price, fine[0].price, prices[0].error + fine[0].error);
  EXPECT_NEAR(prices[0].delta, fine[0].delta, 2e-3);
  EXPECT_TRUE(std::isnan(prices[0].gamma)) << prices[0].gamma;
  EXPECT_EQ(prices[1].gamma, 0.0);
  EXPECT_NEAR(prices[2].gamma, fine[2].gamma, 0.02 * fine[2].gamma);
}

std::vector<Sensitivities> sensitivities_of(const Settings& settings,
                                            const std::vector<Contract>& contracts) {
  Settings with_greeks = settings;
  with_greeks.greeks = true;
  std::vector<Sensitivities> result(contracts.size());
  SensitivityPricer(testing::tested_backend, with_greeks)
      .compute(contracts, priced(with_greeks, contracts), result);
  return result;
}

TEST(OptionsGreeks, EuropeanSensitivitiesAreThoseOfBlackAndScholes) {
  const double maturity = 0.75, sigma = 0.25, rate = 0.03, dividend = 0.05;
  for (const Type type : {Type::put, Type::call})
    for (const double spot : {70.0, 100.0, 130.0}) {
      const std::vector<Contract> contracts = {{.model = JumpModel::black_scholes,
                                                .style = Style::european,
                                                .type = type,
                                                .spot = spot,
                                                .strike = 100.0,
                                                .rate = rate,
                                                .dividend = dividend,
                                                .maturity = maturity,
                                                .variance = sigma * sigma}};
      const double width = sigma * std::sqrt(maturity);
      const double d = (std::log(spot / 100.0) + (rate - dividend) * maturity) / width + 0.5 * width;
      const double vega =
          spot * std::exp(-dividend * maturity - 0.5 * d * d) * std::sqrt(maturity / (2.0 * M_PI));
      const double sign = type == Type::put ? -1.0 : 1.0;
      const double rho = sign * 100.0 * maturity * std::exp(-rate * maturity) * 0.5 *
                         std::erfc(-sign * (d - width) / std::sqrt(2.0));
      const Sensitivities cos = sensitivities_of(cosines(), contracts)[0],
                          pide = sensitivities_of(on_mesh(512, 128), contracts)[0];
      EXPECT_NEAR(cos.vega, vega, 1e-7) << spot;
      EXPECT_NEAR(cos.rho, rho, 1e-9) << spot;
      EXPECT_NEAR(pide.vega, vega, 0.02) << spot;
      EXPECT_NEAR(pide.rho, rho, 0.005) << spot;
    }
}

// Against differences of European prices with jumps, by Fourier's integral.
TEST(OptionsGreeks, EuropeanSensitivitiesAreDifferencesOfPricesWithJumps) {
  for (Contract c : random_americans(12, 3)) {
    c.style = Style::european;
    const double h = 1e-4;
    std::vector<Contract> moved(5, c);
    moved[1].rate += h, moved[2].rate -= h;
    moved[3].variance += h * c.variance, moved[4].variance -= h * c.variance;
    const std::vector<Price> prices = testing::priced_by_fourier(moved);
    const double rho = (prices[1].price - prices[2].price) / (2.0 * h);
    const double vega = (prices[3].price - prices[4].price) / (h * std::sqrt(c.variance));
    const Sensitivities s = sensitivities_of(cosines(), {c})[0];
    EXPECT_NEAR(s.rho, rho, 1e-5 * c.strike * c.maturity);
    EXPECT_NEAR(s.vega, vega, 1e-4 + 1e-5 * std::abs(vega));
  }
}

// Against differences of American prices on finer grids with steps of another size. The tolerance is of the
// strike, times the maturity for rho and its root for vega; exercised rows have none.
void expect_differences(const Settings& settings, const std::vector<Contract>& contracts) {
  const std::vector<Sensitivities> all = sensitivities_of(settings, contracts);
  Settings with_greeks = settings;
  with_greeks.greeks = true;
  const std::vector<Price> prices = priced(with_greeks, contracts);
  std::size_t near = 0, compared = 0;
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    const Contract& c = contracts[k];
    if (std::abs(prices[k].delta) == 1.0) {
      EXPECT_EQ(all[k].vega, 0.0) << k;
      EXPECT_EQ(all[k].rho, 0.0) << k;
      continue;
    }
    const double by_rate = c.type == Type::put ? std::min(0.002, 0.2 * c.rate) : 0.002;
    const double by_variance = 0.01 * c.variance;
    std::vector<Contract> moved(4, c);
    moved[0].rate += by_rate, moved[1].rate -= by_rate;
    moved[2].variance += by_variance, moved[3].variance -= by_variance;
    const std::vector<Price> fine = priced(on_mesh(1024, 512), moved);
    const double rho = (fine[0].price - fine[1].price) / (2.0 * by_rate);
    const double vega = (fine[2].price - fine[3].price) / by_variance * std::sqrt(c.variance);
    ++compared;
    near += std::abs(all[k].rho - rho) < 0.01 * c.strike * c.maturity + 0.02 * std::abs(rho) &&
            std::abs(all[k].vega - vega) < 0.005 * c.strike * std::sqrt(c.maturity) + 0.02 * vega;
    EXPECT_NEAR(all[k].rho, rho, 0.1 * c.strike * c.maturity) << k;
    EXPECT_NEAR(all[k].vega, vega, 0.02 * c.strike * std::sqrt(c.maturity)) << k;
  }
  EXPECT_GE(compared, contracts.size() / 4);
  EXPECT_GE(near, compared * 19 / 20);
}

TEST(OptionsGreeks, AmericanSensitivitiesAreDifferencesOfFinePrices) {
  expect_differences({}, random_americans(60, 4));
  expect_differences(cosines(), random_americans(8, 5));
}

/// American contracts in the money, before expiry, with `rate` or rates near it at which exercise is about to
/// pay or has just begun to: it pays for a put above r = q S/K, for a call below.
std::vector<Contract> about_to_be_exercised(double rate, const std::vector<double>& maturities,
                                            const std::vector<double>& ratios) {
  std::vector<Contract> contracts;
  for (const Type type : {Type::put, Type::call})
    for (const double distance : {0.05, 0.1})
      for (const double maturity : maturities)
        for (const double ratio : ratios) {
          Contract c{.type = type, .strike = 100.0, .rate = rate, .maturity = maturity, .variance = 0.04};
          c.spot = type == Type::put ? 100.0 * (1.0 - distance) : 100.0 * (1.0 + distance);
          c.dividend = c.rate * c.strike / c.spot * (type == Type::put ? 1.0 / ratio : ratio);
          const double jumps[] = {1.0, 40.0, -2.0, 0.0};
          std::copy_n(jumps, 4, c.jump);
          contracts.push_back(c);
        }
  return contracts;
}

/// Expects that rho is within 5 % of K T of differences of fine prices at rates `step` beside those of
/// `contracts`, and within 2 % for nineteen rows of twenty.
void expect_rho(const std::vector<Contract>& contracts, double step) {
  const std::vector<Sensitivities> all = sensitivities_of({}, contracts);
  std::vector<Contract> moved;
  for (const double sign : {1.0, -1.0})
    for (Contract c : contracts) {
      c.rate += sign * step;
      moved.push_back(c);
    }
  const std::vector<Price> fine = priced(on_mesh(1024, 256), moved);
  std::size_t compared = 0, near = 0;
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    if (all[k].rho == 0.0) continue;
    const double scale = contracts[k].strike * contracts[k].maturity;
    const double rho = (fine[k].price - fine[contracts.size() + k].price) / (2.0 * step);
    ++compared;
    near += std::abs(all[k].rho - rho) < 0.02 * scale;
    EXPECT_NEAR(all[k].rho, rho, 0.05 * scale) << k;
  }
  EXPECT_GE(compared, contracts.size() / 2);
  EXPECT_GE(near, compared * 19 / 20);
}

TEST(OptionsGreeks, AmericanRhoHoldsWhereExerciseBeginsToPay) {
  expect_rho(about_to_be_exercised(0.05, {0.01, 0.03, 0.1}, {0.75, 0.9, 0.97, 1.0, 1.03, 1.1}), 1e-4);
}

// There rho falls within rates of less than a thousandth of a percent.
TEST(OptionsGreeks, AmericanRhoHoldsAtLowRatesDaysBeforeExpiry) {
  for (const double rate : {0.01, 0.003})
    expect_rho(about_to_be_exercised(rate, {0.002, 0.01, 0.03}, {0.9, 0.98, 1.0, 1.02, 1.1}), 3e-4 * rate);
}

TEST(OptionsGreeks, PureJumpsHaveNoVegaAndRowsDoNotDependOnOthers) {
  Contract c{.spot = 1.0, .strike = 1.05, .rate = 0.04, .maturity = 0.5};
  const double nig[] = {-0.5, 12.0, -4.0, 0.4};
  std::copy_n(nig, 4, c.jump);
  Contract with_brownian = c;
  with_brownian.variance = 0.03;
  with_brownian.type = Type::call;
  with_brownian.dividend = 0.05;
  const std::vector<Sensitivities> both = sensitivities_of({}, {c, with_brownian});
  EXPECT_EQ(both[0].vega, 0.0);
  EXPECT_LT(both[0].rho, -0.1);
  EXPECT_EQ(both[1].rho, sensitivities_of({}, {with_brownian})[0].rho);
  EXPECT_EQ(both[1].vega, sensitivities_of({}, {with_brownian})[0].vega);
}

TEST(OptionsGreeks, SurfacesAgreeWithSingleContracts) {
  std::vector<Contract> contracts;
  for (const double strike : {90.0, 100.0, 110.0, 130.0})
    contracts.push_back({.model = JumpModel::black_scholes,
                         .spot = 100.0,
                         .strike = strike,
                         .rate = 0.05,
                         .maturity = 0.5,
                         .variance = 0.04});
  Settings surface;
  surface.surface = true;
  const std::vector<Sensitivities> single = sensitivities_of({}, contracts),
                                   shared = sensitivities_of(surface, contracts);
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    EXPECT_NEAR(shared[k].vega, single[k].vega, 0.1) << k;
    EXPECT_NEAR(shared[k].rho, single[k].rho, 0.1) << k;
  }
}

}  // namespace
}  // namespace drogue::options
