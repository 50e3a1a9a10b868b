#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "miniapps/parachute/verify/row_interpolation.hpp"

// Values and derivatives between the rows of a history.

namespace drogue::parachute_app {
namespace {

/// Rows of unequal distance, about `spacing` apart, from 0 to 3.
std::vector<double> times(double spacing) {
  std::vector<double> time = {0.0};
  for (int k = 1; time.back() < 3.0; ++k) time.push_back(spacing * (k + 0.3 * std::sin(k)));
  return time;
}

template <class Function>
std::vector<double> values(const std::vector<double>& time, const Function& function) {
  std::vector<double> value;
  for (const double t : time) value.push_back(function(t));
  return value;
}

TEST(RowInterpolation, IsExactForCubicPolynomials) {
  const std::vector<double> time = times(0.25);
  const std::vector<double> value =
      values(time, [](double t) { return 2.0 - t + 3.0 * t * t - 0.5 * t * t * t; });
  for (const double t : {0.0, 0.1, 1.0, time[5], 2.3, 2.9, 3.0}) {
    const InterpolatedRow found = interpolate_rows(time, value, t);
    EXPECT_NEAR(found.value, 2.0 - t + 3.0 * t * t - 0.5 * t * t * t, 1e-13) << t;
    EXPECT_NEAR(found.derivative, -1.0 + 6.0 * t - 1.5 * t * t, 1e-12) << t;
  }
}

TEST(RowInterpolation, IsOfFourthOrderAndItsDerivativeOfThird) {
  double value_error[2] = {}, derivative_error[2] = {};
  for (const int fine : {0, 1}) {
    const std::vector<double> time = times(fine ? 0.05 : 0.1),
                              value = values(time, [](double t) { return std::sin(2.0 * t); });
    for (int k = 0; k <= 300; ++k) {
      const double t = 0.01 * k;
      const InterpolatedRow found = interpolate_rows(time, value, t);
      value_error[fine] = std::max(value_error[fine], std::abs(found.value - std::sin(2.0 * t)));
      derivative_error[fine] =
          std::max(derivative_error[fine], std::abs(found.derivative - 2.0 * std::cos(2.0 * t)));
    }
  }
  EXPECT_GT(value_error[0] / value_error[1], 12.0);
  EXPECT_GT(derivative_error[0] / derivative_error[1], 6.0);
  EXPECT_LT(value_error[1], 1e-4);
}

TEST(RowInterpolation, ReportsNoValueOutsideOfTheRowsOrForTooFew) {
  const std::vector<double> time = {0.0, 1.0, 2.0, 3.0}, value = {0.0, 1.0, 2.0, 3.0};
  for (const double t : {-1e-9, 3.0 + 1e-9, std::nan("")}) {
    EXPECT_TRUE(std::isnan(interpolate_rows(time, value, t).value)) << t;
    EXPECT_TRUE(std::isnan(interpolate_rows(time, value, t).derivative)) << t;
  }
  EXPECT_EQ(interpolate_rows(time, value, 3.0).value, 3.0);
  EXPECT_TRUE(std::isnan(interpolate_rows({0.0, 1.0, 2.0}, {0.0, 1.0, 2.0}, 1.0).value));
}

}  // namespace
}  // namespace drogue::parachute_app
