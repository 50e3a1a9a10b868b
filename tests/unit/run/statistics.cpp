#include "common/run/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

namespace drogue::run {
namespace {

std::vector<double> first_numbers(std::size_t count) {
  std::vector<double> values(count);
  std::iota(values.rbegin(), values.rend(), 1.0);  // descending: the functions sort
  return values;
}

TEST(Statistics, MaximumKeepsNaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(maximum_or_nan(1.0, 2.0), 2.0);
  EXPECT_EQ(maximum_or_nan(2.0, 1.0), 2.0);
  EXPECT_TRUE(std::isnan(maximum_or_nan(nan, 1.0)));
  EXPECT_TRUE(std::isnan(maximum_or_nan(1.0, nan)));
}

TEST(Statistics, MedianOfOddAndEvenCounts) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_EQ(median({7.0}), 7.0);
  EXPECT_THROW(median({}), std::invalid_argument);
}

// Ranks and coverage of the sign-test interval: Conover, Practical Nonparametric Statistics, table A3 (p =
// 1/2).
TEST(Statistics, IntervalUsesTheTabulatedRanks) {
  const MedianInterval ten = median_interval(first_numbers(10));
  EXPECT_EQ(ten.median, 5.5);
  EXPECT_EQ(ten.low, 2.0);
  EXPECT_EQ(ten.high, 9.0);
  EXPECT_NEAR(ten.coverage, 1.0 - 2.0 * 11.0 / 1024.0, 1e-12);
  const MedianInterval twenty = median_interval(first_numbers(20));
  EXPECT_EQ(twenty.low, 6.0);
  EXPECT_EQ(twenty.high, 15.0);
  EXPECT_NEAR(twenty.coverage, 0.9586, 1e-4);
}

TEST(Statistics, FewSamplesGiveTheExtremesAndTheirCoverage) {
  const MedianInterval five = median_interval(first_numbers(5));
  EXPECT_EQ(five.low, 1.0);
  EXPECT_EQ(five.high, 5.0);
  EXPECT_NEAR(five.coverage, 0.9375, 1e-12);
  const MedianInterval one = median_interval({3.0});
  EXPECT_EQ(one.low, 3.0);
  EXPECT_EQ(one.high, 3.0);
  EXPECT_EQ(one.coverage, 0.0);
}

TEST(Statistics, IntervalCoversTheMedianAtTheStatedRate) {
  std::mt19937_64 random(4);
  std::exponential_distribution<double> skewed(1.0);
  const double truth = std::log(2.0);
  int covered = 0;
  constexpr int rounds = 4000;
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> samples(15);
    for (double& sample : samples) sample = skewed(random);
    const MedianInterval interval = median_interval(samples);
    covered += interval.low <= truth && truth <= interval.high ? 1 : 0;
  }
  EXPECT_NEAR(covered / static_cast<double>(rounds), 0.9648, 0.01);
}

}  // namespace
}  // namespace drogue::run
