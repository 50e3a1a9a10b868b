#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "kernels/flow/boundary/side_motion.hpp"
#include "kernels/stepping/motion_steps.hpp"
#include "tests/support/expression_program.hpp"

// Bounds of dt from prescribed motion, known before a run.

namespace drogue::flow {
namespace {

using stepping::MotionInterval;
using testing::postfix;

/// Division for a velocity over a cell width, 1/s.
std::vector<MotionInterval> divided(const std::function<double(double)>& speed, double end,
                                    const std::vector<double>& times = {}) {
  stepping::PrescribedMotion motion;
  motion.values = 1;
  motion.evaluate = [&](double time, std::span<double> values) { values[0] = speed(time); };
  motion.rate = [](double, std::span<const double>, std::span<const double> after) {
    return std::abs(after[0]);
  };
  motion.times = times;
  return stepping::motion_intervals(motion, end);
}

/// Steps until `end`, each as long as the intervals and `longest` admit; `visit` has begin and end of each.
int steps_until(const std::vector<MotionInterval>& intervals, double end, double longest, double cfl,
                const std::function<void(double, double)>& visit) {
  double time = 0.0;
  int steps = 0;
  while (time < end && steps < 100000) {
    const auto bound = stepping::bound_by_motion(intervals.data(), static_cast<int>(intervals.size()), time,
                                                 std::min(longest, end - time), cfl);
    const double next = bound.jump < time + bound.dt ? bound.jump : time + bound.dt;
    visit(time, next);
    time = next;
    ++steps;
  }
  return steps;
}

TEST(FlowMotion, ResolvesAnySine) {
  for (const double periods : {0.5, 3.0, 50.0, 256.0, 512.0, 1000.0, 1024.0})
    for (const double mean : {0.0, 30.0}) {
      const auto intervals = divided(
          [&](double t) { return mean + 1e-3 * std::sin(2.0 * std::numbers::pi * periods * t / 7.0); }, 7.0);
      const int steps = steps_until(intervals, 7.0, 7.0, 1e3, [](double, double) {});
      EXPECT_GE(steps, 16.0 * periods) << periods;
      EXPECT_LE(steps, 40.0 * periods + 2.0) << periods;
    }
}

TEST(FlowMotion, StepsEndJustBeforeAJumpAndAreBoundByTheSpeedAfterIt) {
  for (const double place : {1.0, 0.3, 2.7182818, 3.9999})
    for (const auto& [before, after] : {std::pair{0.0, 50.0}, std::pair{50.0, 0.0}, std::pair{1.0, -80.0}}) {
      const auto speed = [&, before = before, after = after](double t) { return t < place ? before : after; };
      const auto intervals = divided(speed, 4.0);
      bool met = false;
      steps_until(intervals, 4.0, 4.0, 0.5, [&](double begin, double end) {
        const double fastest = std::max(std::abs(speed(begin)), std::abs(speed(end)));
        if (begin < place * (1.0 - 1e-14)) {
          EXPECT_LT(end, place);
        }
        if (begin >= place * (1.0 - 1e-14)) {
          EXPECT_LE((end - begin) * fastest, 0.5 * (1.0 + 1e-12));
        }
        met = met || std::abs(end - place) < 1e-14 * place;
      });
      EXPECT_TRUE(met) << place;
    }
}

TEST(FlowMotion, StepsEndWhereMotionBeginsAfterRest) {
  const auto intervals = divided([](double t) { return t < 0.3 ? 0.0 : 0.2 * (t - 0.3); }, 1.0, {0.3});
  const auto count = static_cast<int>(intervals.size());
  std::vector<double> begins;
  for (const MotionInterval& interval : intervals)
    if (interval.begins_with != 0) begins.push_back(interval.begin);
  ASSERT_EQ(begins, std::vector<double>{0.3});
  const auto bound = [&](double time, double dt) {
    return stepping::bound_by_motion(intervals.data(), count, time, dt, 1e3);
  };
  EXPECT_EQ(bound(0.1, 0.5).jump, 0.3);
  EXPECT_FALSE(bound(0.1, 0.5).follows_jump);
  for (const double time : {0.3 * (1.0 - 1e-15), 0.3, 0.3 * (1.0 + 1e-15)}) {
    EXPECT_TRUE(bound(time, 0.5).follows_jump) << time;
    EXPECT_GT(bound(time, 0.5).jump, 1.0) << time;
  }
  EXPECT_FALSE(bound(0.31, 0.5).follows_jump);
}

TEST(FlowMotion, HasTheValuesBeforeAJumpAtItsTime) {
  const auto intervals = divided([](double t) { return t < 1.0 ? 0.0 : 1.0; }, 4.0, {1.0});
  const auto count = static_cast<int>(intervals.size());
  const auto before = [&](double time) { return stepping::time_before_jump(intervals.data(), count, time); };
  for (const double time : {std::nextafter(1.0, 0.0), 1.0, 1.0 + 1e-13}) {
    EXPECT_LT(before(time), 1.0);
    EXPECT_NEAR(before(time), 1.0, 1e-14);
  }
  for (const double time : {0.0, 0.5, 1.0 + 1e-11, 3.0}) EXPECT_EQ(before(time), time);
  EXPECT_EQ(stepping::time_before_jump(nullptr, 0, 1.0), 1.0);
}

TEST(FlowMotion, DividesThePulseBetweenTwoJumps) {
  const auto intervals = divided([](double t) { return t > 1.0 && t < 1.25 ? 1.0 : 0.0; }, 4.0, {1.0, 1.25});
  const int steps = steps_until(intervals, 4.0, 4.0, 1e3, [](double begin, double end) {
    if (begin > 0.99 && begin < 1.249) {
      EXPECT_LE(end - begin, 0.25 / 19.0);
    }
  });
  EXPECT_LT(steps, 28);
}

TEST(FlowMotion, FindsAShortPulseByTheConstantsOfItsExpression) {
  // A ten-thousandth of the run.
  const auto pulse = [](double t) { return t > 1.23 && t < 1.2304 ? 9.0 : 0.0; };
  const auto intervals = divided(pulse, 4.0, {1.23, 1.2304});
  EXPECT_EQ(std::ranges::count_if(intervals, [](const MotionInterval& i) { return i.begins_with != 0; }), 2);
  const auto gauss = divided([](double t) { return std::exp(-std::pow((t - 2.1) / 1e-5, 2)); }, 4.0, {2.1});
  const int steps = steps_until(gauss, 4.0, 4.0, 1e3, [](double, double) {});
  EXPECT_GT(steps, 20);
  EXPECT_LT(steps, 200);
}

TEST(FlowMotion, NoStepIsBlindToWhatMovesWithinIt) {
  const auto ramp = [](double t) { return 20.0 * std::tanh(1e4 * (t - 1.0)) + 20.0; };
  const auto intervals = divided(ramp, 2.0);
  steps_until(intervals, 2.0, 2.0, 0.5, [&](double begin, double end) {
    EXPECT_LE((end - begin) * std::max(ramp(begin), ramp(end)), 0.75) << begin;
  });
}

TEST(FlowMotion, LaterEndChangesNoIntervalBefore) {
  const auto speed = [](double t) { return 0.05 * std::sin(20.0 * t); };
  const auto first = divided(speed, 0.15), second = divided(speed, 0.7);
  std::size_t same = 0;
  while (first[same].begin == second[same].begin && first[same].longest == second[same].longest) ++same;
  EXPECT_GT(first[same].begin, 0.15);
}

TEST(FlowMotion, RestAndEvenMotionHaveOneStep) {
  EXPECT_EQ(steps_until(divided([](double) { return 3.0; }, 5.0), 5.0, 5.0, 100.0, [](double, double) {}), 1);
  EXPECT_EQ(steps_until(divided([](double t) { return t; }, 5.0), 5.0, 5.0, 100.0, [](double, double) {}), 1);
  EXPECT_EQ(divided([](double) { return std::nan(""); }, 5.0).size(), 1U);
}

TEST(FlowMotion, MergedIntervalsHoldForBoth) {
  const std::vector<MotionInterval> a = {{0.0, 4.0, 1.0, 0}, {2.0, 0.5, 3.0, 1}},
                                    b = {{0.0, 1.0, 2.0, 0}, {1.0, 3.0, 0.0, 0}, {2.0, 2.0, 1.0, 0}};
  const auto both = stepping::merged(a, b);
  ASSERT_EQ(both.size(), 3U);
  EXPECT_EQ(both[0].longest, 1.0);
  EXPECT_EQ(both[0].rate, 2.0);
  EXPECT_EQ(both[1].begin, 1.0);
  EXPECT_EQ(both[1].longest, 3.0);
  EXPECT_EQ(both[2].longest, 0.5);
  EXPECT_EQ(both[2].rate, 3.0);
  EXPECT_EQ(both[2].begins_with, 1);
}

TEST(FlowMotion, MotionOfSidesCountsAllComponentsAndUnitsScale) {
  Parameters p;
  p.cells = {8, 16, 4};
  p.boundary[2].kind = p.boundary[3].kind = BoundaryKind::wall;
  p.boundary[2].velocity_expressions = {postfix({"t", 6.0, "*", "sin", "x", "*"}), postfix({0.0}),
                                        postfix({"t", 2.0, "*"})};
  EXPECT_TRUE(side_motion(p).empty());  // no horizon
  p.horizon = 3.0;
  const auto intervals = side_motion(p);
  ASSERT_GT(intervals.size(), 45U);
  double rate = 0.0;
  for (const MotionInterval& interval : intervals) rate = std::max(rate, interval.rate);
  EXPECT_GT(rate, 28.0);
  EXPECT_LT(rate, 8.0 + 4.0 * 8.0);  // the division ends at 4 s
  // Twice the domain at the same speeds.
  p.high = {2.0, 2.0, 2.0};
  p.boundary[2].velocity_expressions[0] = postfix({"t", 6.0, "*", "sin", "x", "*", 2.0, "/"});
  const auto wide = side_motion(p);
  ASSERT_EQ(wide.size(), intervals.size());
  for (std::size_t i = 0; i < wide.size(); ++i) EXPECT_NEAR(wide[i].rate, 0.5 * intervals[i].rate, 1e-12);
}

}  // namespace
}  // namespace drogue::flow
