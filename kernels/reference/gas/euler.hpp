#pragma once

#include <array>
#include <cmath>

namespace drogue::reference {

/// Density, kg/m^3, momentum density, kg/(m^2 s), and total energy density, J/m^3, or their fluxes.
using Conserved = std::array<double, 3>;

/// Density rho, kg/m^3, velocity u, m/s, and pressure p, Pa.
struct Primitive {
  double rho = 0.0;
  double u = 0.0;
  double p = 0.0;
};

[[nodiscard]] inline Conserved to_conserved(const Primitive& w, double gamma) {
  return {w.rho, w.rho * w.u, w.p / (gamma - 1.0) + 0.5 * w.rho * w.u * w.u};
}

[[nodiscard]] inline double pressure(const Conserved& U, double gamma) {
  return (gamma - 1.0) * (U[2] - 0.5 * U[1] * U[1] / U[0]);
}

[[nodiscard]] inline Primitive to_primitive(const Conserved& U, double gamma) {
  return {U[0], U[1] / U[0], pressure(U, gamma)};
}

[[nodiscard]] inline double sound_speed(const Primitive& w, double gamma) {
  return std::sqrt(gamma * w.p / w.rho);
}

/// Flux of the one-dimensional Euler equations, SI units. Does not throw.
[[nodiscard]] inline Conserved physical_flux(const Conserved& U, double gamma) {
  const Primitive w = to_primitive(U, gamma);
  return {U[1], U[1] * w.u + w.p, w.u * (U[2] + w.p)};
}

/// Magnitudes of the eigenvalues u-c, u, u+c, m/s. Does not throw.
[[nodiscard]] inline std::array<double, 3> wave_speeds(const Conserved& U, double gamma) {
  const Primitive w = to_primitive(U, gamma);
  const double c = sound_speed(w, gamma);
  return {std::abs(w.u - c), std::abs(w.u), std::abs(w.u + c)};
}

}  // namespace drogue::reference
