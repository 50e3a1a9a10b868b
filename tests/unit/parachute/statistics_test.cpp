#include "miniapps/parachute/verify/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace drogue::parachute_app {
namespace {

flow::Totals at(std::int64_t step, double time, double energy, double speed) {
  flow::Totals totals;
  totals.step = step;
  totals.time = time;
  totals.kinetic_energy = energy;
  totals.max_speed = speed;
  return totals;
}

TEST(RunStatistics, FindsTheLargestRiseOfEnergyAndSpeed) {
  RunStatistics statistics;
  statistics.begin(at(0, 0.0, 2.0, 1.0));
  statistics.add(at(1, 0.1, 1.5, 1.5));
  statistics.add(at(2, 0.2, 1.7, 1.1));
  statistics.add(at(3, 0.3, 1.75, 1.2));
  EXPECT_NEAR(statistics.energy_growth(), 0.1, 1e-15);
  EXPECT_EQ(statistics.speed_growth(), 0.5);
}

TEST(RunStatistics, FallingEnergyIsNoGrowth) {
  RunStatistics statistics;
  statistics.begin(at(0, 0.0, 2.0, 1.0));
  statistics.add(at(1, 0.1, 1.9, 0.9));
  EXPECT_EQ(statistics.energy_growth(), 0.0);
  EXPECT_EQ(statistics.speed_growth(), 0.0);
}

TEST(RunStatistics, FluidAtRestHasNoGrowthUnlessItMoves) {
  RunStatistics rest, moved;
  for (RunStatistics* statistics : {&rest, &moved}) statistics->begin(at(0, 0.0, 0.0, 0.0));
  rest.add(at(1, 0.1, 0.0, 0.0));
  EXPECT_EQ(rest.energy_growth(), 0.0);
  EXPECT_EQ(rest.speed_growth(), 0.0);
  EXPECT_EQ(rest.momentum_change(at(1, 0.1, 0.0, 0.0), 2.0), 0.0);
  flow::Totals after = at(1, 0.1, 1.0, 1.0);
  after.momentum[1] = 1.0;
  moved.add(after);
  EXPECT_EQ(moved.energy_growth(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(moved.speed_growth(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(moved.momentum_change(after, 2.0), std::numeric_limits<double>::infinity());
}

TEST(RunStatistics, FindsThePeakOfDissipation) {
  RunStatistics statistics;
  statistics.begin(at(0, 0.0, 2.0, 1.0));
  statistics.add(at(5, 1.0, 1.9, 1.0));
  statistics.add(at(10, 1.5, 1.6, 1.0));
  statistics.add(at(15, 2.5, 1.5, 1.0));
  EXPECT_NEAR(statistics.peak_dissipation(), 0.6, 1e-14);
  EXPECT_EQ(statistics.peak_time(), 1.25);
}

TEST(RunStatistics, IgnoresRepeatedRows) {
  RunStatistics statistics;
  statistics.begin(at(0, 0.0, 2.0, 1.0));
  statistics.add(at(5, 1.0, 1.9, 1.0));
  statistics.add(at(5, 1.0, 5.0, 1.0));
  EXPECT_EQ(statistics.energy_growth(), 0.0);
}

TEST(RunStatistics, NonFiniteEnergyFailsEveryTolerance) {
  RunStatistics statistics;
  statistics.begin(at(0, 0.0, 2.0, 1.0));
  statistics.add(at(1, 0.1, std::numeric_limits<double>::quiet_NaN(), 1.0));
  statistics.add(at(2, 0.2, 1.9, 1.0));
  statistics.add(at(3, 0.3, 1.8, 1.0));
  EXPECT_FALSE(std::abs(statistics.energy_growth()) <= 1e300);
  EXPECT_FALSE(std::abs(statistics.peak_dissipation()) <= 1e300);
}

TEST(RunStatistics, MeasuresTheChangeOfMomentum) {
  RunStatistics statistics;
  flow::Totals totals = at(0, 0.0, 2.0, 1.0);
  totals.momentum[1] = 1.0;
  statistics.begin(totals);
  totals.momentum[1] = 1.5;
  EXPECT_DOUBLE_EQ(statistics.momentum_change(totals, 4.0), 0.5 / std::sqrt(2.0 * 4.0 * 2.0));
}

}  // namespace
}  // namespace drogue::parachute_app
