#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "miniapps/framework/history_checks.hpp"

namespace drogue::framework {
namespace {

using run::Statistic;

/// Rows every 0.05 s from `begin`, s, to 10 s: a wave of 0.5 Hz about 2, and a rise.
run::History history_from(double begin) {
  run::History history;
  for (int k = 0; k <= 200; ++k) {
    const double t = 0.05 * k;
    if (t < begin) continue;
    history["time"].push_back(t);
    history["wave"].push_back(2.0 + std::sin(std::numbers::pi * t));
    history["rise"].push_back(t);
  }
  return history;
}

run::ResultDocument result_of(const std::vector<HistoryCheck>& checks, const run::History& history) {
  run::ResultDocument result;
  add_history_checks(checks, history, result);
  return result;
}

/// Measured quantity of one check.
double measured(const HistoryCheck& check, const run::History& history) {
  return result_of({check}, history).checks.at(0).measurement->value;
}

TEST(HistoryChecks, CompareTheQuotientOfStatisticAndReference) {
  const run::ResultDocument result = result_of(
      {{"rise", Statistic::mean, 2.0, 4.0, 2.0, 1.4, 0.1}, {"rise", Statistic::max, 0.0, {}, 1.0, 8.0, 0.2}},
      history_from(0.0));
  ASSERT_EQ(result.checks.size(), 2U);
  EXPECT_EQ(result.checks[0].name, "rise_mean");
  EXPECT_NEAR(result.checks[0].measurement->value, 1.5, 1e-12);
  EXPECT_NEAR(result.checks[0].value, 1.5 / 1.4 - 1.0, 1e-12);
  EXPECT_TRUE(result.checks[0].passed);
  EXPECT_EQ(result.checks[0].rows, 41);
  EXPECT_EQ(result.checks[1].name, "rise_max");
  EXPECT_NEAR(result.checks[1].value, 0.25, 1e-12);
  EXPECT_FALSE(result.checks[1].passed);
}

TEST(HistoryChecks, EqualNamesAreNumbered) {
  const HistoryCheck mean = {"rise", Statistic::mean, 0.0, 1.0}, max = {"rise", Statistic::max};
  const run::ResultDocument result = result_of({mean, max, mean, mean}, history_from(0.0));
  std::vector<std::string> names;
  for (const run::Check& check : result.checks) names.push_back(check.name);
  EXPECT_EQ(names, (std::vector<std::string>{"rise_mean", "rise_max", "rise_mean_1", "rise_mean_2"}));
}

TEST(HistoryChecks, DeviationFromZeroIsAbsolute) {
  const run::ResultDocument result = result_of(
      {{"rise", Statistic::min, 3.0, {}, 2.0, 0.0, 1.6}, {"rise", Statistic::last, 0.0, 3.0, 2.0, 0.0, 1.4}},
      history_from(0.0));
  EXPECT_NEAR(result.checks[0].value, 1.5, 1e-12);
  EXPECT_TRUE(result.checks[0].passed);
  EXPECT_NEAR(result.checks[1].value, 1.5, 1e-12);
  EXPECT_FALSE(result.checks[1].passed);
}

TEST(HistoryChecks, MeasureFrequencyAndAmplitude) {
  const run::History history = history_from(0.0);
  EXPECT_NEAR(measured({"wave", Statistic::frequency, 1.0, {}, 0.25}, history), 2.0, 1e-3);
  EXPECT_NEAR(measured({"wave", Statistic::amplitude, 1.0}, history), 1.0, 1e-3);
  EXPECT_TRUE(std::isnan(measured({"wave", Statistic::frequency, 7.0}, history))) << "two crossings";
}

TEST(HistoryChecks, WarnOfFewRows) {
  const run::ResultDocument whole =
      result_of({{"wave", Statistic::frequency}, {"rise", Statistic::last}}, history_from(0.0));
  EXPECT_TRUE(whole.warnings.empty());
  EXPECT_FALSE(whole.checks[1].rows) << "the last value is one row, whatever others there are";
  run::History coarse;
  for (const auto& [name, values] : history_from(0.0))
    for (std::size_t k = 0; k < values.size(); k += 6) coarse[name].push_back(values[k]);
  const run::ResultDocument few = result_of(
      {{"wave", Statistic::frequency}, {"wave", Statistic::amplitude}, {"rise", Statistic::max, 9.0}},
      coarse);
  ASSERT_EQ(few.warnings.size(), 3U);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NE(few.warnings[k].find("6.7 rows of history.csv in a period"), std::string::npos);
  EXPECT_NE(few.warnings[2].find("computed from 4 rows"), std::string::npos);
}

TEST(HistoryChecks, LastValueOfAnIntervalIsThatAtItsEnd) {
  const run::History sparse = {{"time", {0.0, 4.0, 10.0}}, {"rise", {0.0, 4.0, 10.0}}};
  const run::ResultDocument result =
      result_of({{"rise", Statistic::last, 0.0, 3.0, 1.0, 3.0, 1e-12}}, sparse);
  EXPECT_TRUE(result.checks[0].passed) << result.checks[0].measurement->value;
  EXPECT_EQ(result.checks[0].rows, 1);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_NE(result.warnings[0].find("computed from 1 row of"), std::string::npos);
}

TEST(HistoryChecks, NeedTheHistoryFromTheBeginOfTheirInterval) {
  const run::History late = history_from(2.0);
  EXPECT_TRUE(std::isnan(measured({"rise", Statistic::mean, 1.0}, late)));
  EXPECT_TRUE(std::isnan(measured({"rise", Statistic::max, 1.0}, late)));
  EXPECT_NEAR(measured({"rise", Statistic::mean, 2.0}, late), 6.0, 1e-12);
  EXPECT_NEAR(measured({"rise", Statistic::last}, late), 10.0, 1e-12);
}

}  // namespace
}  // namespace drogue::framework
