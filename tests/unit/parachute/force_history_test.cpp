#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "miniapps/parachute/verify/force_history.hpp"

// Mean and frequency of a force in the rows of a history.

namespace drogue::parachute_app {
namespace {

struct Rows {
  std::vector<double> time, value;
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

TEST(ForceHistory, MeasuresMeanAndFrequencyAfterTheTransient) {
  const Rows rows = oscillation();
  EXPECT_NEAR(mean_from(rows.time, rows.value, 10.0), 2.0, 2e-3);
  EXPECT_NEAR(frequency_from(rows.time, rows.value, 10.0), 0.8, 1e-4);
  EXPECT_GT(mean_from(rows.time, rows.value, 0.0), 20.0);
}

TEST(ForceHistory, AmplitudeIsHalfOfTheRange) {
  const Rows rows = oscillation();
  EXPECT_NEAR(amplitude_from(rows.time, rows.value, 10.0), 1.0, 1e-3);
  EXPECT_GT(amplitude_from(rows.time, rows.value, 9.0), 50.0);
  EXPECT_TRUE(std::isnan(amplitude_from(rows.time, rows.value, 40.0)));
}

TEST(ForceHistory, AmplitudeDependsLittleOnTheRows) {
  // Nine rows in a period, of different distances, of which the largest alone misses up to 6 %.
  for (const double phase : {0.0, 0.1, 0.2, 0.3}) {
    std::vector<double> time, value;
    for (int k = 0; k < 9; ++k) {
      time.push_back((k + phase + 0.2 * (k % 2)) / 9.0);
      value.push_back(3.0 + std::sin(2.0 * std::numbers::pi * time.back()));
    }
    EXPECT_NEAR(amplitude_from(time, value, 0.0), 1.0, 0.015) << phase;
  }
  EXPECT_EQ(amplitude_from({0.0, 1.0, 2.0}, {1.0, 2.0, 3.0}, 0.0), 1.0) << "extremes at the ends";
  EXPECT_EQ(amplitude_from({0.0, 1.0, 2.0, 3.0}, {1.0, 1.0, 1.0, 1.0}, 0.0), 0.0);
}

TEST(ForceHistory, CountsRows) {
  const std::vector<double> time = {0.0, 0.5, 1.0, 1.5, 2.0};
  EXPECT_EQ(rows_from(time, 0.6), 3U);
  EXPECT_EQ(rows_from(time, 3.0), 0U);
  EXPECT_DOUBLE_EQ(rows_in_period(time, 0.0, 0.5), 4.0);
  EXPECT_EQ(rows_in_period(time, 2.0, 0.5), 0.0);
}

TEST(ForceHistory, ReportsNoValueForTooFewRows) {
  const Rows rows = oscillation();
  EXPECT_TRUE(std::isnan(mean_from(rows.time, rows.value, 39.995)));
  EXPECT_TRUE(std::isnan(frequency_from(rows.time, rows.value, 38.0)));
  EXPECT_TRUE(std::isnan(mean_from({}, {}, 0.0)));
}

}  // namespace
}  // namespace drogue::parachute_app
