#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/reference/gas/face_flux.hpp"
#include "kernels/reference/gas/limiter.hpp"
#include "kernels/reference/gas/stage.hpp"

namespace drogue::reference {
namespace {

constexpr double gamma_air = 1.4;

/// Neighbouring states whose densities and pressures differ by up to eight orders of magnitude, at Mach 30.
std::vector<Conserved> near_vacuum_cells(std::mt19937& random, std::size_t n) {
  std::uniform_real_distribution<double> exponent(-8.0, 0.0);
  std::uniform_real_distribution<double> mach(-30.0, 30.0);
  std::vector<Conserved> cells;
  for (std::size_t i = 0; i < n; ++i) {
    Primitive w = {std::pow(10.0, exponent(random)), 0.0, std::pow(10.0, exponent(random))};
    w.u = mach(random) * sound_speed(w, gamma_air);
    cells.push_back(to_conserved(w, gamma_air));
  }
  return cells;
}

TEST(Limiter, KeepsEveryStageOfANearVacuumPositive) {
  std::mt19937 random(4);
  gas::Parameters parameters;
  parameters.cells = 40;
  std::int64_t limited_faces = 0;
  for (const gas::Weno weno : {gas::Weno::js, gas::Weno::z, gas::Weno::m, gas::Weno::teno5}) {
    parameters.weno = weno;
    for (int trial = 0; trial < 50; ++trial) {
      const std::vector<Conserved> cells = near_vacuum_cells(random, 40);
      const double lambda = 0.5 / speed_bounds(cells, gamma_air).largest;
      const StageFluxes fluxes = stage_fluxes(cells, parameters, lambda);
      limited_faces += fluxes.limited_faces;
      for (const Conserved& U : stage_update(cells, cells, fluxes.flux, 0.0, lambda)) {
        EXPECT_GT(U[0], 0.0);
        // p = (gamma-1)(E - m^2/(2 rho)) suffers from cancellation.
        EXPECT_GT(pressure(U, gamma_air), -1e-14 * U[2]);
      }
    }
  }
  EXPECT_GT(limited_faces, 1000);
}

TEST(Limiter, UnlimitedStagesOfTheSameDataFail) {
  std::mt19937 random(4);
  gas::Parameters parameters;
  parameters.cells = 40;
  int failures = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<Conserved> cells = near_vacuum_cells(random, 40);
    const double lambda = 0.5 / speed_bounds(cells, gamma_air).largest;
    const StageFluxes fluxes = stage_fluxes(cells, parameters, std::nullopt);
    failures += is_physical(stage_update(cells, cells, fluxes.flux, 0.0, lambda), gamma_air) ? 0 : 1;
  }
  EXPECT_GT(failures, 40);
}

TEST(Limiter, LeavesASafeFluxUnchanged) {
  const Conserved a = to_conserved({1.0, 0.1, 1.0}, gamma_air);
  const Conserved b = to_conserved({0.9, 0.0, 0.8}, gamma_air);
  const Conserved high = physical_flux(a, gamma_air);
  const Conserved low = lax_friedrichs_flux(a, b, 1.3, gamma_air);
  const LimitedFlux limited = limit_flux(high, low, a, b, 0.1, gamma_air);
  EXPECT_FALSE(limited.limited);
  EXPECT_EQ(limited.flux, high);
}

TEST(Limiter, LimitsTheDensityToItsFloor) {
  const Conserved a = to_conserved({1e-3, 0.0, 1e3}, gamma_air);
  const Conserved& b = a;
  const double lambda = 1e-4;
  const Conserved low = {0.0, 0.0, 0.0};
  const Conserved high = {10.0, 0.0, 0.0};  // removes twice the mass of cell a
  const LimitedFlux limited = limit_flux(high, low, a, b, lambda, gamma_air);
  EXPECT_TRUE(limited.limited);
  EXPECT_NEAR(a[0] - 2.0 * lambda * limited.flux[0], positivity_floor, 1e-17);
}

TEST(Limiter, BoundsAnExtremeFlux) {
  const Conserved a = to_conserved({1.0, 0.0, 1.0}, gamma_air);
  const Conserved low = lax_friedrichs_flux(a, a, 1.2, gamma_air);
  const double lambda = 0.2;
  const Conserved flux = limit_flux({1e9, 1e9, 1e9}, low, a, a, lambda, gamma_air).flux;
  Conserved share = a;
  for (std::size_t s = 0; s < 3; ++s) share[s] -= 2.0 * lambda * flux[s];
  EXPECT_TRUE(is_physical({share}, gamma_air));
}

}  // namespace
}  // namespace drogue::reference
