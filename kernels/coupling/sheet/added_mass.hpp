#pragma once

#include <numbers>

namespace drogue::coupling {

/// Mass of fluid per area that a sheet of sinusoidal waves moves over its own: density wavelength / (pi
/// area_density), from the potential flow on both sides; kg/m^3, m and kg/m^2. Explicit staggered coupling
/// of an impermeable sheet is unstable beyond 1 for any dt if it moves all of this fluid in a step (Causin,
/// Gerbeau and Nobile 2005). Does not throw.
[[nodiscard]] constexpr double added_mass_ratio(double density, double wavelength, double area_density) {
  return density * wavelength / (std::numbers::pi * area_density);
}

}  // namespace drogue::coupling
