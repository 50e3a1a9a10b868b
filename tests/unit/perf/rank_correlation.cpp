#include "perf/models/rank_correlation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace drogue::perf {
namespace {

TEST(RankCorrelation, IsOneForEqualOrdersAndMinusOneForOppositeOnes) {
  const RankCorrelation equal = rank_correlation({1, 5, 7, 30}, {0.1, 0.2, 0.9, 1.0}),
                        opposite = rank_correlation({1, 5, 7, 30}, {4, 3, 2, 1});
  EXPECT_DOUBLE_EQ(equal.rho, 1.0);
  EXPECT_DOUBLE_EQ(equal.probability, 1.0 / 24.0);
  EXPECT_DOUBLE_EQ(opposite.rho, -1.0);
  EXPECT_DOUBLE_EQ(opposite.probability, 1.0);
}

// The formula without ties is 1 - 6 sum(d^2) / (n (n^2 - 1)); here d^2 sums to 4.
TEST(RankCorrelation, EqualsTheFormulaOfSpearman) {
  EXPECT_NEAR(rank_correlation({1, 2, 3, 4, 5}, {2, 1, 4, 3, 5}).rho, 1.0 - 6.0 * 4.0 / 120.0, 1e-15);
}

// The one-sided value of 5 % for seven pairs is 0.714 (tables of Zar 1972).
TEST(RankCorrelation, HasThePublishedProbability) {
  const std::vector<double> order = {1, 2, 3, 4, 5, 6, 7};
  const RankCorrelation found = rank_correlation(order, {1, 2, 6, 3, 7, 4, 5});  // d^2 sums to 22
  EXPECT_NEAR(found.rho, 1.0 - 6.0 * 22.0 / 336.0, 1e-15);
  EXPECT_GT(found.probability, 0.05);
  const RankCorrelation critical = rank_correlation(order, {2, 1, 3, 6, 4, 7, 5});  // d^2 sums to 12
  EXPECT_NEAR(critical.rho, 1.0 - 6.0 * 12.0 / 336.0, 1e-15);
  EXPECT_LT(critical.probability, 0.05);
}

TEST(RankCorrelation, GivesTiesTheirMeanRank) {
  // Ranks 1.5 1.5 3 and 1 2 3: the product-moment coefficient of these.
  EXPECT_NEAR(rank_correlation({4, 4, 9}, {1, 2, 3}).rho, std::sqrt(3.0) / 2.0, 1e-15);
  EXPECT_DOUBLE_EQ(rank_correlation({4, 4, 9}, {1, 2, 3}).probability, 1.0 / 3.0);
}

TEST(RankCorrelation, IsUndefinedForAConstantSide) {
  EXPECT_TRUE(std::isnan(rank_correlation({1, 1, 1}, {1, 2, 3}).rho));
  EXPECT_EQ(rank_correlation({1, 1, 1}, {1, 2, 3}).probability, 1.0);
}

TEST(RankCorrelation, RejectsOtherNumbersOfPairs) {
  EXPECT_THROW(rank_correlation({1}, {1}), std::invalid_argument);
  EXPECT_THROW(rank_correlation({1, 2}, {1, 2, 3}), std::invalid_argument);
  EXPECT_THROW(rank_correlation(std::vector<double>(10), std::vector<double>(10)), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::perf
