#pragma once

#include "kernels/gas/face_flux.hpp"

namespace drogue::gas {

/// Density and pressure that limited cells keep, in the scene's own units (Hu, Adams and Shu 2013 use 1e-13).
inline constexpr double positivity_floor = 1e-13;

/// First-order Lax-Friedrichs flux with one alpha.
template <class R, class S>
KOKKOS_INLINE_FUNCTION Triple<R> lax_friedrichs(const Triple<R>& ul, R ml, R el, const Triple<R>& ur, R mr,
                                                R er, S alpha) {
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

template <class R>
struct LimitedFlux {
  Triple<R> flux;
  R theta;  ///< < 1 where the limiter acted
};

/// Positivity-preserving flux of Hu, Adams and Shu 2013 (arXiv 1203.1540, section 2.2): the part of the
/// high-order flux over `low` that leaves density, then pressure, of U_i - 2 lambda F and U_{i+1} + 2 lambda
/// F positive. `two_lambda` is 2 dt/dx of the stage's Euler step; the guarantee needs lambda alpha <= 1/2.
template <class R, class S>
KOKKOS_INLINE_FUNCTION LimitedFlux<R> limit(const Triple<R>& ul, const Triple<R>& ur, const Triple<R>& high,
                                            const Triple<R>& low, S two_lambda, S gamma) {
  const auto shifted = [&](const Triple<R>& u, const Triple<R>& f, S sign) -> Triple<R> {
    const S w = sign * two_lambda;
    return {u.rho + w * f.rho, u.m + w * f.m, u.energy + w * f.energy};
  };
  const auto pressure_of = [&](const Triple<R>& u) { return pressure(gamma, u.m, u.energy, u.m / u.rho); };
  const auto mixed = [&](R theta, const Triple<R>& f) -> Triple<R> {
    return {low.rho + theta * (f.rho - low.rho), low.m + theta * (f.m - low.m),
            low.energy + theta * (f.energy - low.energy)};
  };
  const Triple<R> low_l = shifted(ul, low, S(-1)), low_r = shifted(ur, low, S(1));
  const R theta_rho = device::minimum(blend(low_l.rho, shifted(ul, high, S(-1)).rho),
                                      blend(low_r.rho, shifted(ur, high, S(1)).rho));
  const Triple<R> dense = mixed(theta_rho, high);
  // Pressure is concave along the blend: the straight line between its end values is a safe bound.
  const R theta_p = device::minimum(blend(pressure_of(low_l), pressure_of(shifted(ul, dense, S(-1)))),
                                    blend(pressure_of(low_r), pressure_of(shifted(ur, dense, S(1)))));
  const R theta = theta_rho * theta_p;
  const auto touched = theta < R(S(1));
  const Triple<R> blended = mixed(theta_p, dense);
  return {{device::select(touched, blended.rho, high.rho), device::select(touched, blended.m, high.m),
           device::select(touched, blended.energy, high.energy)},
          theta};
}

}  // namespace drogue::gas
