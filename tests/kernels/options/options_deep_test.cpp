// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/options/pricer.hpp"
#include "tests/support/priced.hpp"

// Spots at and beyond the ends of the grid.

namespace drogue::options {
namespace {

Contract plain_put(double spot, double rate, double dividend, double maturity, double variance) {
  return {.model = JumpModel::black_scholes,
          .spot = spot,
          .rate = rate,
          .dividend = dividend,
          .maturity = maturity,
          .variance = variance};
}

std::vector<Price> on_mesh(int mesh, bool surface, const std::vector<Contract>& contracts) {
  Settings settings = testing::on_mesh(mesh, mesh / 4);
  settings.surface = surface;
  return testing::priced(settings, contracts);
}

struct DeepPut {
  Contract contract;
  double value;
};

/// American puts that are not exercised at once. The first three wait until expiry. The values of the other
/// two are those of a binomial tree, extrapolated from 2000 and 4000 steps. Exercise of the fourth put pays
/// above a boundary, which lies below a grid around the strike. Exercise of the fifth one pays below a
/// boundary deep in the grid.
std::vector<DeepPut> deep_puts() {
  return {{plain_put(0.4, -0.01, -0.02, 2.0, 0.0025), 0.603877},
          {plain_put(0.03, -0.02, -0.1, 10.0, 0.0025), 1.139854},
          {plain_put(0.005, -0.1, -0.3, 2.0, 0.0025), 1.212292},
          {plain_put(0.1, -0.02, -0.1, 30.0, 0.0025), 0.954707},
          {plain_put(0.05, 0.001, 0.1, 30.0, 0.0025), 0.974236}};
}

TEST(OptionsDeep, PricesPutsBelowTheGrid) {
  std::vector<Contract> contracts;
  for (const DeepPut& put : deep_puts()) contracts.push_back(put.contract);
  for (const bool surface : {false, true}) {
    const std::vector<Price> prices = on_mesh(128, surface, contracts);
    for (std::size_t k = 0; k < prices.size(); ++k)
      EXPECT_NEAR(prices[k].price, deep_puts()[k].value, prices[k].error + 1e-6) << k << ' ' << surface;
  }
}

// Below the grid the value is the certain e^{-r T} - e^{x - q T}.
TEST(OptionsDeep, GreeksBelowTheGridFollowFromCertainExercise) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Contract c = deep_puts()[k].contract;
    const Price price = on_mesh(128, false, {c})[0];
    const double bond = std::exp(-c.rate * c.maturity), share = std::exp(-c.dividend * c.maturity);
    EXPECT_NEAR(price.delta, -share, 1e-4) << k;
    EXPECT_NEAR(price.theta, c.rate * bond - c.dividend * c.spot * share, 1e-5) << k;
  }
}

// Holds for any signs of the rates.
TEST(OptionsDeep, AmericanPricesAreNotBelowEuropeanOnes) {
  std::vector<Contract> early, late;
  for (const auto& [rate, dividend] : {std::pair{-0.01, -0.03}, {-0.05, -0.2}, {0.002, 0.06}, {0.03, 0.04}})
    for (const double maturity : {0.3, 3.0, 20.0})
      for (const double spot : {0.9, 0.5, 0.2, 0.05, 0.002})
        for (const Type type : {Type::put, Type::call}) {
          Contract c = plain_put(spot, rate, dividend, maturity, 0.01);
          if (type == Type::call) {
            c.type = type;
            c.spot = 1.0 / spot;
            std::swap(c.rate, c.dividend);
          }
          early.push_back(c);
          c.style = Style::european;
          late.push_back(c);
        }
  const std::vector<Price> european = testing::priced_by_fourier(late);
  const std::vector<Price> american = on_mesh(64, false, early);
  for (std::size_t k = 0; k < early.size(); ++k)
    EXPECT_GE(american[k].price, european[k].price - american[k].error)
        << early[k].rate << ' ' << early[k].dividend << ' ' << early[k].maturity << ' ' << early[k].spot;
}

// The value at the upper end of the grid is 0. Two meshes sum over jumps by transforms, one directly.
TEST(OptionsDeep, ThetaVanishesTowardsTheUpperEnd) {
  for (const int mesh : {64, 128, 256}) {
    std::vector<Contract> contracts;
    for (int k = 0; k < 150; ++k) {
      Contract c = plain_put(std::exp(0.01 * k), 0.03, 0.01, 0.25, 0.04);
      c.style = Style::european;
      c.model = JumpModel::generalized_hyperbolic;
      std::ranges::copy(std::array{1.0, 30.0, -2.5, 0.1}, c.jump);
      contracts.push_back(c);
    }
    const std::vector<Price> prices = on_mesh(mesh, false, contracts);
    double before = 1.0;
    for (std::size_t k = 50; k < prices.size(); ++k) {
      EXPECT_LE(std::abs(prices[k].theta), before + 1e-5) << mesh << ' ' << k;
      before = std::abs(prices[k].theta);
    }
    EXPECT_EQ(before, 0.0);
  }
}

}  // namespace
}  // namespace drogue::options
