#pragma once

#include "kernels/gas/characteristic.hpp"
#include "kernels/gas/weno.hpp"

namespace drogue::gas {

/// One vector of the three conserved quantities: a flux, a state or a difference of either.
template <class R>
struct Triple {
  R rho, m, energy;
};

/// The six cells i-2 .. i+3 around face i+1/2 as the flux sees them: states and their fluxes.
template <class R>
struct Stencil {
  Triple<R> state[6];
  R flux_m[6], flux_energy[6];  ///< the mass flux is the momentum in `state`
};

/// (-f[-1] + 7 f[0] + 7 f[1] - f[2]) / 12: the linear fourth-order flux.
template <class R>
KOKKOS_INLINE_FUNCTION R central_flux(R f_1, R f0, R f1, R f2) {
  using S = typename device::Access<R>::Element;
  return S(7.0 / 12.0) * (f0 + f1) - S(1.0 / 12.0) * (f_1 + f2);
}

/// One field's correction from both sides, `correction_scale * scale * unit` times: the right-going part sees
/// the first four of the five differences, the left-going part the last four in reverse.
template <Reconstruction scheme, int scale, class R>
KOKKOS_INLINE_FUNCTION R field_correction(const R (&df)[5], const R (&du)[5], R alpha, R unit) {
  const R right_going = correction<scheme, scale, R>(df[0] + alpha * du[0], df[1] + alpha * du[1],
                                                     df[2] + alpha * du[2], df[3] + alpha * du[3], unit);
  const R left_going = correction<scheme, scale, R>(df[4] - alpha * du[4], df[3] - alpha * du[3],
                                                    df[2] - alpha * du[2], df[1] - alpha * du[1], unit);
  return right_going - left_going;
}

/// Characteristic finite-difference WENO5 flux at a face in difference form (gas.md section 2; Jiang and Shu
/// 1996, section 2): the central flux minus the projected nonlinear corrections.
///
/// `N` is the type of all that is nonlinear: R itself, or its single-precision twin for split precision.
template <Reconstruction scheme, class N, class R>
KOKKOS_INLINE_FUNCTION Triple<R> weno5_face(const Stencil<R>& s, const Eigensystem<N>& e,
                                            const Speeds<N>& alpha) {
  using To = device::Convert<N>;
  N slow_u[5], slow_f[5], entropy_u[5], entropy_f[5], fast_u[5], fast_f[5];
  for (int k = 0; k < 5; ++k) {
    const Triple<R>&left = s.state[k], &right = s.state[k + 1];
    const N d_m = To::from(right.m - left.m);
    const Characteristic<N> u =
        project(e, To::from(right.rho - left.rho), d_m, To::from(right.energy - left.energy));
    const Characteristic<N> f = project(e, d_m, To::from(s.flux_m[k + 1] - s.flux_m[k]),
                                        To::from(s.flux_energy[k + 1] - s.flux_energy[k]));
    slow_u[k] = u.slow, entropy_u[k] = u.entropy, fast_u[k] = u.fast;
    slow_f[k] = f.slow, entropy_f[k] = f.entropy, fast_f[k] = f.fast;
  }
  using F = typename device::Access<N>::Element;
  const N k1 = field_correction<scheme, acoustic_scale>(slow_f, slow_u, alpha.slow, e.unit);
  const N k2 = F(1.0 / (correction_scale * entropy_scale)) *
               field_correction<scheme, entropy_scale>(entropy_f, entropy_u, alpha.entropy, N(F(1)));
  const N k3 = field_correction<scheme, acoustic_scale>(fast_f, fast_u, alpha.fast, e.unit);
  const N acoustic = F(1.0 / (correction_scale * acoustic_scale)) * e.inverse_unit;
  const N sum = acoustic * (k1 + k3), difference = acoustic * e.c * (k3 - k1);
  using Back = device::Convert<R>;
  const Triple<R>* u = s.state;
  return {central_flux(u[1].m, u[2].m, u[3].m, u[4].m) - Back::from(sum + k2),
          central_flux(s.flux_m[1], s.flux_m[2], s.flux_m[3], s.flux_m[4]) -
              Back::from(e.u * (sum + k2) + difference),
          central_flux(s.flux_energy[1], s.flux_energy[2], s.flux_energy[3], s.flux_energy[4]) -
              Back::from(e.enthalpy * sum + e.kinetic * k2 + e.u * difference)};
}

}  // namespace drogue::gas
