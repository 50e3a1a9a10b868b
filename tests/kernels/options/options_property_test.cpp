#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory_resource>
#include <span>
#include <stdexcept>

#include "kernels/options/pricer.hpp"
#include "tests/support/option_sets.hpp"
#include "tests/support/priced.hpp"

// Properties that hold for every price.

namespace drogue::options {
namespace {

using testing::on_mesh;
using testing::option_sets;
using testing::priced;
using testing::random_contracts;

constexpr const auto& backend = testing::tested_backend;

double payoff(const Contract& c) {
  return std::max(0.0, c.type == Type::put ? c.strike - c.spot : c.spot - c.strike);
}

template <class Change>
std::vector<Contract> changed(std::vector<Contract> contracts, const Change& change) {
  for (Contract& c : contracts) change(c);
  return contracts;
}

TEST(OptionsProperty, SatisfiesPutCallParityAndBoundsOfEarlyExercise) {
  auto contracts = random_contracts(40, 1);
  const auto all = [&](Style style, Type type) {
    return priced(on_mesh(128, 32), changed(contracts, [=](Contract& c) { c.style = style, c.type = type; }));
  };
  const auto put = all(Style::european, Type::put), call = all(Style::european, Type::call);
  const auto early = all(Style::american, Type::put), early_call = all(Style::american, Type::call);
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    const Contract& c = contracts[k];
    const double forward =
        c.spot * std::exp(-c.dividend * c.maturity) - c.strike * std::exp(-c.rate * c.maturity);
    const double tolerance = put[k].error + call[k].error;
    EXPECT_NEAR(call[k].price - put[k].price, forward, tolerance) << k;
    EXPECT_GE(early[k].price, put[k].price - tolerance) << k;
    EXPECT_GE(early_call[k].price, call[k].price - tolerance) << k;
    EXPECT_GE(early[k].price, std::max(0.0, c.strike - c.spot)) << k;
    EXPECT_LE(early[k].price, c.strike) << k;
    EXPECT_LE(early_call[k].price, c.spot) << k;
    if (c.dividend == 0.0) {
      EXPECT_NEAR(early_call[k].price, call[k].price, tolerance) << k;
    }
  }
}

TEST(OptionsProperty, CallEqualsPutUnderTheDualMeasure) {
  const auto contracts = random_contracts(16, 2);
  const auto mirrored = changed(contracts, [](Contract& c) {
    c.type = c.type == Type::put ? Type::call : Type::put;
    std::swap(c.spot, c.strike);
    std::swap(c.rate, c.dividend);
    c.jump[2] = -c.jump[2] - 1.0;
  });
  const auto one = priced(on_mesh(64, 16), contracts), other = priced(on_mesh(64, 16), mirrored);
  for (std::size_t k = 0; k < one.size(); ++k)
    EXPECT_NEAR(one[k].price, other[k].price, 1e-10 * contracts[k].strike) << k;
}

TEST(OptionsProperty, PricesAreHomogeneousInSpotAndStrike) {
  const auto contracts = random_contracts(16, 3);
  const auto scaled = changed(contracts, [](Contract& c) { c.spot *= 37.0, c.strike *= 37.0; });
  const auto one = priced(on_mesh(64, 16), contracts), other = priced(on_mesh(64, 16), scaled);
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_NEAR(37.0 * one[k].price, other[k].price, 1e-10 * scaled[k].strike) << k;
    EXPECT_NEAR(one[k].delta, other[k].delta, 1e-8) << k;
  }
}

TEST(OptionsProperty, BitsDoNotDependOnThePositionInTheBatch) {
  auto contracts = random_contracts(11, 4);
  contracts[3].model = JumpModel::black_scholes;
  Settings settings;
  settings.tolerance = 1e-4;
  const auto whole_batch = priced(settings, contracts);
  std::reverse(contracts.begin(), contracts.end());
  contracts.resize(9);
  const auto part_of_batch = priced(settings, contracts);
  for (std::size_t k = 0; k < part_of_batch.size(); ++k)
    EXPECT_EQ(
        std::memcmp(&part_of_batch[k].price, &whole_batch[whole_batch.size() - 1 - k].price, sizeof(double)),
        0)
        << k;
  EXPECT_EQ(priced(settings, {contracts[4]})[0].price, part_of_batch[4].price);
}

// More contracts than one launch takes, of two models, by a pricer whose stored order is another one. The
// last contract has an order that requires another table.
// ctest-label: no-sanitizer
TEST(OptionsProperty, BitsDoNotDependOnTheLaunchesOfABatch) {
  constexpr std::size_t size = (1 << 17) + 5;
  auto kinds = random_contracts(7, 5);
  kinds[3].model = JumpModel::black_scholes;
  Contract late = kinds[0];
  const Settings settings = on_mesh(32, 8);
  const auto pricer = create_pricer(backend, settings);
  for (const std::size_t shift : {0U, 3U}) {
    std::vector<Contract> contracts(size - shift);
    for (std::size_t k = 0; k < contracts.size(); ++k) contracts[k] = kinds[(k + shift) % kinds.size()];
    late.jump[0] = 20.5 + static_cast<double>(shift);
    contracts.back() = late;
    std::vector<Price> prices(contracts.size());
    pricer->price(contracts, prices);
    EXPECT_EQ(prices.back().price, priced(settings, {late})[0].price);
    prices.pop_back();
    std::size_t other = 0;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      const double single_price = priced(settings, {kinds[kind]})[0].price;
      for (std::size_t k = (kind + kinds.size() - shift) % kinds.size(); k < prices.size(); k += kinds.size())
        other += std::memcmp(&prices[k].price, &single_price, sizeof single_price) == 0 ? 0 : 1;
    }
    EXPECT_EQ(other, 0U) << shift;
  }
}

bool same_bits(const Price& a, const Price& b) {
  for (double Price::*member :
       {&Price::price, &Price::error, &Price::delta, &Price::gamma, &Price::theta, &Price::exercise_boundary})
    if (std::memcmp(&(a.*member), &(b.*member), sizeof(double)) != 0) return false;
  return a.status == b.status;
}

/// True if two results have the same bits, or nearly so on hosts without the `exact` build: there the
/// compiler may fuse multiplications and additions otherwise for the last lanes of a batch than for whole
/// registers.
bool agree(const Price& a, const Price& b) {
#if defined(DROGUE_EXACT)
  constexpr bool has_fused_operations = false;
#else
  constexpr bool has_fused_operations = true;
#endif
  if (!has_fused_operations || backend == device::Backend::cuda) return same_bits(a, b);
  const auto close = [](double x, double y, double tolerance) {
    return x == y || (std::isnan(x) && std::isnan(y)) ||
           std::abs(x - y) <= tolerance * std::max(std::abs(x), std::abs(y));
  };
  return a.status == b.status && close(a.price, b.price, 1e-12) && close(a.error, b.error, 1e-9) &&
         close(a.delta, b.delta, 1e-11) && close(a.gamma, b.gamma, 1e-9) && close(a.theta, b.theta, 1e-9) &&
         close(a.exercise_boundary, b.exercise_boundary, 1e-11);
}

// A device uses other launches for small batches: one warp per grid, and for the smallest batches direct
// access to host memory.
// ctest-label: exact no-sanitizer
TEST(OptionsProperty, PricesDoNotDependOnTheSizeOfTheBatch) {
  auto contracts = random_contracts(device::needs_device(backend) ? 2400 : 760, 9);
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    Contract& c = contracts[k];
    if (k % 4 != 0) {
      c.model = k % 4 == 1 ? JumpModel::black_scholes : k % 4 == 2 ? JumpModel::merton : JumpModel::kou;
      const double jump[4] = {0.4, 0.3, c.model == JumpModel::merton ? 0.2 : 6.0, 4.0};
      std::copy_n(jump, 4, c.jump);
      c.variance += 0.01;
    }
    if (k % 11 == 0) c.rate = -0.02, c.dividend = -0.05;
    if (k % 13 == 0) c.maturity = 0.003;
    if (k % 17 == 0 && k % 4 == 0) c.variance = 0.0;
  }
  const auto pricer = create_pricer(backend, on_mesh(128, 32));
  std::vector<Price> whole_batch(contracts.size()), in_parts(contracts.size());
  pricer->price(contracts, whole_batch);
  for (const std::size_t part : {300U, 65U, 64U, 7U, 1U}) {
    for (std::size_t k = 0; k < contracts.size(); k += part) {
      const std::size_t count = std::min(part, contracts.size() - k);
      pricer->price(std::span(contracts).subspan(k, count), std::span(in_parts).subspan(k, count));
    }
    std::size_t other = 0;
    for (std::size_t k = 0; k < contracts.size(); ++k) other += agree(whole_batch[k], in_parts[k]) ? 0 : 1;
    EXPECT_EQ(other, 0U) << part;
  }
}

// Neither separate timing nor the memory of contracts and prices changes the prices.
TEST(OptionsProperty, SeparateTimesDoNotChangePrices) {
  const auto contracts = random_contracts(5, 10);
  Settings settings = on_mesh(128, 32);
  const auto expected = priced(settings, contracts);
  for (const bool separate : {false, true}) {
    settings.time_copies = separate;
    const auto pricer = create_pricer(backend, settings);
    const std::pmr::vector<Contract> from(contracts.begin(), contracts.end(), &pricer->memory());
    std::pmr::vector<Price> to(contracts.size(), &pricer->memory());
    const WallTimes timing = pricer->price(from, to);
    EXPECT_GT(timing.compute, 0.0);
    EXPECT_EQ(timing.h2d > 0.0 && timing.d2h > 0.0, separate);
    for (std::size_t k = 0; k < to.size(); ++k) EXPECT_TRUE(same_bits(to[k], expected[k])) << k;
  }
}

/// Cubic Lagrange interpolation through the four nodes around a spot, in the logarithm.
double value_at(const std::vector<ProfilePoint>& profile, double spot) {
  std::size_t k = 1;
  while (profile[k + 1].spot <= spot) ++k;
  const double t = std::log(spot / profile[k].spot) / std::log(profile[k + 1].spot / profile[k].spot);
  return -t * (t - 1) * (t - 2) / 6 * profile[k - 1].price +
         (t + 1) * (t - 1) * (t - 2) / 2 * profile[k].price -
         (t + 1) * t * (t - 2) / 2 * profile[k + 1].price + (t + 1) * t * (t - 1) / 6 * profile[k + 2].price;
}

/// Largest error of one grid at the spots of a set that are not exercised, and the step of the grid.
struct GridError {
  double worst, h;
};

GridError grid_error(const testing::OptionSet& set, int mesh, int steps) {
  const auto profile =
      create_pricer(backend, on_mesh(mesh, steps))->profile(contract_of(set, 3, Style::american));
  double worst = 0.0;
  for (std::size_t k = 2; k < 6; ++k)
    worst = std::max(worst, std::abs(value_at(profile, set.spot[k]) - set.american[k]));
  return {worst, std::log(profile[1].spot / profile[0].spot)};
}

// Grids with four times the nodes are slightly wider, so the ratio of the steps is less than four.
// ctest-label: no-sanitizer
TEST(OptionsProperty, ConvergesAtSecondOrder) {
  for (const testing::OptionSet& set : option_sets()) {
    const GridError coarse = grid_error(set, 96, 48), fine = grid_error(set, 384, 192);
    const double order = std::log(coarse.worst / fine.worst) / std::log(coarse.h / fine.h);
    EXPECT_GT(order, 1.7) << set.name << ", " << coarse.worst << " to " << fine.worst;
    EXPECT_LT(order, 2.6) << set.name << ", " << coarse.worst << " to " << fine.worst;
  }
}

// Both grids treat the same part of the jumps implicitly. Otherwise the error in time contains h dt^2, which
// the extrapolation does not remove and the difference of the grids does not show.
// ctest-label: no-sanitizer
TEST(OptionsProperty, ErrorInTimeOfShortJumpsDoesNotDependOnTheMesh) {
  constexpr int steps = 64;
  for (const double beta : {-8.0, -0.5, 2.6}) {
    const std::vector<Contract> row = {{.style = Style::european,
                                        .type = Type::call,
                                        .spot = 70.5,
                                        .strike = 100.0,
                                        .rate = 0.0935,
                                        .dividend = 0.0264,
                                        .maturity = 1.6,
                                        .variance = 0.158,
                                        .jump = {0.8, 21.4, beta, 0.966}}};
    const auto error_in_time = [&](int mesh) {
      return priced(on_mesh(mesh, steps), row)[0].price - priced(on_mesh(mesh, 32 * steps), row)[0].price;
    };
    EXPECT_LT(std::abs(error_in_time(256) - error_in_time(1024)), 5e-5) << beta;
  }
}

TEST(OptionsProperty, PricesAreContinuousInTheJumpParameters) {
  Contract c;
  c.rate = 0.05;
  c.variance = 0.02;
  const auto price = [&](double lambda, double alpha, double beta, double delta) {
    const double jump[4] = {lambda, alpha, beta, delta};
    std::copy(jump, jump + 4, c.jump);
    return priced(on_mesh(128, 32), {c})[0].price;
  };
  // Orders at the limits of panels of the table, and towards variance gamma.
  for (const double order : {-0.5, 0.0625, 0.5, 1.0, -2.0})
    EXPECT_NEAR(price(order - 1e-9, 9.0, -3.0, 0.4), price(order + 1e-9, 9.0, -3.0, 0.4), 1e-7) << order;
  EXPECT_NEAR(price(1.5, 9.0, -3.0, 1e-7), price(1.5, 9.0, -3.0, 0.0), 1e-7);
  EXPECT_NEAR(price(-1.0, 9.0, -3.0, 1e-9), price(1e-12, 9.0, -3.0, 0.0), 1e-7);  // limit without jumps
  EXPECT_NEAR(price(1.0, 3.0, -2.999, 0.2), price(1.0, 3.0, -2.99900001, 0.2), 1e-5);
}

TEST(OptionsProperty, HardContractsDoNotFail) {
  std::vector<Contract> contracts;
  for (const double maturity : {1.0 / 365, 1.0, 30.0})
    for (const double variance : {0.0, 0.04})
      for (const auto& jump : {std::array{2.0, 11.0, -5.0, 0.0}, std::array{-0.5, 15.0, -5.0, 0.5},
                               std::array{-5.0, 8.0, -2.0, 0.8}, std::array{5.0, 18.0, -2.0, 0.8},
                               std::array{1.0, 8.0, -2.0, 1e-6}, std::array{-0.5, 3.0, -2.95, 0.5},
                               std::array{-0.5, 3.0, 1.95, 0.5}})
        for (const auto& [rate, dividend] : {std::pair{0.05, 0.0}, {0.0, 0.0}, {-0.02, 0.01}, {0.0, -0.03}}) {
          Contract c;
          c.type = contracts.size() % 2 == 0 ? Type::put : Type::call;
          c.maturity = maturity;
          c.variance = variance;
          c.rate = rate;
          c.dividend = dividend;
          c.spot = 1.02;
          std::copy(jump.begin(), jump.end(), c.jump);
          contracts.push_back(c);
        }
  const auto prices = priced(on_mesh(128, 32), contracts);
  std::size_t failed = 0;
  for (std::size_t k = 0; k < prices.size(); ++k) {
    if (prices[k].status == PriceStatus::failed) {
      ++failed;
      continue;
    }
    EXPECT_GE(prices[k].price, payoff(contracts[k]) - 1e-12) << k;
    EXPECT_LT(prices[k].price, 1.02 * std::exp(0.03 * 30.0)) << k;  // upper bound by the growth of the asset
    EXPECT_TRUE(std::isfinite(prices[k].delta) && std::isfinite(prices[k].gamma)) << k;
  }
  EXPECT_EQ(failed, 0U);
}

TEST(OptionsProperty, FailsForOrdersBeyondTheTable) {
  std::vector<Contract> contracts = random_contracts(5, 9);
  contracts[2].jump[0] = 200.0;
  contracts[2].jump[3] = 1.0;
  const auto prices = priced(on_mesh(64, 16), contracts);
  for (std::size_t k = 0; k < prices.size(); ++k)
    EXPECT_EQ(prices[k].status == PriceStatus::failed, k == 2) << k;
  EXPECT_TRUE(std::isnan(prices[2].price));
}

// Stiff jumps: a hundred years in few steps on grids that are truncated at the exercise boundary. The added
// diffusion once made these cases grow without bound.
// ctest-label: no-sanitizer
TEST(OptionsProperty, StaysBoundedForAHundredYearsOfPureJumps) {
  std::vector<Contract> contracts;
  for (const auto& jump : {std::array{-0.5, 15.0, -0.5, 0.5}, std::array{-0.5, 15.0, -5.0, 0.5},
                           std::array{1.0, 8.15, -2.5, 0.767}})
    for (const Type type : {Type::put, Type::call}) {
      Contract c{.type = type, .rate = 0.05, .dividend = type == Type::put ? 0.0 : 0.05, .maturity = 100.0};
      std::ranges::copy(jump, c.jump);
      contracts.push_back(c);
    }
  const auto few = priced(on_mesh(512, 128), contracts), many = priced(on_mesh(512, 512), contracts);
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    EXPECT_LT(few[k].error, 1e-3) << k;
    EXPECT_NEAR(few[k].price, many[k].price, few[k].error + many[k].error) << k;
  }
}

Price one_price(double rate, double maturity, double variance, double delta, const Settings& settings) {
  Contract c{.style = Style::european, .rate = rate, .maturity = maturity, .variance = variance};
  std::ranges::copy(std::array{-0.5, 15.0, -5.0, delta}, c.jump);
  return priced(settings, {c})[0];
}

// ctest-label: no-sanitizer
TEST(OptionsProperty, ReportsTheReasonOfAFailure) {
  EXPECT_EQ(one_price(-10.0, 100.0, 0.04, 0.5, Settings{}).failure, PricingFailure::discount_overflow);
  Contract money{.style = Style::european, .spot = 1e99, .strike = 1e99, .rate = -5.0, .maturity = 100.0};
  std::ranges::copy(std::array{-0.5, 15.0, -5.0, 0.5}, money.jump);
  EXPECT_EQ(priced(Settings{}, {money})[0].failure, PricingFailure::discount_overflow);
  EXPECT_EQ(one_price(0.05, 1.0, 1e300, 0.5, Settings{}).failure, PricingFailure::no_grid);
  EXPECT_EQ(one_price(0.0, 100.0, 0.0, 20.0, on_mesh(512, 64)).failure, PricingFailure::unstable);
  // More steps or another mesh would not help.
  for (const Settings& settings : {Settings{}, on_mesh(128, 32)}) {
    EXPECT_EQ(one_price(1e308, 1.0, 0.04, 0.5, settings).failure, PricingFailure::coefficient_overflow);
  }
  EXPECT_EQ(one_price(1e12, 1.0, 0.04, 0.5, on_mesh(128, 32)).failure, PricingFailure::stiff);
  Contract merton{.model = JumpModel::merton, .style = Style::european, .rate = 0.05, .variance = 0.04};
  std::ranges::copy(std::array{1e12, -0.1, 0.2}, merton.jump);
  EXPECT_EQ(priced(on_mesh(128, 32), {merton})[0].failure, PricingFailure::stiff);
  // The tolerance selects more steps.
  Settings loose;
  loose.tolerance = 1e-3;
  const Price price = one_price(0.0, 100.0, 0.0, 20.0, loose);
  EXPECT_EQ(price.failure, PricingFailure::none);
  EXPECT_NEAR(price.price, 1.0, price.error);
  EXPECT_GT(price.steps, price.mesh / 4);
}

// A given mesh has no tolerance that a price could miss.
TEST(OptionsProperty, OnlyAToleranceMakesAPriceCoarse) {
  Contract rare{.style = Style::european, .maturity = 1.0};
  std::ranges::copy(std::array{0.1, 11.0, -5.0, 0.0}, rare.jump);
  for (const bool surface : {false, true}) {
    Settings given = on_mesh(64, 16), chosen;
    given.surface = chosen.surface = surface;
    chosen.tolerance = 1e-9;
    EXPECT_EQ(priced(chosen, {rare})[0].status, PriceStatus::coarse);
    const Price price = priced(given, {rare})[0];
    EXPECT_EQ(price.status, PriceStatus::ok);
    EXPECT_GT(price.error, given.tolerance);
  }
}

// The approximate reciprocals of devices and of AVX-512 overflow for a jump scale of 1e-300; a division does
// not, and gives the price of vanishing jumps.
TEST(OptionsProperty, PricesVanishingJumpsOrReportsTheOverflow) {
  for (const Settings& settings : {Settings{}, on_mesh(128, 32)}) {
    const Price price = one_price(0.05, 1.0, 0.04, 1e-300, settings),
                limit = one_price(0.05, 1.0, 0.04, 1e-100, settings);
    EXPECT_EQ(limit.failure, PricingFailure::none);
    if (price.failure != PricingFailure::none)
      EXPECT_EQ(price.failure, PricingFailure::coefficient_overflow);
    else
      EXPECT_NEAR(price.price, limit.price, 1e-12);
  }
}

std::vector<Price> at_maturities(Contract c, const std::vector<double>& maturities) {
  std::vector<Contract> contracts;
  for (const double maturity : maturities) {
    c.maturity = maturity;
    contracts.push_back(c);
  }
  return priced(on_mesh(128, 32), contracts);
}

// The price increases with maturity for American options and for calls without dividends.
TEST(OptionsProperty, PricesIncreaseWithMaturity) {
  const std::vector<double> maturities = {1.0 / 52, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
  for (Contract c : random_contracts(16, 11)) {
    if (c.style == Style::european) {
      c.type = Type::call;
      c.dividend = 0.0;
    }
    const auto prices = at_maturities(c, maturities);
    for (std::size_t k = 1; k < prices.size(); ++k)
      EXPECT_GE(prices[k].price, prices[k - 1].price - prices[k].error - prices[k - 1].error)
          << maturities[k] << " years, spot " << c.spot << ", strike " << c.strike;
  }
}

/// Time value at the second node above the exercised ones divided by the distance, and the step of the grid.
GridError misfit(const testing::OptionSet& set, int mesh) {
  const auto profile =
      create_pricer(backend, on_mesh(mesh, mesh / 4))->profile(contract_of(set, 3, Style::american));
  const auto time_value = [&](std::size_t k) { return profile[k].price - (1.0 - profile[k].spot); };
  std::size_t k = 1;
  while (time_value(k) < 1e-12) ++k;
  const double h = std::log(profile[1].spot / profile[0].spot);
  return {time_value(k + 1) / (2.0 * h), h};
}

// Smooth fit: the slope at the boundary differs from -1 by an amount of first order in the step, with
// diffusion. The boundary may lie anywhere within an interval, so the meshes differ by a factor of 16.
// ctest-label: no-sanitizer
TEST(OptionsProperty, SatisfiesSmoothFit) {
  for (const std::size_t k : {0U, 1U, 3U, 4U}) {
    const testing::OptionSet& set = option_sets()[k];
    const GridError coarse = misfit(set, 64), fine = misfit(set, 1024);
    const double order = std::log(coarse.worst / fine.worst) / std::log(coarse.h / fine.h);
    EXPECT_GT(order, 0.7) << set.name << ", " << coarse.worst << " to " << fine.worst;
    EXPECT_LT(order, 1.3) << set.name << ", " << coarse.worst << " to " << fine.worst;
  }
}

// Delta of an exercised put is -1, and close to it just above the boundary.
// ctest-label: no-sanitizer
TEST(OptionsProperty, DeltaIsContinuousAtTheBoundary) {
  for (const std::size_t k : {0U, 1U, 3U, 4U}) {
    Contract c = contract_of(option_sets()[k], 3, Style::american);
    const double boundary = priced(on_mesh(512, 128), {c})[0].exercise_boundary;
    std::vector<Contract> contracts;
    for (const double distance : {-1e-3, 1e-3, 4e-3, 16e-3}) {
      c.spot = boundary * std::exp(distance);
      contracts.push_back(c);
    }
    const auto prices = priced(on_mesh(512, 128), contracts);
    EXPECT_NEAR(prices[0].delta, -1.0, 1e-12);
    for (std::size_t i = 1; i < prices.size(); ++i) {
      EXPECT_GE(prices[i].delta, prices[i - 1].delta) << option_sets()[k].name << " " << i;
    }
    EXPECT_LT(prices[1].delta, -0.98) << option_sets()[k].name;
  }
}

// Expected errors at 128 and 512: an independent implementation of [Shi], section 4.6.2, with the same
// choices where the text leaves them open.
TEST(OptionsProperty, BaselineHasTheErrorsOfThePrintedSchemeAndFirstOrder) {
  const testing::OptionSet& set = option_sets()[0];
  const auto error = [&](int mesh) {
    Settings settings = on_mesh(mesh, mesh);
    settings.method = Method::baseline;
    double worst = 0.0;
    for (std::size_t k = 1; k <= 5; ++k) {
      const Price price = priced(settings, {contract_of(set, k, Style::american)})[0];
      EXPECT_TRUE(std::isnan(price.error));
      worst = std::max(worst, std::abs(price.price - set.american[k]));
    }
    return worst;
  };
  const double coarse = error(128), middle = error(256), fine = error(512);
  EXPECT_NEAR(coarse, 4.4e-4, 0.05e-4);
  EXPECT_NEAR(fine, 9.1e-5, 0.05e-5);
  EXPECT_NEAR(std::log2(coarse / middle), 1.14, 0.03);
  EXPECT_NEAR(std::log2(middle / fine), 1.12, 0.03);
}

TEST(OptionsProperty, BoundaryRisesTowardsExpiry) {
  Contract c = contract_of(option_sets()[0], 3, Style::american);
  const auto curve = create_pricer(backend, on_mesh(256, 64))->boundary(c);
  ASSERT_GT(curve.size(), 60U);
  for (std::size_t k = 1; k < curve.size(); ++k) {
    EXPECT_GT(curve[k].time, curve[k - 1].time);
    EXPECT_GE(curve[k].spot, curve[k - 1].spot - 2e-3) << curve[k].time;
  }
  EXPECT_NEAR(curve[0].time, 0.0, 1e-12);
  EXPECT_NEAR(curve[0].spot, priced(on_mesh(256, 64), {c})[0].exercise_boundary, 1e-12);
  const Price chosen = priced(Settings{}, {c})[0];
  EXPECT_NEAR(create_pricer(backend, Settings{})->boundary(c, chosen.mesh, chosen.steps)[0].spot,
              chosen.exercise_boundary, 1e-12);
  // At and below the boundary the price is the payoff, above it exceeds the payoff.
  for (const double factor : {0.98, 1.02}) {
    c.spot = factor * curve[0].spot;
    const double time_value = priced(on_mesh(256, 64), {c})[0].price - payoff(c);
    EXPECT_EQ(time_value > 1e-9, factor > 1.0) << time_value;
  }
  c.style = Style::european;
  EXPECT_TRUE(create_pricer(backend, on_mesh(64, 16))->boundary(c).empty());
}

// Reference: difference quotients of prices at spots where these are smooth.
// ctest-label: no-sanitizer
TEST(OptionsProperty, GreeksMatchDifferenceQuotients) {
  Contract c = contract_of(option_sets()[1], 3, Style::american);
  for (const Type type : {Type::put, Type::call}) {
    c.type = type;
    c.dividend = 0.03;
    const auto at = [&](double spot, double maturity) {
      Contract moved = c;
      moved.spot = spot;
      moved.maturity = maturity;
      return priced(on_mesh(512, 128), {moved})[0];
    };
    const double step = 0.02;
    const Price here = at(1.1, 1.0), above = at(1.1 + step, 1.0), below = at(1.1 - step, 1.0);
    EXPECT_NEAR(here.delta, (above.price - below.price) / (2 * step), 2e-3);
    EXPECT_NEAR(here.gamma, (above.price - 2 * here.price + below.price) / (step * step), 2e-2);
    EXPECT_NEAR(here.theta, -(at(1.1, 1.01).price - at(1.1, 0.99).price) / 0.02, 1e-3);
  }
}

TEST(OptionsProperty, RejectsInvalidSettings) {
  Settings settings;
  settings.mesh = 33;
  EXPECT_THROW(static_cast<void>(create_pricer(backend, settings)), std::invalid_argument);
  settings = on_mesh(128, 7);
  EXPECT_THROW(static_cast<void>(create_pricer(backend, settings)), std::invalid_argument);
  settings = Settings{};
  settings.tolerance = 0.0;
  EXPECT_THROW(static_cast<void>(create_pricer(backend, settings)), std::invalid_argument);
  std::vector<Price> prices(2);
  const std::vector<Contract> one = random_contracts(1, 1);
  EXPECT_THROW(create_pricer(backend, Settings{})->price(one, prices), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::options
