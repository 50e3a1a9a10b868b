#include "common/run/uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

namespace drogue::run {
namespace {

/// Numbers of mean 0 and variance 1.
enum class Noise { normal, exponential, lognormal };

class Random {
 public:
  explicit Random(unsigned seed) : _engine(seed) {}

  double next(Noise noise) {
    if (noise == Noise::normal) return _normal(_engine);
    if (noise == Noise::exponential) return std::exponential_distribution<double>()(_engine) - 1.0;
    constexpr double s = 0.5;  // of the logarithm
    const double mean = std::exp(0.5 * s * s);
    return (std::exp(s * _normal(_engine)) - mean) / (mean * std::sqrt(std::exp(s * s) - 1.0));
  }

  /// Series with the autocorrelation exp(-lag / length).
  std::vector<double> series(std::size_t count, double length) {
    const double kept = std::exp(-1.0 / length), fresh = std::sqrt(1.0 - kept * kept);
    std::vector<double> values = {_normal(_engine)};
    while (values.size() < count) values.push_back(kept * values.back() + fresh * _normal(_engine));
    return values;
  }

 private:
  std::mt19937_64 _engine;
  std::normal_distribution<double> _normal;
};

std::vector<double> batch_means(const std::vector<double>& series) {
  const std::size_t each = series.size() / batches;
  std::vector<double> means(batches);
  for (std::size_t i = 0; i < batches * each; ++i) means[i / each] += series[i] / static_cast<double>(each);
  return means;
}

/// An ensemble on each of two grids, whose mean is wrong by `error` standard errors of the finer one.
struct SyntheticStudy {
  std::size_t runs;
  double order, ratio, error;
  Noise noise;

  [[nodiscard]] Distribution on_grid(Random& random, double shift) const {
    std::vector<double> results;
    for (std::size_t i = 0; i < runs; ++i) results.push_back(shift + random.next(noise));
    return distribution_of(results);
  }

  /// Number of 100 studies whose interval contains the limit, which is 0. `safe`: by `error_bar`; otherwise
  /// with the difference of the means alone.
  [[nodiscard]] int covered(bool safe = true) const {
    Random random(20260000U + static_cast<unsigned>(runs));
    int count = 0;
    for (int k = 0; k < 100; ++k) {
      const double shift = error / std::sqrt(static_cast<double>(runs));
      const Distribution fine = on_grid(random, shift),
                         coarse = on_grid(random, shift * std::pow(ratio, order));
      const ErrorBar bar = error_bar(coarse, fine, ratio);
      const double plain = std::hypot(bar.sampling, (fine.mean - coarse.mean) / (ratio - 1.0));
      if (std::abs(bar.value) <= (safe ? bar.half_width : plain)) ++count;
    }
    return count;
  }
};

TEST(Uncertainty, StudentFactorsAreThoseOfTables) {
  const std::vector<std::pair<double, double>> table = {{1, std::tan(0.475 * std::numbers::pi)},
                                                        {2, 4.3027},
                                                        {3, 3.1824},
                                                        {7, 2.3646},
                                                        {15, 2.1314},
                                                        {100, 1.9840},
                                                        {1e9, 1.9600}};
  for (const auto& [freedom, factor] : table)
    EXPECT_NEAR(student_factor(freedom) / factor, 1.0, 2e-3) << freedom;
  EXPECT_EQ(student_factor(0.3), student_factor(1.0)) << "the least number";
}

TEST(Uncertainty, SummarisesRuns) {
  const Distribution all = distribution_of({5.0, 1.0, 4.0, 2.0, 3.0});
  EXPECT_EQ(all.runs, 5U);
  EXPECT_DOUBLE_EQ(all.mean, 3.0);
  EXPECT_DOUBLE_EQ(all.deviation, std::sqrt(2.5));
  EXPECT_DOUBLE_EQ(all.lowest, 1.2);
  EXPECT_DOUBLE_EQ(all.highest, 4.8);
  EXPECT_NEAR(all.half_width, 2.7764 * std::sqrt(0.5), 1e-3);
  EXPECT_THROW((void)distribution_of({}), std::invalid_argument);
}

TEST(Uncertainty, TakesTheWiderOneOfScatterAndTimes) {
  // Two runs that hardly differ, each a mean over time that is known to 0.3 and 0.4.
  const std::vector<double> widths = {0.3, 0.4};
  EXPECT_DOUBLE_EQ(distribution_of({1.0, 1.001}, widths).half_width, 0.25);
  EXPECT_GT(distribution_of({1.0, 2.0}, widths).half_width, 6.0);
  EXPECT_DOUBLE_EQ(distribution_of({1.0}, std::vector{0.3}).half_width, 0.3);
  EXPECT_TRUE(std::isnan(distribution_of({1.0}).half_width)) << "one run tells nothing of its error";
}

TEST(Uncertainty, CombinesScatterAndGrid) {
  const Distribution coarse = distribution_of({1.2}, std::vector{0.0}),
                     fine = distribution_of({1.1}, std::vector{0.0});
  const ErrorBar bar = error_bar(coarse, fine, 1.5);
  EXPECT_DOUBLE_EQ(bar.value, 1.1);
  EXPECT_NEAR(bar.grid, grid_safety * 0.1 / 0.5, 1e-12);
  EXPECT_EQ(bar.sampling, 0.0);
  const ErrorBar scattered =
      error_bar(distribution_of({1.1}, std::vector{0.03}), distribution_of({1.1}, std::vector{0.04}), 2.0);
  EXPECT_NEAR(scattered.grid, grid_safety * 0.05, 1e-12) << "scatter hides a difference of 0.05";
  EXPECT_NEAR(scattered.half_width, std::hypot(0.04, scattered.grid), 1e-12);
  EXPECT_EQ(error_bar(fine).grid, 0.0);
}

TEST(Uncertainty, StudiesOfTwoGridsContainTheirLimit) {
  for (const Noise noise : {Noise::normal, Noise::exponential, Noise::lognormal})
    for (const std::size_t runs : {2U, 4U, 8U, 16U})
      for (const double order : {1.0, 1.5, 2.0})
        for (const double ratio : {1.33, 1.5, 2.0})
          for (const double error : {-30.0, -6.0, -4.0, -1.0, 0.0, 1.0, 4.0, 6.0, 30.0})
            EXPECT_GE((SyntheticStudy{runs, order, ratio, error, noise}.covered()), 90)
                << static_cast<int>(noise) << ' ' << runs << ' ' << order << ' ' << ratio << ' ' << error;
}

TEST(Uncertainty, DifferenceOfTwoGridsAloneIsTooShortABar) {
  EXPECT_LT((SyntheticStudy{8, 1.0, 1.5, 30.0, Noise::normal}.covered(false)), 70);
}

TEST(Uncertainty, IntervalsOfOneGridContainTheMean) {
  for (const Noise noise : {Noise::normal, Noise::exponential, Noise::lognormal})
    for (const std::size_t runs : {4U, 8U, 32U}) {
      Random random(7);
      const SyntheticStudy study{runs, 1.0, 2.0, 0.0, noise};
      int count = 0;
      for (int k = 0; k < 1000; ++k) {
        const Distribution one = study.on_grid(random, 0.0);
        if (std::abs(one.mean) <= one.half_width) ++count;
      }
      EXPECT_GE(count, 900) << static_cast<int>(noise) << ' ' << runs;
      EXPECT_LT(count, 980) << static_cast<int>(noise) << ' ' << runs;
    }
}

TEST(Uncertainty, MeansOfCorrelatedSeriesHaveHonestErrors) {
  constexpr std::size_t rows = 3200;
  for (const double lengths : {16.0, 32.0, 100.0, 1000.0}) {  // correlation lengths in a series
    Random random(11);
    int known = 0, covered = 0, naive = 0;
    for (int k = 0; k < 400; ++k) {
      const std::vector<double> series = random.series(rows, rows / lengths), means = batch_means(series);
      double mean = 0.0;
      for (const double value : means) mean += value / static_cast<double>(batches);
      const double half_width = batch_half_width(means);
      if (std::isfinite(half_width)) ++known;
      if (std::abs(mean) <= half_width) ++covered;
      if (std::abs(mean) <= 1.96 / std::sqrt(static_cast<double>(rows))) ++naive;
    }
    EXPECT_GE(covered, 0.9 * known) << lengths;
    EXPECT_GE(known, lengths < 30.0 ? 200 : 320) << lengths;
    EXPECT_LT(naive, 320) << lengths << ": rows are not independent";
  }
}

TEST(Uncertainty, BatchesOfAFunctionAreOfEqualDuration) {
  // The mean of t over a part is its middle: a trend, whose batches are fully correlated.
  const auto trend = [](double from, double to) { return 0.5 * (from + to); };
  EXPECT_TRUE(std::isnan(batch_half_width(trend, 0.0, 16.0)));
  const auto alternating = [](double from, double) { return std::lround(from) % 2 == 0 ? 1.0 : -1.0; };
  EXPECT_NEAR(batch_half_width(alternating, 0.0, 16.0), 2.131 * std::sqrt(16.0 / 15.0) / 4.0, 1e-3);
  EXPECT_EQ(batch_half_width([](double, double) { return 3.0; }, 0.0, 1.0), 0.0);
  EXPECT_TRUE(
      std::isnan(batch_half_width([](double from, double) { return from > 0.5 ? NAN : 1.0; }, 0.0, 1.0)));
  EXPECT_TRUE(std::isnan(batch_half_width(std::vector{1.0, 2.0}))) << "too few";
}

TEST(Uncertainty, TextHasTwoDigitsOfTheError) {
  EXPECT_EQ(bar_text(0.79012, 0.0123), "0.790 +- 0.012");
  EXPECT_EQ(bar_text(5.4567, 0.5), "5.46 +- 0.50");
  EXPECT_EQ(bar_text(9461.0, 523.0), "9460 +- 520");
  EXPECT_EQ(bar_text(9461.0, 23.4), "9461 +- 23");
  EXPECT_EQ(bar_text(1.5, 0.0), "1.5 +- 0");
  EXPECT_EQ(bar_text(1.23456, NAN), "1.235");
  EXPECT_EQ(bar_text(10034.0, NAN), "10030");
  EXPECT_EQ(number_text(128.7, 2), "130");
  EXPECT_EQ(number_text(0.0, 2), "0");
  EXPECT_EQ(number_text(NAN, 2), "nan");
}

}  // namespace
}  // namespace drogue::run
