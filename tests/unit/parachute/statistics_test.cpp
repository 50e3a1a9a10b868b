#include "miniapps/parachute/verify/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace drogue::parachute_app {
namespace {

flow::Totals at_start(double energy, double speed) {
  flow::Totals totals;
  totals.kinetic_energy = energy;
  totals.max_speed = speed;
  return totals;
}

TEST(RunStatistics, GrowthIsRelativeToTheStart) {
  RunStatistics statistics(true);
  statistics.begin(at_start(2.0, 1.0));
  flow::Extremes extremes;
  extremes.largest_rise = 0.2;
  extremes.largest_speed = 1.5;
  statistics.update(extremes);
  EXPECT_EQ(statistics.energy_growth(), 0.1);
  EXPECT_EQ(statistics.speed_growth(), 0.5);
}

TEST(RunStatistics, FluidAtRestHasNoGrowthUnlessItMoves) {
  RunStatistics rest(true), moved(true);
  for (RunStatistics* statistics : {&rest, &moved}) statistics->begin(at_start(0.0, 0.0));
  EXPECT_EQ(rest.energy_growth(), 0.0);
  EXPECT_EQ(rest.speed_growth(), 0.0);
  EXPECT_EQ(rest.momentum_change(at_start(0.0, 0.0), 2.0), 0.0);
  flow::Extremes extremes;
  extremes.largest_rise = extremes.largest_speed = 1.0;
  moved.update(extremes);
  flow::Totals after = at_start(1.0, 1.0);
  after.momentum[1] = 1.0;
  EXPECT_EQ(moved.energy_growth(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(moved.speed_growth(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(moved.momentum_change(after, 2.0), std::numeric_limits<double>::infinity());
}

TEST(RunStatistics, MeasuresTheChangeOfMomentum) {
  RunStatistics statistics(false);
  flow::Totals totals = at_start(2.0, 1.0);
  totals.momentum[1] = 1.0;
  statistics.begin(totals);
  totals.momentum[1] = 1.5;
  EXPECT_DOUBLE_EQ(statistics.momentum_change(totals, 4.0), 0.5 / std::sqrt(2.0 * 4.0 * 2.0));
}

}  // namespace
}  // namespace drogue::parachute_app
