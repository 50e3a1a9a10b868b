#pragma once

#include "kernels/gas/face_flux.hpp"

namespace drogue::gas {

/// Density and pressure that limited cells keep, in the scene's own units (Hu, Adams and Shu 2013 use 1e-13).
inline constexpr double positivity_floor = 1e-13;

/// First-order Lax-Friedrichs flux with one alpha.
template <class R>
KOKKOS_INLINE_FUNCTION Triple<R> lax_friedrichs(const Triple<R>& ul, R ml, R el, const Triple<R>& ur, R mr,
                                                R er, R alpha) {
  using S = typename device::Access<R>::Element;
  return {S(0.5) * (ul.m + ur.m + alpha * (ul.rho - ur.rho)), S(0.5) * (ml + mr + alpha * (ul.m - ur.m)),
          S(0.5) * (el + er + alpha * (ul.energy - ur.energy))};
}

/// Largest theta in [0, 1] for which low + theta (high - low) >= floor, given low >= floor.
template <class R>
KOKKOS_INLINE_FUNCTION R blend(R low, R high) {
  using S = typename device::Access<R>::Element;
  const R theta = (low - S(positivity_floor)) / (low - high);
  return device::select(high < R(S(positivity_floor)), device::maximum(R(S(0)), theta), R(S(1)));
}

/// What is left of a state when its cell's share of an update, `weight` times a flux, is added.
template <class R, class S>
KOKKOS_INLINE_FUNCTION Triple<R> shifted(const Triple<R>& u, S weight, const Triple<R>& flux) {
  return {u.rho + weight * flux.rho, u.m + weight * flux.m, u.energy + weight * flux.energy};
}

/// Whether a flux leaves density and pressure of U_i - 2 lambda F and U_{i+1} + 2 lambda F above the floor,
/// without a division.
template <class R, class S>
KOKKOS_INLINE_FUNCTION auto is_harmless(const Triple<R>& ul, const Triple<R>& ur, const Triple<R>& flux,
                                        S two_lambda, S gamma) {
  const R floor = S(positivity_floor);
  const auto positive = [&](const Triple<R>& u) {
    const R internal = (gamma - S(1)) * (u.rho * u.energy - S(0.5) * (u.m * u.m));
    return (u.rho >= floor) & (internal >= floor * u.rho);
  };
  return positive(shifted(ul, -two_lambda, flux)) & positive(shifted(ur, two_lambda, flux));
}

template <class R>
struct LimitedFlux {
  Triple<R> flux;
  R theta;  ///< < 1 where the limiter acted
};

/// Positivity-preserving flux of Hu, Adams and Shu 2013 (arXiv 1203.1540, section 2.2): the part of the
/// high-order flux over `low` that leaves density, then pressure, of U_i - 2 lambda F and U_{i+1} + 2 lambda
/// F positive. `two_lambda` is 2 dt/dx of the stage's Euler step; the guarantee needs lambda alpha <= 1/2
/// with an alpha that no signal of the two cells exceeds.
template <class R, class S>
KOKKOS_INLINE_FUNCTION LimitedFlux<R> limit(const Triple<R>& ul, const Triple<R>& ur, const Triple<R>& high,
                                            const Triple<R>& low, S two_lambda, S gamma) {
  const auto pressure_of = [&](const Triple<R>& u) { return pressure(gamma, u.m, u.energy, u.m / u.rho); };
  const auto mixed = [&](R theta, const Triple<R>& f) -> Triple<R> {
    return {low.rho + theta * (f.rho - low.rho), low.m + theta * (f.m - low.m),
            low.energy + theta * (f.energy - low.energy)};
  };
  const Triple<R> low_l = shifted(ul, -two_lambda, low), low_r = shifted(ur, two_lambda, low);
  const R theta_rho = device::minimum(blend(low_l.rho, shifted(ul, -two_lambda, high).rho),
                                      blend(low_r.rho, shifted(ur, two_lambda, high).rho));
  const Triple<R> dense = mixed(theta_rho, high);
  // Pressure is concave along the blend: the straight line between its end values is a safe bound.
  const R theta_p = device::minimum(blend(pressure_of(low_l), pressure_of(shifted(ul, -two_lambda, dense))),
                                    blend(pressure_of(low_r), pressure_of(shifted(ur, two_lambda, dense))));
  const R theta = device::select(is_harmless(ul, ur, high, two_lambda, gamma), R(S(1)), theta_rho * theta_p);
  const auto touched = theta < R(S(1));
  const Triple<R> blended = mixed(theta_p, dense);
  return {{device::select(touched, blended.rho, high.rho), device::select(touched, blended.m, high.m),
           device::select(touched, blended.energy, high.energy)},
          theta};
}

}  // namespace drogue::gas
