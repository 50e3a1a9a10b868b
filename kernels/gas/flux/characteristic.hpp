#pragma once

#include "kernels/gas/flux/euler.hpp"
#include "kernels/gas/parameters.hpp"

namespace drogue::gas {

/// Eigenvectors of dF/dU at a face. Right ones: (1, u-c, H-uc), (1, u, u^2/2), (1, u+c, H+uc). The acoustic
/// left ones are scaled by 2 c^2/(gamma-1), so that a projection takes six operations.
template <class R>
struct Eigensystem {
  R u, c, enthalpy, kinetic;  ///< kinetic = u^2/2
  R unit;                     ///< c^2/(gamma-1) = H - u^2/2
  R inverse_unit, width;      ///< width = c/(gamma-1)
};

template <class R>
struct Characteristic {
  R slow, entropy, fast;
};

/// Eigensystem for velocity `u`, m/s, and total specific enthalpy H, J/kg. H - u^2/2 is formed in R, because
/// at Mach 2000 the difference has no correct digit in single precision; later operations use N.
template <class N, class R, class S>
KOKKOS_INLINE_FUNCTION Eigensystem<N> eigensystem(S gamma, R u, R enthalpy) {
  using F = typename device::Access<N>::Element;
  using To = device::Convert<N>;
  const auto gamma_1 = F(gamma - S(1));
  const R kinetic = S(0.5) * (u * u);
  const N unit = To::from(enthalpy - kinetic);
  const device::Root<N> c = device::root(gamma_1 * unit);
  return {.u = To::from(u),
          .c = c.value,
          .enthalpy = To::from(enthalpy),
          .kinetic = To::from(kinetic),
          .unit = unit,
          .inverse_unit = gamma_1 * c.reciprocal,
          .width = unit * c.inverse};
}

/// Quantities of a cell beside a face that the averages use.
template <class R>
struct FaceCell {
  R rho, m, energy, u, enthalpy;
};

/// Eigensystem of the average state of the two cells beside a face, both in SI units.
template <class N, class R, class S>
KOKKOS_INLINE_FUNCTION Eigensystem<N> face_eigensystem(FaceAverage average, S gamma, const FaceCell<R>& left,
                                                       const FaceCell<R>& right) {
  if (average == FaceAverage::arithmetic)
    return eigensystem<N, R>(gamma, S(0.5) * (left.u + right.u), S(0.5) * (left.enthalpy + right.enthalpy));
  if (average == FaceAverage::conserved) {
    const R inverse = device::reciprocal(left.rho + right.rho);  // the halves of the three averages cancel
    const R m = left.m + right.m, energy = left.energy + right.energy;
    const R u = m * inverse;
    return eigensystem<N, R>(gamma, u, (energy + pressure(gamma, m, energy, u)) * inverse);
  }
  // Roe 1981
  const R wl = device::square_root(left.rho), wr = device::square_root(right.rho);
  const R inverse = device::reciprocal(wl + wr);
  return eigensystem<N, R>(gamma, (wl * left.u + wr * right.u) * inverse,
                           (wl * left.enthalpy + wr * right.enthalpy) * inverse);
}

/// Projection L d of a difference d = (drho, dm, dE) of U or F, SI units, in the scale of the eigenvectors:
/// acoustic fields in units of 2 `unit`. Does not throw.
template <class R>
KOKKOS_INLINE_FUNCTION Characteristic<R> project(const Eigensystem<R>& e, R d_rho, R d_m, R d_energy) {
  const R s = e.kinetic * d_rho + (d_energy - e.u * d_m);
  const R t = e.u * d_rho - d_m;
  return {s + e.width * t, d_rho - e.inverse_unit * s, s - e.width * t};
}

}  // namespace drogue::gas
