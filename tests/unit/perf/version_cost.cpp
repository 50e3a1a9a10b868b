#include "perf/compare/speed.hpp"

#include <gtest/gtest.h>

#include <random>

namespace drogue::perf {
namespace {

/// 25 times of a kernel, s, with 2 % of noise.
std::vector<double> noisy_times(double seconds, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(1.0, 0.02);
  std::vector<double> times;
  for (int k = 0; k < 25; ++k) times.push_back(seconds * noise(random));
  return times;
}

/// Cost of a version against another.
SpeedChange cost_of(const std::vector<double>& version, const std::vector<double>& other) {
  return compare_speed({other}, {version});
}

TEST(VersionCost, DividesTheTimeOfTheFirstVersionByThatOfTheOther) {
  const SpeedChange cost = cost_of(noisy_times(2.4e-3, 1), noisy_times(2e-3, 2));
  EXPECT_NEAR(cost.ratio, 1.2, 0.02);
  EXPECT_LT(cost.low, 1.2);
  EXPECT_GT(cost.high, 1.2);
  EXPECT_LT(cost.high - cost.low, 0.05);
}

TEST(VersionCost, DecidesOnTheGoalByTheWholeInterval) {
  EXPECT_EQ(goal(cost_of(noisy_times(1e-3, 3), noisy_times(1e-3, 4))), Goal::met);
  EXPECT_EQ(goal(cost_of(noisy_times(1.1e-3, 3), noisy_times(1e-3, 4))), Goal::missed);
  EXPECT_EQ(goal(cost_of(noisy_times(1.05e-3, 3), noisy_times(1e-3, 4))), Goal::undecided);
  EXPECT_EQ(goal({1.2, 1.1, 1.3}, 1.3), Goal::met) << "the goal is an argument";
}

}  // namespace
}  // namespace drogue::perf
