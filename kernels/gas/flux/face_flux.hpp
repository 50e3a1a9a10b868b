#pragma once

#include "kernels/gas/flux/characteristic.hpp"
#include "kernels/gas/flux/weno.hpp"

namespace drogue::gas {

/// Vector of the three conserved quantities: a state, a flux, or a difference of either.
template <class R>
struct ConservedVector {
  R rho, m, energy;
};

/// Linear fourth-order flux (-f[-1] + 7 f[0] + 7 f[1] - f[2]) / 12, from f[0] + f[1] and the differences on
/// either side; in the units of f. Does not throw.
template <class R>
KOKKOS_INLINE_FUNCTION R central_flux(R sum, R before, R after) {
  using S = typename device::Access<R>::Element;
  return S(0.5) * sum - S(1.0 / 12.0) * (after - before);
}

/// Input of the flux at face i+1/2 from the cells i-2 .. i+3: the five differences of neighbouring states and
/// fluxes, and the sum of the two fluxes beside the face. The mass flux is the momentum.
template <class R>
struct Stencil {
  using Value = R;

  ConservedVector<R> d_state[5];
  R d_flux_m[5], d_flux_energy[5];
  ConservedVector<R> flux_sum;

  /// Linear flux at the face, SI units. Does not throw.
  [[nodiscard]] KOKKOS_FUNCTION ConservedVector<R> central() const {
    return {central_flux(flux_sum.rho, d_state[1].m, d_state[3].m),
            central_flux(flux_sum.m, d_flux_m[1], d_flux_m[3]),
            central_flux(flux_sum.energy, d_flux_energy[1], d_flux_energy[3])};
  }
};

/// Split differences of one characteristic field. The right-going part uses the first four of the five
/// differences, the left-going part the last four in reverse order.
template <class R>
struct SplitDifferences {
  // Initialised for compilers that keep the loop over k: they cannot see that it sets all elements, and warn.
  R right[4]{}, left[4]{};

  /// Sets the parts of difference k from that of the flux, `df`, of the state, `du`, and the wave speed
  /// `alpha`, m/s. Does not throw.
  KOKKOS_FUNCTION void set(int k, R df, R du, R alpha) {
    if (k < 4) right[k] = df + alpha * du;
    if (k > 0) left[4 - k] = df - alpha * du;
  }
  /// Correction of the field from both sides, times `correction_scale * scale * unit`; in the unit of the
  /// differences times that of `unit`.
  template <Reconstruction scheme, int scale>
  KOKKOS_FUNCTION R corrected(R unit) const {
    return correction<scheme, scale, R>(right[0], right[1], right[2], right[3], unit) -
           correction<scheme, scale, R>(left[0], left[1], left[2], left[3], unit);
  }
};

/// Characteristic finite-difference WENO5 flux at a face in difference form (docs/gas.md, section 2; Jiang
/// and Shu 1996, section 2), SI units: the central flux minus the projected nonlinear corrections.
///
/// `N` is the type of the nonlinear terms: R, or its single-precision twin for split precision. `AnyStencil`
/// is `Stencil` or a type with the same differences and `central()`. Force-inlined: a call would spill its
/// arguments.
template <Reconstruction scheme, class N, class AnyStencil, class R = typename AnyStencil::Value>
KOKKOS_FORCEINLINE_FUNCTION ConservedVector<R> weno5_face(const AnyStencil& s, const Eigensystem<N>& e,
                                                          const WaveSpeeds<N>& alpha) {
  using To = device::Convert<N>;
  SplitDifferences<N> slow, entropy, fast;
  for (int k = 0; k < 5; ++k) {
    const N d_m = To::from(s.d_state[k].m);
    const Characteristic<N> u = project(e, To::from(s.d_state[k].rho), d_m, To::from(s.d_state[k].energy));
    const Characteristic<N> f = project(e, d_m, To::from(s.d_flux_m[k]), To::from(s.d_flux_energy[k]));
    slow.set(k, f.slow, u.slow, alpha.slow);
    entropy.set(k, f.entropy, u.entropy, alpha.entropy);
    fast.set(k, f.fast, u.fast, alpha.fast);
  }
  using F = typename device::Access<N>::Element;
  const N k1 = slow.template corrected<scheme, acoustic_scale>(e.unit);
  const N k2 = F(1.0 / (correction_scale * entropy_scale)) *
               entropy.template corrected<scheme, entropy_scale>(N(F(1)));
  const N k3 = fast.template corrected<scheme, acoustic_scale>(e.unit);
  const N acoustic = F(1.0 / (correction_scale * acoustic_scale)) * e.inverse_unit;
  const N sum = acoustic * (k1 + k3), difference = acoustic * e.c * (k3 - k1);
  using Back = device::Convert<R>;
  const ConservedVector<R> central = s.central();
  return {central.rho - Back::from(sum + k2), central.m - Back::from(e.u * (sum + k2) + difference),
          central.energy - Back::from(e.enthalpy * sum + e.kinetic * k2 + e.u * difference)};
}

}  // namespace drogue::gas
