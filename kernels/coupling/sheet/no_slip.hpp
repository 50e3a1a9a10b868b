#pragma once

#include "kernels/coupling/sheet/porous_law.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::coupling {

/// Product of the components of two vectors.
KOKKOS_INLINE_FUNCTION spatial::Point product(const spatial::Point& a, const spatial::Point& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// Impulse per area, Pa s, of a sheet without slip on the air during tau, s, which the air returns. `w` is
/// the velocity of the sheet relative to the air before, m/s, `normal` a unit vector. One impulse per area
/// along an axis changes the relative velocity by that component of `inverse_mass`, m^2/kg, > 0.
///
/// Solves w1 = w - inverse_mass I = s n for I, whose normal component n I = tau (alpha + beta |s|) s obeys
/// the porous law: no tangential velocity remains. Eliminating I leaves the equation of `porous_impulse` with
/// the mass n / inverse_mass n. Does not throw.
KOKKOS_INLINE_FUNCTION spatial::Point no_slip_impulse(const PorousLaw& law, const spatial::Point& normal,
                                                      const spatial::Point& w, double tau,
                                                      const spatial::Point& inverse_mass) {
  const spatial::Point mass{1.0 / inverse_mass.x, 1.0 / inverse_mass.y, 1.0 / inverse_mass.z};
  const spatial::Point all = product(mass, w);
  const double normal_mass = dot(normal, product(mass, normal));
  if (law.impermeable || !(normal_mass > 0.0)) return all;
  const double mean = dot(normal, all) / normal_mass,
               through = mean - porous_impulse(law, mean, tau, 1.0 / normal_mass) / normal_mass;
  return all - through * product(mass, normal);
}

}  // namespace drogue::coupling
