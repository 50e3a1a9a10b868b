#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>

#include "common/grid/stretched_axis.hpp"

namespace drogue::grid {
namespace {

std::vector<double> widths_of(const std::vector<double>& faces) {
  std::vector<double> widths;
  for (std::size_t i = 1; i < faces.size(); ++i) widths.push_back(faces[i] - faces[i - 1]);
  return widths;
}

/// Asserts what every axis promises.
void expect_valid(const StretchedAxis& axis) {
  const std::vector<double> faces = stretched_faces(axis), widths = widths_of(faces);
  EXPECT_EQ(faces.front(), axis.low);
  EXPECT_EQ(faces.back(), axis.high);
  ASSERT_TRUE(std::ranges::is_sorted(faces, std::less_equal()));
  const double least = *std::ranges::min_element(widths), rounding = 1e-12 * (axis.high - axis.low);
  EXPECT_LE(least, axis.spacing * (1.0 + 1e-9));
  EXPECT_GT(least, 0.5 * std::min(axis.spacing, axis.core_high - axis.core_low));
  for (std::size_t i = 0; i < widths.size(); ++i) {
    const bool is_core = faces[i] >= axis.core_low - rounding && faces[i + 1] <= axis.core_high + rounding;
    EXPECT_TRUE(!is_core || std::abs(widths[i] - least) <= rounding) << i;
    if (i == 0) continue;
    const double narrow = std::min(widths[i], widths[i - 1]), wide = std::max(widths[i], widths[i - 1]);
    EXPECT_LE(wide, axis.growth * narrow + rounding) << i;
  }
  // Widths grow outwards, and the first cell of the core comes first.
  const auto core = std::ranges::min_element(widths);
  EXPECT_TRUE(std::is_sorted(core, widths.end(), [&](double a, double b) { return a < b - rounding; }));
}

TEST(StretchedAxis, KeepsGrowthCoreAndEndsOfRandomAxes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    StretchedAxis axis;
    axis.low = -10.0 * unit(random);
    axis.core_low = axis.low + (i % 3 == 0 ? 0.0 : 8.0 * unit(random));
    axis.core_high = axis.core_low + 0.2 + 5.0 * unit(random);
    axis.high = axis.core_high + (i % 5 == 0 ? 0.0 : 20.0 * std::pow(unit(random), 3));
    axis.spacing = 0.01 + 0.2 * unit(random);
    axis.growth = 1.001 + 0.1 * unit(random);
    expect_valid(axis);
  }
}

TEST(StretchedAxis, OfACoreAloneIsUniform) {
  const std::vector<double> faces = stretched_faces({-1.0, 2.0, -1.0, 2.0, 0.7, 1.06});
  ASSERT_EQ(faces.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(faces[i], -1.0 + 0.6 * static_cast<double>(i), 1e-15);
}

TEST(StretchedAxis, HasTheFewestCellsOfTheLargestGrowth) {
  // 1 + 1.1 + 1.21 + 1.331 widths of 0.1 beyond each end of the core, but for the first one.
  const double outside = 0.1 * (1.1 + 1.21 + 1.331);
  const std::vector<double> faces = stretched_faces({-outside, 1.0, 0.0, 1.0, 0.1, 1.1});
  EXPECT_EQ(faces.size(), 3U + 11U);
  EXPECT_NEAR(faces[0], -outside, 1e-15);
  EXPECT_NEAR(faces[2], -0.11, 1e-9);
}

TEST(StretchedAxis, IsSymmetricToTheBitWhereItsInputIs) {
  for (const double spacing : {0.1, 0.13, 0.5}) {
    const std::vector<double> faces = stretched_faces({-7.3, 7.3, -1.1, 1.1, spacing, 1.07});
    for (std::size_t i = 0; i < faces.size(); ++i) EXPECT_EQ(faces[i], -faces[faces.size() - 1 - i]) << i;
  }
}

TEST(StretchedAxis, TheCoreReachesASideThatIsTooNearForCellsThatGrow) {
  // 1.5 cells of 0.1 are not 1.06 or 1.06 + 1.06^2 of them.
  const std::vector<double> widths = widths_of(stretched_faces({0.0, 3.0, 0.15, 1.0, 0.1, 1.06}));
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(widths[i], 0.1, 1e-12);
  EXPECT_GT(widths[10], 0.1 * 1.001);
}

TEST(StretchedAxis, RefusesWhatIsNoAxis) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const StretchedAxis& axis :
       {StretchedAxis{0.0, 1.0, -0.1, 0.5}, StretchedAxis{0.0, 1.0, 0.5, 1.1},
        StretchedAxis{0.0, 1.0, 0.5, 0.5}, StretchedAxis{0.0, 1.0, 0.2, 0.8, 0.0},
        StretchedAxis{0.0, 1.0, 0.2, 0.8, 0.1, 1.0}, StretchedAxis{0.0, 1.0, 0.2, 0.8, 1e-9},
        StretchedAxis{0.0, nan, 0.2, 0.8}, StretchedAxis{0.0, 1.0, 0.2, 0.8, nan}})
    EXPECT_THROW((void)stretched_faces(axis), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::grid
