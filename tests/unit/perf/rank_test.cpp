#include "perf/compare/rank_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace drogue::perf {
namespace {

TEST(RankTest, EqualsTablesOfMannAndWhitney) {
  // All orders of three and three values: 20. Separated samples: one of them on either side.
  EXPECT_NEAR(rank_test({1, 2, 3}, {4, 5, 6}), 2.0 / 20.0, 1e-15);
  // Pairs in the wrong order: at most one, of two of the 20.
  EXPECT_NEAR(rank_test({1, 2, 4}, {3, 5, 6}), 4.0 / 20.0, 1e-15);
  EXPECT_NEAR(rank_test({4, 5, 6}, {1, 2, 3}), 2.0 / 20.0, 1e-15);
  // C(14, 7) = 3432.
  EXPECT_NEAR(rank_test({1, 2, 3, 4, 5, 6, 7}, {8, 9, 10, 11, 12, 13, 14}), 2.0 / 3432.0, 1e-15);
  EXPECT_EQ(rank_test({1, 4}, {2, 3}), 1.0);
}

TEST(RankTest, TiesBetweenSamplesAreNoEvidence) {
  EXPECT_EQ(rank_test({1, 1, 1}, {1, 1, 1}), 1.0);
  EXPECT_GE(rank_test({1, 2, 3}, {3, 4, 5}), rank_test({1, 2, 3}, {3.5, 4, 5}));
  EXPECT_EQ(rank_test({}, {1.0}), 1.0);
}

TEST(RankTest, NormalLimitContinuesTheExactProbabilities) {
  std::vector<double> first, second;
  for (int i = 0; i < 50; ++i) first.push_back(i), second.push_back(i + 9.5);
  const double exact = rank_test(first, second);
  first.push_back(25.2), second.push_back(34.3);
  const double limit = rank_test(first, second);
  EXPECT_NEAR(std::log(exact), std::log(limit), 0.15);
}

TEST(RankShift, HoldsTheTrueShift) {
  const Shift shift = rank_shift({1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6}, {2.0, 2.1, 2.2, 2.3, 2.4, 2.5, 2.6});
  EXPECT_NEAR(shift.estimate, 1.0, 1e-12);
  EXPECT_NEAR(shift.low + shift.high, 2.0, 1e-12);
  EXPECT_GT(shift.low, 0.6);
  EXPECT_LT(shift.low, 1.0);
}

TEST(RankShift, HasNoIntervalForTooFewSamples) {
  // Two and three values have ten orders: at best 80 %.
  const Shift shift = rank_shift({1.0, 2.0}, {3.0, 4.0, 5.0});
  EXPECT_EQ(shift.estimate, 2.5);
  EXPECT_TRUE(std::isinf(shift.low) && std::isinf(shift.high));
  EXPECT_THROW(static_cast<void>(rank_shift({}, {1.0})), std::invalid_argument);
}

TEST(CorrectForCount, MultipliesByTheNumberOfHypothesesLeft) {
  // Holm 1979: 3 x 0.01, 2 x 0.02, and 0.04 not below its predecessor.
  const std::vector<double> corrected = correct_for_count({0.04, 0.01, 0.02});
  EXPECT_NEAR(corrected[1], 0.03, 1e-15);
  EXPECT_NEAR(corrected[2], 0.04, 1e-15);
  EXPECT_NEAR(corrected[0], 0.04, 1e-15);
  EXPECT_EQ(correct_for_count({0.9, 0.8}), (std::vector<double>{1.0, 1.0}));
}

}  // namespace
}  // namespace drogue::perf
