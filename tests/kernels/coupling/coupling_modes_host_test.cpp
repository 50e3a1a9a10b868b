#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
  for (std::size_t k = 0; k < 5; ++k) diagonal[k][k] = 0.25 * static_cast<double>(k) - 1.5;
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

/// Largest growth of a mode of an impermeable sheet that reaches the grid in part only: interpolation after
/// spreading gives `visible` of the row sum, as with waves near the spacing, folds and edges.
double growth_with_defect(double omega_dt, double visible, double alpha, double defect_filter) {
  double largest = 0.0;
  for (const double ratio : {1.0, 2.0, 8.0})
    for (const double mass : {0.00373, 0.0373, 0.373}) {
      SheetModeParameters p;
      p.mass = mass;
      p.inverse_air_mass = 1.0 / copy_mass;
      p.spread = visible / copy_mass;
      p.response = p.spread / ratio;
      // The air that a mode moves is at most some eight times that of the copies.
      const double moved = std::min(1.0 / p.response, 8.0 * copy_mass);
      p.stiffness = omega_dt * omega_dt / (dt * dt) * (moved + mass);
      p.alpha = alpha;
      p.defect_filter = defect_filter;
      p.dt = dt;
      p.substeps = std::max(4, static_cast<int>(std::ceil(10.0 * dt * std::sqrt(p.stiffness / mass))));
      largest = std::max(largest, spectral_radius(amplification(p)));
    }
  return largest;
}

TEST(SheetModes, DecayWithTheFilteredDefectWhereTheStepResolvesThem) {
  for (const double visible : {0.02, 0.1, 0.3, 0.6, 0.8, 0.95}) {
    for (const double defect_filter : {0.02, 0.05, 0.1, 0.2})
      for (const double alpha : {porous, closed})
        for (const double omega_dt : {0.1, 0.2, 0.4, 0.6, 0.8, 1.0})
          EXPECT_LT(growth_with_defect(omega_dt, visible, alpha, defect_filter), 1.0 + 1e-5)
              << visible << ' ' << defect_filter << ' ' << alpha << ' ' << omega_dt;
    for (const double omega_dt : {1.5, 3.0, 7.0}) {
      EXPECT_LT(growth_with_defect(omega_dt, visible, porous, 0.1), 1.0) << visible << ' ' << omega_dt;
      EXPECT_LT(growth_with_defect(omega_dt, visible, closed, 0.05), 1.07) << visible << ' ' << omega_dt;
    }
  }
  // As heavy a weight as that of the acceleration lets modes grow whatever the step.
  EXPECT_GT(growth_with_defect(1.0, 0.02, closed, 0.5), 1.001);
}

}  // namespace
}  // namespace drogue::reference
