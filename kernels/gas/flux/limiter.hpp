#pragma once

#include "kernels/gas/flux/face_flux.hpp"

namespace drogue::gas {

/// Minimum density and pressure of limited cells, in the units of the scene (Hu, Adams and Shu 2013 use
/// 1e-13).
inline constexpr double positivity_floor = 1e-13;

/// First-order Lax-Friedrichs flux with a single alpha, m/s.
template <class R>
KOKKOS_INLINE_FUNCTION ConservedVector<R> lax_friedrichs(const ConservedVector<R>& ul, R ml, R el,
                                                         const ConservedVector<R>& ur, R mr, R er, R alpha) {
  using S = typename device::Access<R>::Element;
  return {S(0.5) * (ul.m + ur.m + alpha * (ul.rho - ur.rho)), S(0.5) * (ml + mr + alpha * (ul.m - ur.m)),
          S(0.5) * (el + er + alpha * (ul.energy - ur.energy))};
}

/// Largest theta in [0, 1] with low + theta (high - low) >= floor, for low >= floor.
template <class R>
KOKKOS_INLINE_FUNCTION R blend(R low, R high) {
  using S = typename device::Access<R>::Element;
  const R theta = (low - S(positivity_floor)) / (low - high);
  return device::select(high < R(S(positivity_floor)), device::maximum(R(S(0)), theta), R(S(1)));
}

/// State after one face's share of the update: u + weight * flux.
template <class R, class S>
KOKKOS_INLINE_FUNCTION ConservedVector<R> partial_update(const ConservedVector<R>& u, S weight,
                                                         const ConservedVector<R>& flux) {
  return {u.rho + weight * flux.rho, u.m + weight * flux.m, u.energy + weight * flux.energy};
}

/// True if density and pressure of U_i - 2 lambda F and U_{i+1} + 2 lambda F stay above the floor. Needs no
/// division.
template <class R, class S>
KOKKOS_INLINE_FUNCTION auto keeps_positive(const ConservedVector<R>& ul, const ConservedVector<R>& ur,
                                           const ConservedVector<R>& flux, S two_lambda, S gamma) {
  const R floor = S(positivity_floor);
  const auto positive = [&](const ConservedVector<R>& u) {
    const R internal = (gamma - S(1)) * (u.rho * u.energy - S(0.5) * (u.m * u.m));
    return (u.rho >= floor) & (internal >= floor * u.rho);
  };
  return positive(partial_update(ul, -two_lambda, flux)) & positive(partial_update(ur, two_lambda, flux));
}

template <class R>
struct LimitedFlux {
  ConservedVector<R> flux;
  R theta;  ///< < 1 if the limiter changed the flux
};

/// Positivity-preserving flux of Hu, Adams and Shu 2013 (arXiv 1203.1540, section 2.2). Blends `high` with
/// `low` so that density, then pressure, of U_i - 2 lambda F and U_{i+1} + 2 lambda F stay positive.
/// `two_lambda` is 2 dt/dx of the Euler step of the stage, s/m. The guarantee holds for lambda alpha <= 1/2
/// with alpha at least the wave speeds of both cells.
template <class R, class S>
KOKKOS_INLINE_FUNCTION LimitedFlux<R> limit(const ConservedVector<R>& ul, const ConservedVector<R>& ur,
                                            const ConservedVector<R>& high, const ConservedVector<R>& low,
                                            S two_lambda, S gamma) {
  const auto pressure_of = [&](const ConservedVector<R>& u) {
    return pressure(gamma, u.m, u.energy, u.m / u.rho);
  };
  const auto mixed = [&](R theta, const ConservedVector<R>& f) -> ConservedVector<R> {
    return {low.rho + theta * (f.rho - low.rho), low.m + theta * (f.m - low.m),
            low.energy + theta * (f.energy - low.energy)};
  };
  const ConservedVector<R> low_l = partial_update(ul, -two_lambda, low),
                           low_r = partial_update(ur, two_lambda, low);
  const R theta_rho = device::minimum(blend(low_l.rho, partial_update(ul, -two_lambda, high).rho),
                                      blend(low_r.rho, partial_update(ur, two_lambda, high).rho));
  const ConservedVector<R> dense = mixed(theta_rho, high);
  // Pressure is concave along the blend, so linear interpolation between its end values is a safe bound.
  const R theta_p =
      device::minimum(blend(pressure_of(low_l), pressure_of(partial_update(ul, -two_lambda, dense))),
                      blend(pressure_of(low_r), pressure_of(partial_update(ur, two_lambda, dense))));
  const R theta =
      device::select(keeps_positive(ul, ur, high, two_lambda, gamma), R(S(1)), theta_rho * theta_p);
  const auto limited_cells = theta < R(S(1));
  const ConservedVector<R> blended = mixed(theta_p, dense);
  return {
      {device::select(limited_cells, blended.rho, high.rho), device::select(limited_cells, blended.m, high.m),
       device::select(limited_cells, blended.energy, high.energy)},
      theta};
}

}  // namespace drogue::gas
