#include "miniapps/parachute/verify/profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace drogue::parachute_app {
namespace {

/// Line with the values of a function at `count` places from `first` on, whose distances begin with `spacing`
/// and grow by `growth`.
SampledLine sampled(double first, double spacing, int count, double (*function)(double),
                    double growth = 1.0) {
  std::vector<double> places, values;
  for (double x = first, step = spacing; count-- > 0; x += step, step *= growth) {
    places.push_back(x);
    values.push_back(function(x));
  }
  return {places, values};
}

TEST(SampledLine, ReproducesCubicPolynomials) {
  const auto cubic = [](double x) { return 2.0 - x + 3.0 * x * x - 0.5 * x * x * x; };
  for (const double growth : {1.0, 1.1, 0.9})
    for (const double x : {-1.1, -1.0, -0.9, 0.0, 0.13, 0.6, 0.99, 1.2})
      EXPECT_NEAR(sampled(-1.0, 0.25, 9, cubic, growth)(x), cubic(x), 1e-12) << x;
}

TEST(SampledLine, FindsVerticesOfParabolas) {
  const auto parabola = [](double x) { return 3.0 - 2.0 * (x - 0.37) * (x - 0.37); };
  for (const double growth : {1.0, 1.1}) {
    const auto [at, value] = sampled(0.0, 0.1, 11, parabola, growth).maximum(1.0);
    EXPECT_NEAR(at, 0.37, 1e-12);
    EXPECT_NEAR(value, 3.0, 1e-12);
  }
  const auto [low_at, low] = sampled(0.0, 0.125, 9, parabola).maximum(-1.0);
  EXPECT_EQ(low_at, 1.0);
  EXPECT_NEAR(low, parabola(1.0), 1e-15);
}

TEST(SampledLine, ReportsNanForNonFiniteSamples) {
  std::vector<double> values = {1.0, 2.0, 3.0, 2.0, 1.0};
  values[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(SampledLine({0.0, 1.0, 2.0, 3.0, 4.0}, values).maximum(1.0).second));
}

TEST(SampledLine, RejectsFewerThanFourValues) {
  EXPECT_THROW(SampledLine({0.0, 1.0, 2.0}, {1.0, 2.0, 3.0}), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::parachute_app
