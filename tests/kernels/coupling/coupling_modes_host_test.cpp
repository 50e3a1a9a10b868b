#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/coupling/sheet/filter_weights.hpp"
#include "kernels/reference/coupling/sheet_mode.hpp"

// One-mode analysis of coupled steps: where a mode of a sheet grows, by the eigenvalues of a step.

namespace drogue::reference {
namespace {

constexpr double porous = 254.4, nearly_closed = 1e4, closed = std::numeric_limits<double>::infinity();

/// Air that the copies of vertices move, 2.09 rho h for cells of 0.2 m, kg/m^2.
constexpr double copy_mass = 2.09 * 1.225 * 0.2;
constexpr double dt = 0.01;

/// Growth per step of a mode whose added mass is `ratio` times that of the copies, on cloth of `mass`,
/// kg/m^2, with the angular frequency that the added mass alone would give times dt. The mass of a copy is
/// that of the row sum times `scale`.
double growth(double omega_dt, double ratio, double mass, double alpha, double filter, double scale = 1.0) {
  SheetModeParameters p;
  p.mass = mass;
  p.stiffness = omega_dt * omega_dt / (dt * dt) * ratio * copy_mass;
  p.inverse_air_mass = 1.0 / (scale * copy_mass);
  p.spread = 1.0 / copy_mass;
  p.response = 1.0 / (ratio * copy_mass);
  p.alpha = alpha;
  p.filter = filter;
  p.dt = dt;
  // Far below the stability limit of the cloth, which its shortest waves determine.
  p.substeps = std::max(4, static_cast<int>(std::ceil(20.0 * dt * std::sqrt(p.stiffness / mass))));
  return spectral_radius(amplification(p));
}

/// Largest growth for omega dt in an interval and cloth of a tenth to ten times the mass of a C-9.
double largest_growth(double from, double to, double ratio, double alpha, double filter, double scale = 1.0) {
  double largest = 0.0;
  const int intervals = static_cast<int>(std::ceil((to - from) / 0.1 - 1e-9));
  for (int k = 0; k <= intervals; ++k)
    for (const double mass : {0.00373, 0.0373, 0.373})
      largest =
          std::max(largest, growth(from + k * (to - from) / intervals, ratio, mass, alpha, filter, scale));
  return largest;
}

TEST(SheetModes, SpectralRadiusIsThatOfKnownMatrices) {
  EXPECT_EQ(spectral_radius({}), 0.0);
  SheetModeMatrix diagonal{};
  for (std::size_t k = 0; k < 6; ++k) diagonal[k][k] = 0.25 * static_cast<double>(k) - 1.5;
  EXPECT_NEAR(spectral_radius(diagonal), 1.5, 1e-12);
  // A rotation that grows, beside a Jordan block.
  EXPECT_NEAR(spectral_radius({{{0.6, -0.9}, {0.9, 0.6}, {0, 0, 0.5, 1}, {0, 0, 0, 0.5}, {}}}),
              std::sqrt(0.36 + 0.81), 1e-9);
  EXPECT_NEAR(spectral_radius({{{1, 1}, {0, 1, 1}, {0, 0, 1, 1}, {0, 0, 0, 1}, {}}}), 1.0, 1e-6);
}

TEST(SheetModes, StepsConserveTheMomentumOfSheetAndAirWithoutStiffness) {
  SheetModeParameters p;
  p.mass = 0.0373, p.inverse_air_mass = p.spread = 2.0, p.response = 0.25, p.alpha = porous, p.substeps = 5;
  SheetMode mode = {0.0, 1.0, 0.0, 0.0};
  for (int step = 0; step < 50; ++step) {
    mode = coupled_step(mode, p, step == 0);
    EXPECT_NEAR(p.mass * mode.velocity + mode.air / p.response, p.mass, 1e-15);
  }
  // Both move at the same velocity in the end.
  EXPECT_NEAR(mode.velocity, p.mass / (p.mass + 4.0), 1e-6);
  EXPECT_NEAR(mode.air, mode.velocity, 1e-6);
}

TEST(SheetModes, NeverGrowWithoutTheFilteredAcceleration) {
  for (const double alpha : {porous, nearly_closed, closed})
    for (const double ratio : {1.25, 2.0, 8.0, 40.0})
      EXPECT_LT(largest_growth(0.5, 14.0, ratio, alpha, 0.0), 1.0 + 1e-4) << alpha << ' ' << ratio;
}

TEST(SheetModes, PorosityLetsThemDecayWithAnyStepAndFilter) {
  for (const double filter : {0.2, 0.5, 1.0})
    for (const double ratio : {1.25, 2.0, 8.0, 40.0})
      EXPECT_LT(largest_growth(0.1, 14.0, ratio, porous, filter), 1.0) << filter << ' ' << ratio;
}

TEST(SheetModes, DecayOnImpermeableClothWhereTheStepResolvesThem) {
  for (const double alpha : {nearly_closed, closed})
    for (const double filter : {0.2, 0.5})
      for (const double ratio : {1.25, 2.0, 4.0, 8.0})
        EXPECT_LT(largest_growth(0.1, 1.0, ratio, alpha, filter), 1.0) << filter << ' ' << ratio;
}

TEST(SheetModes, GrowOnImpermeableClothWhereTheFilterLags) {
  struct Setting {
    double filter, growth;
  };
  for (const Setting& setting : {Setting{0.2, 1.035}, {0.5, 1.073}, {1.0, 1.129}}) {
    double largest = 0.0;
    for (const double ratio : {1.25, 2.0, 4.0, 8.0})
      largest = std::max(largest, largest_growth(0.1, 3.0, ratio, closed, setting.filter));
    EXPECT_NEAR(largest, setting.growth, 0.003) << setting.filter;
  }
  // omega dt from which a mode grows by 0.2 % in a step, for added masses that many times that of a copy.
  struct Limit {
    double ratio, omega_dt;
  };
  for (const Limit& limit : {Limit{4.0, 1.5}, {8.0, 1.1}, {16.0, 0.8}, {40.0, 0.5}}) {
    EXPECT_LT(largest_growth(0.1, limit.omega_dt - 0.1, limit.ratio, closed, 0.5), 1.002) << limit.ratio;
    EXPECT_GT(largest_growth(0.1, limit.omega_dt + 0.1, limit.ratio, closed, 0.5), 1.002) << limit.ratio;
  }
}

TEST(SheetModes, GrowIfCopiesAreHeavierThanTheRowSum) {
  for (const double ratio : {4.0, 8.0}) {
    EXPECT_GT(largest_growth(0.1, 1.0, ratio, closed, 0.5, 2.0), 1.002) << ratio;
    EXPECT_GT(largest_growth(0.1, 1.0, ratio, closed, 0.5, 4.0), 1.1) << ratio;
    // Copies that do not give way: the velocity of the air at the beginning of the step.
    EXPECT_GT(largest_growth(0.1, 1.0, ratio, closed, 0.5, 1e9), 1.2) << ratio;
  }
}

TEST(SheetModes, GrowIfTheAirOfTheDeltaFunctionIsCountedOnce) {
  // It is 1.30 rho h, 0.62 of the copies. All of these modes are resolved by steps.
  const auto growth_of = [](double alpha, double filter, double trend, double counted_once) {
    double largest = 0.0;
    for (const double ratio : {4.0, 8.0, 16.0})
      for (const double omega_dt : {0.1, 0.3, 0.6, 1.0}) {
        SheetModeParameters p;
        p.mass = 0.0373;
        p.stiffness = omega_dt * omega_dt / (dt * dt) * ratio * copy_mass;
        p.inverse_air_mass = p.spread = 1.0 / copy_mass;
        p.response = 1.0 / (ratio * copy_mass);
        p.counted_once = counted_once;
        p.alpha = alpha;
        p.filter = filter;
        p.trend = trend;
        p.dt = dt;
        p.substeps = 40;
        largest = std::max(largest, spectral_radius(amplification(p)));
      }
    return largest;
  };
  EXPECT_LT(growth_of(closed, 0.2, 0.0, 0.0), 1.01);
  EXPECT_GT(growth_of(closed, 0.2, 0.0, 0.62), 1.03);
  EXPECT_GT(growth_of(closed, 0.5, 0.0, 0.62), 1.05);
  EXPECT_LT(growth_of(porous, 1.0, 0.5, 0.0), 1.0);
  EXPECT_GT(growth_of(porous, 1.0, 0.5, 0.62), 1.5);
}

/// Constants of waves of cloth, of k h = `wave`, that reach the grid in part only: interpolation after
/// spreading gives the part `sinc`^6 of the row sum, two means between neighbours h / 2 apart cos^4.
SheetModeParameters wave_parameters(double wave, double omega_dt, double mass, double alpha) {
  SheetModeParameters p;
  p.mass = mass;
  p.inverse_air_mass = 1.0 / copy_mass;
  p.spread = std::pow(std::sin(0.5 * wave) / (0.5 * wave), 6) / copy_mass;
  // Air of the length 1 / k on both sides, beside that of the copies.
  const double ratio = 1.0 + 2.0 * 1.225 * 0.2 / (wave * copy_mass);
  p.response = p.spread / ratio;
  p.smoothing = std::pow(std::cos(0.25 * wave), 4);
  // The air that a mode moves is at most some eight times that of the copies.
  p.stiffness =
      omega_dt * omega_dt / (dt * dt) * (std::min(1.0 / p.response, 8.0 * ratio * copy_mass) + mass);
  p.alpha = alpha;
  p.dt = dt;
  p.substeps = std::max(4, static_cast<int>(std::ceil(10.0 * dt * std::sqrt(p.stiffness / mass))));
  return p;
}

/// Largest growth of such waves on cloth of a tenth to ten times the mass of a C-9; `change(p)` sets weights.
template <class Change>
double largest_growth_of_waves(const std::vector<double>& omega_dt, double alpha, const Change& change) {
  double largest = 0.0;
  for (const double wave : {0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 2.5, 3.14, 4.0})
    for (const double mass : {0.00373, 0.0373, 0.373})
      for (const double each : omega_dt) {
        SheetModeParameters p = wave_parameters(wave, each, mass, alpha);
        change(p);
        largest = std::max(largest, spectral_radius(amplification(p)));
      }
  return largest;
}

const std::vector<double> resolved = {0.1, 0.3, 0.6, 1.0}, unresolved = {1.5, 2.0, 2.5, 3.0};

TEST(SheetModes, GrowNoFasterWithTheSmoothedDefect) {
  for (const double alpha : {porous, closed})
    for (const double filter : {0.2, 0.5})
      for (const std::vector<double>& steps : {resolved, unresolved}) {
        const auto growth_with = [&](double leak_filter) {
          return largest_growth_of_waves(
              steps, alpha, [&](SheetModeParameters& p) { p.filter = filter, p.leak_filter = leak_filter; });
        };
        EXPECT_LT(growth_with(0.5), growth_with(0.0) + (alpha == porous ? 2e-3 : 5e-3))
            << alpha << ' ' << filter;
      }
  // Without the means, waves near the spacing grow in any step.
  EXPECT_GT(largest_growth_of_waves(resolved, closed,
                                    [](SheetModeParameters& p) { p.leak_filter = 0.5, p.smoothing = 1.0; }),
            1.01);
}

TEST(SheetModes, DecayWithTheWeightsOfTheLaw) {
  for (const double alpha : {50.0, 254.4, 500.0, 1000.0, 1500.0, 2500.0, 4000.0, 7000.0}) {
    const coupling::FilterWeights weights =
        coupling::filter_weights({.alpha = alpha}, 0.0, dt, 1.0 / copy_mass);
    const auto set = [&](SheetModeParameters& p) {
      p.filter = weights.mean, p.trend = weights.trend, p.leak_filter = 0.5;
    };
    EXPECT_LT(largest_growth_of_waves(resolved, alpha, set), 1.0) << alpha;
    EXPECT_LT(largest_growth_of_waves(unresolved, alpha, set), 1.0) << alpha;
  }
  // A trend lets modes of impermeable cloth grow fast.
  const auto with_trend = [](SheetModeParameters& p) { p.filter = 1.0, p.trend = 0.5; };
  EXPECT_GT(largest_growth_of_waves(unresolved, closed, with_trend), 1.15);
}

TEST(SheetModes, WeightsFollowFromTheSlopeOfTheLaw) {
  using coupling::filter_weights;
  const auto expect = [](const coupling::FilterWeights& found, double mean, double trend) {
    EXPECT_NEAR(found.mean, mean, 1e-12);
    EXPECT_EQ(found.trend, trend);
  };
  expect(filter_weights({.impermeable = true}, 100.0, 0.01, 2.0), 0.2, 0.0);
  expect(filter_weights({.alpha = 400.0}, 100.0, 0.01, 2.0), 1.0, 0.5);
  expect(filter_weights({.alpha = 1000.0}, 100.0, 0.01, 2.0), 1.0, 0.0);
  expect(filter_weights({.alpha = 3000.0}, 100.0, 0.01, 2.0), 0.5, 0.0);
  expect(filter_weights({.alpha = 1e9}, 100.0, 0.01, 2.0), 0.2, 0.0);
  // The slope of 300 w + 400 w^2 where that is 400: w = 0.693, 854 Pa s/m.
  expect(filter_weights({.alpha = 300.0, .beta = 400.0}, -400.0, 0.05, 1.0),
         30.0 / (0.05 * std::sqrt(9e4 + 64e4)), 0.0);
  expect(filter_weights({}, 0.0, 0.01, 2.0), 1.0, 0.5);
}

}  // namespace
}  // namespace drogue::reference
