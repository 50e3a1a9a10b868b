#include <gtest/gtest.h>

#include <cmath>

#include "miniapps/springs/verify/closed_forms.hpp"
#include "miniapps/springs/verify/sinusoid.hpp"

namespace drogue::springs_app {
namespace {

TEST(ClosedForms, BesselZerosMatchTables) {
  // Abramowitz and Stegun, table 9.5.
  EXPECT_NEAR(bessel_zero(0, 1), 2.4048255577, 1e-10);
  EXPECT_NEAR(bessel_zero(1, 1), 3.8317059702, 1e-10);
  EXPECT_NEAR(bessel_zero(0, 5), 14.9309177085, 1e-10);
  EXPECT_NEAR(bessel_zero(5, 2), 12.3386042, 1e-6);
}

TEST(ClosedForms, HenckyMembraneMatchesPublishedConstants) {
  // Deflection and tension at the centre for three ratios of Poisson.
  for (const auto& [nu, w, n] :
       {std::array{0.0, 0.71832, 0.40510}, {0.14, 0.69058, 0.41539}, {0.30, 0.65344, 0.43110}}) {
    EXPECT_NEAR(hencky(nu).deflection, w, 1e-5);
    EXPECT_NEAR(hencky(nu).tension, n, 1e-5);
  }
}

TEST(ClosedForms, StringWithPayloadSolvesItsFrequencyEquation) {
  // Without payload a quarter of a wave; with a heavy one sqrt(EA / (L M)).
  EXPECT_NEAR(string_frequency(100.0, 0.01, 2.0, 0.0, 1), 100.0 / 8.0, 1e-12);
  EXPECT_NEAR(string_frequency(100.0, 0.01, 2.0, 0.0, 2), 3.0 * 100.0 / 8.0, 1e-12);
  const double heavy = std::sqrt(100.0 / (2.0 * 1000.0)) / (2.0 * M_PI);
  EXPECT_NEAR(string_frequency(100.0, 0.01, 2.0, 1000.0, 1) / heavy, 1.0, 1e-5);
  const double z = 2.0 * M_PI * string_frequency(100.0, 0.01, 2.0, 0.02, 1) * 2.0 / 100.0;
  EXPECT_NEAR(z * std::tan(z), 1.0, 1e-12);
}

TEST(ClosedForms, StiffCatenaryIsInextensible) {
  // Span 2 a sinh(l / 2 a) ... with a = 1: length 2 sinh(1), span 2, sag cosh(1) - 1.
  const double length = 2.0 * std::sinh(1.0);
  const auto points = catenary_points({2.0, 0.0, length, 1.0, 1e9}, {0.0, 0.5 * length, length});
  EXPECT_EQ(points[0].along, 0.0);
  EXPECT_NEAR(points[1].along, 1.0, 1e-7);
  EXPECT_NEAR(points[1].down, std::cosh(1.0) - 1.0, 1e-7);
  EXPECT_NEAR(points[2].along, 2.0, 1e-9);
  EXPECT_NEAR(points[2].down, 0.0, 1e-9);
  const auto steep = catenary_points({0.5, 0.7, 1.0, 0.01, 0.5}, {1.0});
  EXPECT_NEAR(steep[0].along, 0.5, 1e-9);
  EXPECT_NEAR(steep[0].down, 0.7, 1e-9);
}

TEST(ClosedForms, HangingStringMatchesItsClosedForm) {
  // A payload of 3 N on 2 m: 6 / 12; the string's own 4 N hang from its middle on the average.
  EXPECT_DOUBLE_EQ(hanging_stretch(12.0, 0.0, 2.0, 3.0), 0.5);
  EXPECT_DOUBLE_EQ(hanging_stretch(12.0, 2.0, 2.0, 3.0), 0.5 + 4.0 * 1.0 / 12.0);
}

TEST(ClosedForms, VerticalStretchMatchesItsClosedForm) {
  // Almost vertical: (rho g L^2 / 2) / EA longer.
  const auto points = catenary_points({1e-6, 1.05, 1.0, 1.0, 10.0}, {1.0});
  EXPECT_NEAR(points[0].down, 1.05, 1e-9);
  EXPECT_TRUE(catenary_points({0.0, 1.05, 1.0, 1.0, 10.0}, {1.0}).empty());
}

TEST(Sinusoid, FitsTheFrequencyOfASinusoid) {
  std::vector<double> time, value;
  for (int k = 0; k < 500; ++k) {
    time.push_back(0.013 * k);
    value.push_back(3.0 + 0.5 * std::cos(2.0 * M_PI * 1.7 * time.back() + 0.3));
  }
  EXPECT_NEAR(fitted_frequency(time, value), 1.7, 1e-8);
  EXPECT_TRUE(std::isnan(fitted_frequency({0.0, 1.0}, {1.0, 2.0})));
  EXPECT_TRUE(std::isnan(fitted_frequency({}, {})));
}

TEST(Sinusoid, FindsTheHalfRiseTime) {
  EXPECT_DOUBLE_EQ(half_rise_time({0, 1, 2, 3}, {5, 5, 7, 9}), 2.0);
  EXPECT_DOUBLE_EQ(half_rise_time({0, 1, 2}, {0, -3, -4}), 2.0 / 3.0);
  EXPECT_TRUE(std::isnan(half_rise_time({0, 1}, {1, 1})));
}

}  // namespace
}  // namespace drogue::springs_app
