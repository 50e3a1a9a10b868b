#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernels/coupling/sheet/vertex_motion.hpp"
#include "kernels/device/expression.hpp"
#include "kernels/stepping/expression_steps.hpp"
#include "kernels/stepping/motion_jet.hpp"
#include "kernels/stepping/motion_steps.hpp"
#include "tests/support/coupled_case.hpp"
#include "tests/support/expression_program.hpp"

// Steps that resolve the prescribed motion of a sheet, and its derivatives.

namespace drogue::coupling {
namespace {

using device::ExpressionProgram;
using stepping::motion_jet;
using stepping::MotionInterval;
using testing::CoupledCase;
using testing::postfix;

constexpr std::array<double, 3> place = {0.3, 0.7, -0.4};

/// Compares a jet at several times with differences of the value.
void expect_derivatives(const ExpressionProgram& program, const std::string& name) {
  const auto at = [&](double t) { return device::evaluate(program, place[0], place[1], place[2], t); };
  constexpr double h = 1e-4;
  for (const double t : {0.17, 0.42, 0.83}) {
    const stepping::MotionJet jet = motion_jet(program, place, t);
    EXPECT_NEAR(jet.value, at(t), 1e-14 * std::abs(at(t))) << name;
    const double rate = (at(t + h) - at(t - h)) / (2.0 * h),
                 acceleration = (at(t + h) - 2.0 * at(t) + at(t - h)) / (h * h);
    EXPECT_NEAR(jet.rate, rate, 1e-6 * std::max(1.0, std::abs(rate))) << name << " at " << t;
    EXPECT_NEAR(jet.acceleration, acceleration, 1e-5 * std::max(1.0, std::abs(acceleration)))
        << name << " at " << t;
  }
}

TEST(MotionJet, DerivesEveryFunction) {
  for (const char* name :
       {"sin", "cos", "tan", "asin", "acos",  "atan", "sinh", "cosh", "tanh", "asinh", "atanh",
        "exp", "log", "ln",  "log2", "log10", "sqrt", "abs",  "sign", "rint", "floor", "negate"})
    expect_derivatives(postfix({0.1, 0.7, "t", "*", 0.2, "t", "t", "*", "*", "+", "+", name}), name);
  expect_derivatives(postfix({1.5, "t", "t", "*", "+", "acosh"}), "acosh");
}

TEST(MotionJet, DerivesEveryOperator) {
  for (const char* name :
       {"+", "-", "*", "/", "^", "atan2", "min", "max", "<", ">=", "==", "!=", "&&", "||"}) {
    expect_derivatives(postfix({1.2, "t", "t", "*", "+", 0.4, "t", "sin", "+", name}), name);
    expect_derivatives(postfix({"x", "t", "+", 3.0, name}), name);
    expect_derivatives(postfix({3.0, "y", "t", "+", name}), name);
  }
  expect_derivatives(postfix({2.0, 5.0, "t", "*", "besselj"}), "besselj");
  expect_derivatives(postfix({"t", 0.5, "<", "t", "sin", "t", "cos", "select"}), "select");
}

TEST(MotionJet, KeepsDerivativesOfConstantsZero) {
  // Their functions have none there.
  for (const auto& program : {postfix({0.0, "sqrt", "t", "+"}), postfix({0.0, "abs", "t", "+"}),
                              postfix({"t", 1.0, 0.0, "^", "*"}), postfix({"t", 0.0, 2.0, "^", "+"})}) {
    const stepping::MotionJet jet = motion_jet(program, place, 0.5);
    EXPECT_EQ(jet.rate, 1.0);
    EXPECT_EQ(jet.acceleration, 0.0);
  }
}

/// Steps of a motion in a run, each as long as `vertex_motion` admits.
int steps_of(const ExpressionProgram& displacement, double end) {
  CoupledCase c(16, 4, 0.1, 0.0);
  c.add_strip(0.83, 0.0, 0.83, 0.4, 8);
  c.p.flow.horizon = end;
  std::vector<int> all(c.x.size());
  std::iota(all.begin(), all.end(), 0);
  c.p.fabric.motions.push_back({0, all, displacement});
  const std::vector<MotionInterval> intervals = vertex_motion(c.p);
  double time = 0.0;
  int steps = 0;
  for (; time < end && steps < 1000000; ++steps) {
    const auto bound = stepping::bound_by_motion(intervals.data(), static_cast<int>(intervals.size()), time,
                                                 end - time, 1e6);
    time = bound.jump < time + bound.dt ? bound.jump : time + bound.dt;
  }
  return steps;
}

TEST(VertexMotion, ResolvesTheAccelerationOfASmallFastPart) {
  const double pi = std::acos(-1.0);
  const auto slow = postfix({0.05, 1.0, 2.0 * pi, "t", "*", "cos", "-", "*"});
  const auto both =
      postfix({0.05, 1.0, 2.0 * pi, "t", "*", "cos", "-", "*", 1e-4, 100.0 * pi, "t", "*", "sin", "*", "+"});
  EXPECT_LE(steps_of(slow, 0.2), 40);
  // A hundred steps in each of ten periods.
  EXPECT_GE(steps_of(both, 0.2), 800);
  EXPECT_LE(steps_of(both, 0.2), 1600);
}

TEST(VertexMotion, TakesASineWithAHundredStepsAPeriod) {
  const int steps = steps_of(postfix({0.01, 20.0, "t", "*", "sin", "*"}), 2.0 * std::acos(-1.0));
  EXPECT_GE(steps, 20 * 80);
  EXPECT_LE(steps, 20 * 160);
}

TEST(VertexMotion, KinksAndDerivativesWithoutLimitTakeFewSteps) {
  EXPECT_LE(steps_of(postfix({"t", 0.37, "min"}), 1.0), 20) << "a ramp that ends";
  EXPECT_LE(steps_of(postfix({10.0, "t", "*", "sin", "abs"}), 1.0), 600) << "kinks between the constants";
  EXPECT_LE(steps_of(postfix({0.01, "t", 1.5, "^", "*"}), 1.0), 1000) << "infinite acceleration at the start";
  EXPECT_LE(steps_of(postfix({0.01, 1.0, "t", "-", "abs", 1.5, "^", "*"}), 1.0), 1000);
  EXPECT_LE(steps_of(postfix({"t", "exp", "log", "t", "+"}), 1.0), 10) << "acceleration of round-off alone";
}

TEST(ExpressionSteps, BoundAStepByWhatChangesWithinIt) {
  const std::array<double, 3> places[] = {place};
  const auto pulse = postfix({"t", 5.05, "-", 0.01, "/", 2.0, "^", "negate", "exp"});
  const auto intervals = stepping::expression_intervals(pulse, places, 10.0);
  EXPECT_GT(stepping::shortest_interval(intervals, 0.0, 4.0), 0.1);
  EXPECT_LT(stepping::shortest_interval(intervals, 0.0, 10.0), 0.005);
  EXPECT_GT(stepping::shortest_interval(intervals, 0.0, 10.0), 1e-4);
  EXPECT_EQ(stepping::shortest_interval({}, 0.0, 1.0), std::numeric_limits<double>::infinity());
  const auto sine = stepping::expression_intervals(postfix({31.4159, "t", "*", "sin"}), places, 10.0);
  EXPECT_NEAR(stepping::shortest_interval(sine, 0.0, 10.0), 0.2 / 20.0, 0.005);
  const auto square =
      stepping::expression_intervals(postfix({"t", 5.0, ">", "t", 5.1, "<", "&&", 3.0, "*"}), places, 10.0);
  EXPECT_NEAR(stepping::shortest_interval(square, 0.0, 10.0), 0.1 / 20.0, 1e-9);
  EXPECT_GT(stepping::shortest_interval(square, 0.0, 4.99), 1.0) << "before the first jump";
  const auto noise = stepping::expression_intervals(postfix({1e15, "t", "*", "sin"}), places, 0.01);
  EXPECT_LT(stepping::shortest_interval(noise, 0.0, 0.01), 1e-11);
}

}  // namespace
}  // namespace drogue::coupling
