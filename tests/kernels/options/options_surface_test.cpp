#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "kernels/options/pricer.hpp"
#include "tests/support/option_sets.hpp"
#include "tests/support/priced.hpp"

// Strikes that share a solve, against known prices and against separate solves.

namespace drogue::options {
namespace {

constexpr const auto& backend = testing::tested_backend;

Settings surface_on(int mesh) {
  Settings settings = testing::on_mesh(mesh, mesh / 4);
  settings.surface = true;
  return settings;
}

/// The known spots of every set as strikes of the spot 1: V(c spot, c strike) = c V.
struct KnownStrikes {
  std::vector<Contract> contracts;
  std::vector<double> values;  ///< as a fraction of the strike
};

KnownStrikes known_strikes() {
  KnownStrikes known;
  for (const testing::OptionSet& set : testing::option_sets())
    for (const Style style : {Style::american, Style::european})
      for (std::size_t k = 0; k < set.spot.size(); ++k) {
        known.contracts.push_back(testing::contract_of(set, k, style));
        known.contracts.back().spot = 1.0;
        known.contracts.back().strike = 1.0 / set.spot[k];
        known.values.push_back(style == Style::american ? set.american[k] : set.european[k]);
      }
  return known;
}

/// `count` sets with `strikes` strikes each, from half the spot to twice the spot. Some have maturities of
/// days or years, or negative rates.
constexpr int strikes = 13;
std::vector<Contract> random_strikes(std::size_t count, std::uint64_t seed) {
  std::vector<Contract> contracts;
  const std::vector<Contract> sets = testing::random_contracts(count, seed);
  for (std::size_t k = 0; k < sets.size(); ++k) {
    Contract c = sets[k];
    if (k % 7 == 3) c.maturity = 5.0 / 365;
    if (k % 7 == 5) c.maturity = 8.0;
    if (k % 9 == 4) {
      c.rate = -0.02;
      c.dividend = k % 2 == 0 ? 0.01 : -0.05;
    }
    c.spot = 100.0;
    for (int i = 0; i < strikes; ++i) {
      c.strike = c.spot * std::exp2(2.0 * i / (strikes - 1) - 1.0);
      contracts.push_back(c);
    }
  }
  return contracts;
}

TEST(OptionsSurface, MatchesKnownPrices) {
  const KnownStrikes known = known_strikes();
  const std::vector<Price> prices = testing::priced(surface_on(128), known.contracts);
  std::size_t covered = 0;
  double worst = 0.0;
  for (std::size_t k = 0; k < prices.size(); ++k) {
    const double error = std::abs(prices[k].price / known.contracts[k].strike - known.values[k]);
    if (error <= prices[k].error / known.contracts[k].strike + 1e-7) ++covered;
    worst = std::max(worst, error);
  }
  std::printf("largest error %.1e, %zu of %zu covered\n", worst, covered, prices.size());
  EXPECT_LT(worst, 9e-5);
  EXPECT_GE(10 * covered, 9 * prices.size());
}

// Error estimates cover nine cases of ten, so the same share of prices is within the tolerance.
// ctest-label: no-sanitizer
TEST(OptionsSurface, ToleranceIsKept) {
  const KnownStrikes known = known_strikes();
  Settings settings;
  settings.tolerance = 1e-5;
  settings.surface = true;
  const std::vector<Price> prices = testing::priced(settings, known.contracts);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < prices.size(); ++k) {
    EXPECT_EQ(prices[k].status, PriceStatus::ok) << k;
    const double error = std::abs(prices[k].price / known.contracts[k].strike - known.values[k]);
    EXPECT_LT(error, 2e-5) << k;
    if (error <= settings.tolerance) ++kept;
  }
  EXPECT_GE(10 * kept, 9 * prices.size());
}

// Separate solves have other grids than the shared one.
// ctest-label: no-sanitizer
TEST(OptionsSurface, AgreesWithContractsPricedSeparately) {
  const std::vector<Contract> contracts = random_strikes(40, 12);
  Settings separate_settings = surface_on(256);
  separate_settings.surface = false;
  const std::vector<Price> shared = testing::priced(surface_on(256), contracts),
                           separate = testing::priced(separate_settings, contracts);
  std::size_t disagreements = 0;
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    const Contract& c = contracts[k];
    const double tolerance = shared[k].error + separate[k].error;
    if (std::abs(shared[k].price - separate[k].price) > tolerance) ++disagreements;
    EXPECT_NEAR(shared[k].price, separate[k].price, 3.0 * tolerance) << k;
    // Gamma jumps at the exercise boundary, where both have inaccurate Greeks.
    const double payoff = c.type == Type::put ? c.strike - c.spot : c.spot - c.strike;
    if (separate[k].price - payoff > 0.01 * c.strike) {
      EXPECT_NEAR(shared[k].delta, separate[k].delta, 2e-3 * c.strike / c.spot) << k;
      EXPECT_NEAR(shared[k].gamma, separate[k].gamma,
                  0.02 * separate[k].gamma + 1e-3 * c.strike / (c.spot * c.spot))
          << k;
      EXPECT_NEAR(shared[k].theta, separate[k].theta, 0.02 * std::abs(separate[k].theta) + 1e-3 * c.strike)
          << k;
    }
    if (!std::isnan(separate[k].exercise_boundary)) {
      EXPECT_FALSE(std::isnan(shared[k].exercise_boundary)) << k;
    }
  }
  EXPECT_LE(100 * disagreements, contracts.size());
}

// Reference: prices of a finer grid, which agree with separate prices
// (`AgreesWithContractsPricedSeparately`).
// ctest-label: no-sanitizer
TEST(OptionsSurface, StatedErrorsCoverAndDoNotExaggerate) {
  const std::vector<Contract> contracts = random_strikes(60, 5);
  const std::vector<Price> known = testing::priced(surface_on(512), contracts);
  for (const int mesh : {128, 256}) {
    const std::vector<Price> prices = testing::priced(surface_on(mesh), contracts);
    std::vector<double> ratio;
    for (std::size_t k = 0; k < prices.size(); ++k)
      ratio.push_back(prices[k].error /
                      (std::abs(prices[k].price - known[k].price) + 1e-12 * contracts[k].strike));
    std::sort(ratio.begin(), ratio.end());
    std::printf("mesh %d: stated over true error %.2g, %.2g, %.2g at 10, 50, 90 %% of the prices\n", mesh,
                ratio[ratio.size() / 10], ratio[ratio.size() / 2], ratio[ratio.size() * 9 / 10]);
    EXPECT_GE(ratio[ratio.size() / 10], 1.0) << mesh;
    EXPECT_LE(ratio[ratio.size() / 2], 10.0) << mesh;
  }
}

TEST(OptionsSurface, PricesAreMonotoneAndConvexInTheStrike) {
  const std::vector<Contract> contracts = random_strikes(40, 3);
  const std::vector<Price> prices = testing::priced(surface_on(128), contracts);
  const auto slope = [&](std::size_t k) {
    return (prices[k + 1].price - prices[k].price) / (contracts[k + 1].strike - contracts[k].strike);
  };
  const auto tolerance = [&](std::size_t k) {
    return (prices[k + 1].error + prices[k].error) / (contracts[k + 1].strike - contracts[k].strike);
  };
  for (std::size_t k = 0; k + 1 < contracts.size(); ++k) {
    if (k % strikes + 1 == strikes) continue;
    const double sign = contracts[k].type == Type::put ? 1.0 : -1.0;
    EXPECT_GE(sign * slope(k), -tolerance(k)) << k;
    EXPECT_LE(sign * slope(k), 1.0 + tolerance(k)) << k;
    if (k % strikes + 2 == strikes) continue;
    EXPECT_GE(slope(k + 1) - slope(k), -tolerance(k + 1) - tolerance(k)) << k;
  }
}

TEST(OptionsSurface, BitsDoNotDependOnOtherStrikes) {
  const std::vector<Contract> contracts = random_strikes(12, 8);
  Settings settings;
  settings.tolerance = 3e-5;
  settings.surface = true;
  for (const Settings& used : {settings, surface_on(128)}) {
    const std::vector<Price> all_prices = testing::priced(used, contracts);
    std::vector<Contract> selected;
    std::vector<std::size_t> position;
    for (std::size_t k = contracts.size(); k-- > 0;)
      if (k % 5 == 2) {
        selected.push_back(contracts[k]);
        position.push_back(k);
      }
    const std::vector<Price> selected_prices = testing::priced(used, selected);
    for (std::size_t k = 0; k < selected.size(); ++k)
      for (const auto member : {&Price::price, &Price::error, &Price::delta, &Price::gamma, &Price::theta})
        EXPECT_EQ(
            std::memcmp(&(selected_prices[k].*member), &(all_prices[position[k]].*member), sizeof(double)), 0)
            << position[k];
  }
}

// Puts with q < r < 0 are exercised between two boundaries. Exercise is split there, and the difference of
// the grids contains less of the error.
// ctest-label: no-sanitizer
TEST(OptionsSurface, StatedErrorsCoverExerciseBetweenTwoBoundaries) {
  std::vector<Contract> contracts;
  std::size_t set = 0;
  for (Contract c : testing::random_contracts(12, 21)) {
    c.style = Style::american;
    c.type = Type::put;
    c.spot = 1.0;
    c.variance = set % 2 == 0 ? 0.0 : 0.04;
    c.rate = -0.004 * static_cast<double>(1 + set % 4);
    c.dividend = c.rate - 0.09;
    c.maturity = 1.0 + static_cast<double>(set++ % 3);
    for (c.strike = 0.7; c.strike < 1.45; c.strike += 0.1) contracts.push_back(c);
  }
  Settings finest = surface_on(1024);
  finest.steps = 1024;
  const std::vector<Price> known = testing::priced(finest, contracts);
  for (const int mesh : {64, 128, 256}) {
    const std::vector<Price> prices = testing::priced(surface_on(mesh), contracts);
    std::vector<double> ratio;
    for (std::size_t k = 0; k < prices.size(); ++k)
      ratio.push_back(prices[k].error / (std::abs(prices[k].price - known[k].price) + 1e-7));
    std::sort(ratio.begin(), ratio.end());
    EXPECT_GE(ratio[ratio.size() / 10], 1.0) << mesh;
    EXPECT_LE(ratio[ratio.size() / 2], 10.0) << mesh;
    std::printf("mesh %d: stated over true error %.2g, %.2g, %.2g at 10, 50, 90 %% of the prices\n", mesh,
                ratio[ratio.size() / 10], ratio[ratio.size() / 2], ratio[ratio.size() * 9 / 10]);
  }
}

// Beyond the grid the value is known: certain exercise or expiry, or 0.
TEST(OptionsSurface, PricesStrikesBeyondTheGrid) {
  std::vector<Contract> contracts;
  for (const Style style : {Style::american, Style::european})
    for (const Type type : {Type::put, Type::call})
      for (const double strike : {1e-9, 1e-3, 1e3, 1e9}) {
        Contract c = testing::contract_of(testing::option_sets()[2], 3, style);
        c.dividend = 0.03;
        c.type = type;
        c.strike = strike;
        contracts.push_back(c);
      }
  const std::vector<Price> prices = testing::priced(surface_on(128), contracts);
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    const Contract& c = contracts[k];
    const bool early = c.style == Style::american;
    const double asset = early ? c.spot : c.spot * std::exp(-c.dividend * c.maturity);
    const double cash = early ? c.strike : c.strike * std::exp(-c.rate * c.maturity);
    const double certain = std::max(0.0, c.type == Type::put ? cash - asset : asset - cash);
    EXPECT_NEAR(prices[k].price, certain, prices[k].error + 1e-12 * certain) << k;
    EXPECT_LT(prices[k].error, 1e-4 * std::max(c.strike, c.spot)) << k;
  }
}

TEST(OptionsSurface, RejectsOtherMethods) {
  Settings settings = surface_on(128);
  for (const Method method : {Method::cos, Method::baseline}) {
    settings.method = method;
    EXPECT_THROW(static_cast<void>(create_pricer(backend, settings)), std::invalid_argument);
  }
}

TEST(OptionsSurface, BoundaryEqualsThatOfTheContract) {
  const Contract contract = testing::contract_of(testing::option_sets()[0], 3, Style::american);
  Settings separate_settings = surface_on(128);
  separate_settings.surface = false;
  const auto shared = create_pricer(backend, surface_on(128))->boundary(contract),
             separate = create_pricer(backend, separate_settings)->boundary(contract);
  ASSERT_EQ(shared.size(), separate.size());
  ASSERT_FALSE(separate.empty());
  EXPECT_EQ(shared.front().spot, separate.front().spot);
}

}  // namespace
}  // namespace drogue::options
