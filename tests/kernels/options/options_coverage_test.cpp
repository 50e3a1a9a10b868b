// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "tests/support/random_americans.hpp"

// Stated errors of finite differences on random contracts, each of which is to be covered, at the default
// tolerance unless another one is named.

namespace drogue::options {
namespace {

using testing::on_mesh;
using testing::priced;

/// Expects that the errors that `prices` state cover the true ones, all of them but `missed`, and that the
/// median of their quotient is at most `most`. Rows whose price is exact are not counted in the median.
void expect_covered(const std::vector<Contract>& contracts, const std::vector<Price>& prices,
                    const std::vector<Price>& known, double most, const char* what, std::size_t missed) {
  std::vector<double> quotient;
  std::size_t uncovered = 0;
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    const Contract& c = contracts[k];
    const double error = std::abs(prices[k].price - known[k].price),
                 stated = prices[k].error + known[k].error;
    if (error > stated && ++uncovered > missed)
      ADD_FAILURE() << what << ' ' << k << ": model " << static_cast<int>(c.model) << " spot " << c.spot
                    << " T " << c.maturity << ", " << prices[k].mesh << " x " << prices[k].steps
                    << ", boundary " << known[k].exercise_boundary;
    if (error > 1e-7 * c.strike) quotient.push_back(stated / error);
  }
  std::ranges::sort(quotient);
  ASSERT_FALSE(quotient.empty());
  std::printf("%s: %zu rows, %zu with an error; %zu uncovered; stated over true %.2f least, %.2f median\n",
              what, contracts.size(), quotient.size(), uncovered, quotient.front(),
              quotient[quotient.size() / 2]);
  EXPECT_LE(quotient[quotient.size() / 2], most) << what;
}

/// As `expect_covered`, for prices at the default tolerance.
void expect_all_covered(const std::vector<Contract>& contracts, const std::vector<Price>& known, double most,
                        const char* what, std::size_t missed = 0) {
  expect_covered(contracts, priced({}, contracts), known, most, what, missed);
}

TEST(OptionsCoverage, CoversAllRandomAmericans) {
  const std::vector<Contract> contracts = testing::random_americans(500, 11);
  expect_all_covered(contracts, priced(on_mesh(1024, 512), contracts), 15.0, "random");
}

/// Contracts at `per` spots within 10 % of each boundary of `bases`, four of five where they are kept.
std::vector<Contract> beside_boundaries(const std::vector<Contract>& bases, int per, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  const auto in = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(bits() >> 11U) * 0x1p-53;
  };
  const std::vector<Price> prices = priced(on_mesh(512, 128), bases);
  std::vector<Contract> contracts;
  for (std::size_t k = 0; k < bases.size(); ++k)
    for (int i = 0; i < per; ++i) {
      Contract c = bases[k];
      const double kept = (c.type == Type::put ? 1.0 : -1.0) * (in(0.0, 1.0) < 0.8 ? 1.0 : -1.0);
      c.spot = prices[k].exercise_boundary * (1.0 + kept * std::exp(in(std::log(5e-4), std::log(0.1))));
      if (c.spot > 1.0 && c.spot < 1e4) contracts.push_back(c);
    }
  return contracts;
}

// A boundary that stands between two nodes leaves an error that depends on its place between them.
TEST(OptionsCoverage, CoversAllSpotsBesideBoundaries) {
  const std::vector<Contract> contracts = beside_boundaries(testing::random_americans(250, 12), 3, 13);
  expect_all_covered(contracts, priced(on_mesh(1024, 512), contracts), 15.0, "beside boundaries");
}

// The boundary is half a step above the last exercised node, or a step of the coarser grid.
TEST(OptionsCoverage, CoversBoundariesBetweenNodes) {
  std::vector<Contract> contracts;
  for (const double variance : {0.0185, 0.0359, 0.0756})
    for (const double rate : {0.022, 0.0682, 0.0986})
      for (const double maturity : {0.38, 1.5, 2.5, 4.2})
        for (const double dividend : {0.0, 0.011})
          contracts.push_back({.model = JumpModel::black_scholes,
                               .spot = 100.0,
                               .strike = 100.0,
                               .rate = rate,
                               .dividend = dividend,
                               .maturity = maturity,
                               .variance = variance});
  const std::vector<Contract> beside = beside_boundaries(contracts, 5, 14);
  expect_all_covered(beside, priced(on_mesh(1024, 512), beside), 15.0, "between nodes");
}

/// European contracts in and out of the money whose few jumps decide on the price.
std::vector<Contract> rare_jumps(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  const auto in = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(bits() >> 11U) * 0x1p-53;
  };
  std::vector<Contract> contracts(count);
  for (std::size_t k = 0; k < count; ++k) {
    Contract& c = contracts[k];
    c.model = k % 2 == 0 ? JumpModel::merton : JumpModel::kou;
    c.style = Style::european;
    c.type = in(0.0, 1.0) < 0.5 ? Type::put : Type::call;
    c.strike = 100.0;
    c.spot = 100.0 * std::exp((c.type == Type::put ? 1.0 : -1.0) * in(0.0, 0.6));
    c.maturity = std::exp(in(std::log(0.003), std::log(1.0)));
    c.rate = in(0.0, 0.12);
    c.dividend = in(0.0, 0.06);
    c.variance = in(0.005, 0.16);
    const double jumps[2][4] = {{in(0.1, 3.0), in(-0.3, 0.1), in(0.05, 0.4)},
                                {in(0.1, 5.0), in(0.0, 1.0), in(3.0, 20.0), in(2.0, 20.0)}};
    std::copy_n(jumps[k % 2], 4, c.jump);
  }
  return contracts;
}

/// European contracts with jumps of GH, whose decay length 1/alpha is a fifth of a year's deviation or less.
std::vector<Contract> short_jumps(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  const auto in = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(bits() >> 11U) * 0x1p-53;
  };
  std::vector<Contract> contracts(count);
  for (Contract& c : contracts) {
    c.style = Style::european;
    c.type = in(0.0, 1.0) < 0.5 ? Type::put : Type::call;
    c.strike = 100.0;
    c.spot = 100.0 * std::exp(in(-0.4, 0.4));
    c.maturity = std::exp(in(std::log(0.3), std::log(5.0)));
    c.rate = in(0.0, 0.12);
    c.dividend = in(0.0, 0.06);
    c.variance = in(0.05, 0.16);
    const double alpha = in(15.0, 30.0);
    const double jump[] = {in(-2.0, 2.0), alpha, in(-0.6, 0.3) * alpha - 0.5, in(0.2, 1.0)};
    std::copy_n(jump, 4, c.jump);
  }
  return contracts;
}

// Jumps within a step are diffusion, which is implicit: on one grid more of them than on the other.
TEST(OptionsCoverage, CoversAlmostAllEuropeansOfShortJumps) {
  const std::vector<Contract> contracts = short_jumps(1000, 16);
  const std::vector<Price> known = testing::priced_by_fourier(contracts);
  for (const double tolerance : {1e-4, 1e-5, 3e-6}) {
    Settings settings;
    settings.tolerance = tolerance;
    expect_covered(contracts, priced(settings, contracts), known, 15.0, "short jumps", 5);
  }
}

// A path that leaves the grid and returns needs two jumps.
TEST(OptionsCoverage, CoversAllRowsOfRareJumps) {
  const std::vector<Contract> contracts = rare_jumps(600, 15);
  expect_all_covered(contracts, testing::priced_by_fourier(contracts), 15.0, "rare jumps");
}

}  // namespace
}  // namespace drogue::options
