#include "common/run/history_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace drogue::run {
namespace {

struct Rows {
  std::vector<double> time, value;

  [[nodiscard]] HistoryRows from(double from, double to = 1e9) const {
    return rows_between({time, value}, from, to);
  }
  [[nodiscard]] double statistic(Statistic wanted, double from, double to = 1e9) const {
    return statistic_of(wanted, {time, value}, from, to);
  }
};

/// A transient, then a mean of 2 and an oscillation of 0.8 Hz, in rows of unequal distance.
Rows oscillation() {
  Rows rows;
  for (int k = 0; k < 4000; ++k) {
    const double t = 0.01 * k + 0.003 * std::sin(k);
    rows.time.push_back(t);
    rows.value.push_back(2.0 + std::sin(2.0 * std::numbers::pi * 0.8 * t) + (t < 10.0 ? 100.0 : 0.0));
  }
  return rows;
}

TEST(HistoryStatistics, MeasuresMeanAndFrequencyAfterTheTransient) {
  const Rows rows = oscillation();
  EXPECT_NEAR(mean_of(rows.from(10.0)), 2.0, 2e-3);
  EXPECT_NEAR(frequency_of(rows.from(10.0)), 0.8, 1e-4);
  EXPECT_GT(mean_of(rows.from(0.0)), 20.0);
  EXPECT_NEAR(mean_of(rows.from(0.0, 7.5)), 102.0, 2e-2) << "six periods";
}

TEST(HistoryStatistics, AmplitudeIsHalfOfTheRange) {
  const Rows rows = oscillation();
  EXPECT_NEAR(amplitude_of(rows.from(10.0)), 1.0, 1e-3);
  EXPECT_GT(amplitude_of(rows.from(9.0)), 50.0);
  EXPECT_TRUE(std::isnan(amplitude_of(rows.from(40.0))));
}

TEST(HistoryStatistics, AmplitudeDependsLittleOnTheRows) {
  // Nine rows in a period, of different distances, of which the largest alone misses up to 6 %.
  for (const double phase : {0.0, 0.1, 0.2, 0.3}) {
    Rows rows;
    for (int k = 0; k < 9; ++k) {
      rows.time.push_back((k + phase + 0.2 * (k % 2)) / 9.0);
      rows.value.push_back(3.0 + std::sin(2.0 * std::numbers::pi * rows.time.back()));
    }
    EXPECT_NEAR(amplitude_of({rows.time, rows.value}), 1.0, 0.015) << phase;
  }
  const Rows rise = {{0.0, 1.0, 2.0}, {1.0, 2.0, 3.0}}, level = {{0.0, 1.0, 2.0, 3.0}, {1.0, 1.0, 1.0, 1.0}};
  EXPECT_EQ(amplitude_of(rise.from(0.0)), 1.0) << "extremes at the ends";
  EXPECT_EQ(amplitude_of(level.from(0.0)), 0.0);
}

TEST(HistoryStatistics, AmplitudeOfAJumpIsNearlyItsHalf) {
  // The parabola through the three rows around a jump has its vertex an eighth of the jump beyond them.
  const Rows jump = {{0.0, 1.0, 2.0, 3.0, 4.0}, {0.0, 0.0, 1.0, 1.0, 1.0}};
  EXPECT_NEAR(amplitude_of(jump.from(0.0)), 0.5, 0.04);
  EXPECT_TRUE(std::isnan(amplitude_of(jump.from(4.0)))) << "one row has no range";
}

TEST(HistoryStatistics, InterpolatesBetweenRows) {
  const Rows rows = {{1.0, 2.0, 4.0}, {1.0, 3.0, -1.0}};
  EXPECT_TRUE(std::isnan(value_at({rows.time, rows.value}, 0.5)));
  EXPECT_EQ(value_at({rows.time, rows.value}, 1.0), 1.0);
  EXPECT_EQ(value_at({rows.time, rows.value}, 3.5), 0.0);
  EXPECT_EQ(value_at({rows.time, rows.value}, 1e9), -1.0);
}

TEST(HistoryStatistics, MeanCoversTheWholeInterval) {
  const Rows ramp = {{0.0, 1.0, 2.0, 3.0}, {0.0, 1.0, 2.0, 3.0}};
  EXPECT_DOUBLE_EQ(ramp.statistic(Statistic::mean, 0.5, 2.75), 1.625);
  EXPECT_DOUBLE_EQ(ramp.statistic(Statistic::mean, 0.5), 1.75) << "to the last row";
  EXPECT_TRUE(std::isnan(ramp.statistic(Statistic::mean, 0.5, 1.5))) << "one row";
}

TEST(HistoryStatistics, RoundOffMovesNoRowOutOfAnInterval) {
  Rows rows;
  double time = 0.0;
  for (int k = 0; k <= 100; ++k, time += 0.01) {
    rows.time.push_back(time);
    rows.value.push_back(k);
  }
  for (int k = 1; k < 10; ++k) {
    EXPECT_EQ(rows.from(0.1 * k).value.front(), 10.0 * k);
    EXPECT_EQ(rows.from(0.0, 0.1 * k).value.back(), 10.0 * k);
  }
}

TEST(HistoryStatistics, TakesTheRowsOfAnInterval) {
  const Rows rows = {{0.0, 1.0, 3.0, 4.0}, {1e6, 1.0, -3.0, 2.0}};
  // Trapezoids of 2 s and 1 s.
  EXPECT_NEAR(rows.statistic(Statistic::mean, 1.0), (2.0 * -1.0 + 1.0 * -0.5) / 3.0, 1e-15);
  EXPECT_EQ(rows.statistic(Statistic::mean, 1.0, 3.0), -1.0);
  EXPECT_EQ(rows.statistic(Statistic::max, 0.5), 2.0);
  EXPECT_EQ(rows.statistic(Statistic::max, 3.0, 3.5), -3.0);
  EXPECT_EQ(rows.statistic(Statistic::min, 0.0), -3.0);
  EXPECT_EQ(rows.statistic(Statistic::min, 0.0, 2.0), 1.0);
  EXPECT_EQ(rows.statistic(Statistic::last, 0.0), 2.0);
  EXPECT_EQ(rows.statistic(Statistic::last, 0.0, 3.0), -3.0);
  EXPECT_EQ(rows.statistic(Statistic::amplitude, 3.0), 2.5);
  const Rows waves = oscillation();
  EXPECT_EQ(waves.statistic(Statistic::frequency, 10.0), frequency_of(waves.from(10.0)));
}

TEST(HistoryStatistics, CountsRows) {
  const Rows rows = {{0.0, 0.5, 1.0, 1.5, 2.0}, std::vector<double>(5)};
  EXPECT_EQ(rows.from(0.6).time.size(), 3U);
  EXPECT_EQ(rows.from(0.5, 1.0).time.size(), 2U);
  EXPECT_EQ(rows.from(3.0).time.size(), 0U);
  EXPECT_EQ(rows.from(1.0, 0.5).time.size(), 0U);
  EXPECT_DOUBLE_EQ(rows_in_period(rows.from(0.0), 0.5), 4.0);
  EXPECT_EQ(rows_in_period(rows.from(2.0), 0.5), 0.0);
}

TEST(HistoryStatistics, ReportsNoValueForTooFewRows) {
  const Rows rows = oscillation();
  EXPECT_TRUE(std::isnan(mean_of(rows.from(39.995)))) << "one row is no interval";
  EXPECT_TRUE(std::isnan(frequency_of(rows.from(38.0))));
  for (const Statistic statistic : {Statistic::mean, Statistic::max, Statistic::min, Statistic::last,
                                    Statistic::frequency, Statistic::amplitude})
    EXPECT_TRUE(std::isnan(statistic_of(statistic, {}, 0.0, 1.0)));
}

TEST(HistoryStatistics, NanIsNotHidden) {
  const Rows rows = {{0.0, 1.0, 2.0, 3.0}, {1.0, std::nan(""), 3.0, 2.0}};
  for (const Statistic statistic : {Statistic::mean, Statistic::max, Statistic::min, Statistic::frequency})
    EXPECT_TRUE(std::isnan(rows.statistic(statistic, 0.0)));
}

}  // namespace
}  // namespace drogue::run
