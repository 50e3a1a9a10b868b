#pragma once

#include "kernels/device/pack.hpp"

namespace drogue::gas {

/// State of one cell from the conserved variables (rho, m = rho u, E), SI units.
template <class R>
struct CellState {
  R rho, m, energy;
  R u, p, enthalpy, c;  ///< velocity, pressure, total specific enthalpy H, sound speed
};

/// Pressure p = (gamma - 1) (E - m u / 2), Pa, from momentum density, kg/(m^2 s), energy density, J/m^3, and
/// velocity, m/s. Every admissibility check uses this order of operations.
template <class R, class S>
KOKKOS_INLINE_FUNCTION R pressure(S gamma, R m, R energy, R u) {
  return (gamma - S(1)) * (energy - S(0.5) * (m * u));
}

/// State from density, kg/m^3, momentum density, kg/(m^2 s), and energy density, J/m^3. Does not throw.
template <class R, class S>
KOKKOS_INLINE_FUNCTION CellState<R> cell_state(S gamma, R rho, R m, R energy) {
  const R inverse = device::reciprocal(rho);
  const R u = m * inverse;
  const R p = pressure(gamma, m, energy, u);
  return {.rho = rho,
          .m = m,
          .energy = energy,
          .u = u,
          .p = p,
          .enthalpy = (energy + p) * inverse,
          .c = device::root(gamma * (p * inverse)).value};
}

/// Magnitudes of the eigenvalues per characteristic field: |u - c|, |u|, |u + c|, m/s.
template <class R>
struct WaveSpeeds {
  R slow, entropy, fast;
};

/// Wave speeds from velocity and sound speed, m/s. Does not throw.
template <class R>
KOKKOS_INLINE_FUNCTION WaveSpeeds<R> wave_speeds(R u, R c) {
  return {device::absolute(u - c), device::absolute(u), device::absolute(u + c)};
}

}  // namespace drogue::gas
