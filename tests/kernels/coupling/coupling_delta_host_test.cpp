#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/coupling/delta_function.hpp"
#include "kernels/device/dual.hpp"
#include "kernels/reference/coupling/grid_transfer.hpp"

// One-dimensional delta functions against their definitions and moment conditions.

namespace drogue::coupling {
namespace {

constexpr int trials = 1000;
constexpr double round_off = 4e-16;

/// Calls `check(s, base, w)` with random positions s, the base and the weights there.
template <class Spline, class Check>
void for_random_positions(const Check& check) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform(-5.0, 5.0);
  for (int n = 0; n < trials; ++n) {
    const double s = n == 0 ? 0.0 : n == 1 ? 0.5 : uniform(engine);
    const double base = std::floor(Spline::centred ? s + 0.5 : s);
    double w[Spline::points];
    Spline::weights(s - base, w);
    check(s, base - Spline::lead, w);
  }
}

/// Sum of w (sample - s)^power.
template <int points>
double moment(double s, double first, const double (&w)[points], int power) {
  double sum = 0.0;
  for (int k = 0; k < points; ++k) sum += w[k] * std::pow(first + k - s, power);
  return sum;
}

template <class Spline>
void expect_weights(double (*function)(double)) {
  for_random_positions<Spline>([&](double s, double first, const auto& w) {
    for (int k = 0; k < Spline::points; ++k) EXPECT_NEAR(w[k], function(first + k - s), round_off) << s;
    // No sample outside of the weights is left out.
    EXPECT_NEAR(function(first - 1.0 - s), 0.0, round_off);
    EXPECT_NEAR(function(first + Spline::points - s), 0.0, round_off);
  });
}

template <class Spline>
void expect_unit_sum_without_first_moment() {
  for_random_positions<Spline>([](double s, double first, const auto& w) {
    EXPECT_NEAR(moment(s, first, w, 0), 1.0, round_off) << s;
    EXPECT_NEAR(moment(s, first, w, 1), 0.0, 2.0 * round_off) << s;
    for (const double weight : w) EXPECT_GE(weight, -1e-17) << s;
  });
}

/// Derivative of the function along a component is the difference of the function across it: the condition
/// for divergence-free interpolation.
template <class Along, class Across>
void expect_difference_derivative(double (*across)(double)) {
  for_random_positions<Along>([&](double s, double first, const auto&) {
    device::Dual w[Along::points];
    Along::weights(device::Dual(s - (first + Along::lead), 1.0), w);
    for (int k = 0; k < Along::points; ++k) {
      const double x = first + k - s;
      EXPECT_NEAR(w[k].derivative, across(x - 0.5) - across(x + 0.5), 8.0 * round_off) << s;
    }
  });
  static_assert(Along::points == Across::points + 1);
}

double linear(double x) { return reference::b_spline(2, x); }
double quadratic(double x) { return reference::b_spline(3, x); }
double cubic(double x) { return reference::b_spline(4, x); }

TEST(ReferenceDelta, HasKnownValues) {
  EXPECT_DOUBLE_EQ(linear(0.25), 0.75);
  EXPECT_DOUBLE_EQ(quadratic(0.0), 3.0 / 4.0);
  EXPECT_DOUBLE_EQ(quadratic(1.0), 1.0 / 8.0);
  EXPECT_DOUBLE_EQ(cubic(0.0), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(cubic(-1.0), 1.0 / 6.0);
  EXPECT_EQ(cubic(2.0), 0.0);
  EXPECT_DOUBLE_EQ(reference::peskin_four_point(0.0), 0.5);
  EXPECT_DOUBLE_EQ(reference::peskin_four_point(1.0), 0.25);
  EXPECT_DOUBLE_EQ(reference::peskin_four_point(2.0), 0.0);
}

TEST(DeltaFunction, WeightsMatchTheDefinitions) {
  expect_weights<LinearSpline>(linear);
  expect_weights<QuadraticSpline>(quadratic);
  expect_weights<CubicSpline>(cubic);
  expect_weights<PeskinFourPoint>(reference::peskin_four_point);
}

TEST(DeltaFunction, WeightsAreNonNegativeWithUnitSumAndNoFirstMoment) {
  expect_unit_sum_without_first_moment<LinearSpline>();
  expect_unit_sum_without_first_moment<QuadraticSpline>();
  expect_unit_sum_without_first_moment<CubicSpline>();
  expect_unit_sum_without_first_moment<PeskinFourPoint>();
}

TEST(DeltaFunction, HigherMomentsDoNotDependOnThePosition) {
  for_random_positions<QuadraticSpline>([](double s, double first, const auto& w) {
    EXPECT_NEAR(moment(s, first, w, 2), 1.0 / 4.0, round_off) << s;
  });
  for_random_positions<CubicSpline>([](double s, double first, const auto& w) {
    EXPECT_NEAR(moment(s, first, w, 2), 1.0 / 3.0, 2.0 * round_off) << s;
    EXPECT_NEAR(moment(s, first, w, 3), 0.0, 8.0 * round_off) << s;
  });
}

TEST(DeltaFunction, FourPointFunctionBalancesEvenAndOddSamples) {
  for_random_positions<PeskinFourPoint>([](double s, double, const auto& w) {
    EXPECT_NEAR(w[0] + w[2], 0.5, round_off) << s;
    EXPECT_NEAR(w[1] + w[3], 0.5, round_off) << s;
    EXPECT_NEAR(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3], 3.0 / 8.0, round_off) << s;
  });
}

TEST(DeltaFunction, DerivativeAlongIsTheDifferenceAcross) {
  using Wide = DeltaFactors<DeltaFunction::cbs43>;
  using Narrow = DeltaFactors<DeltaFunction::cbs32>;
  expect_difference_derivative<Wide::Along, Wide::Across>(quadratic);
  expect_difference_derivative<Narrow::Along, Narrow::Across>(linear);
}

}  // namespace
}  // namespace drogue::coupling
