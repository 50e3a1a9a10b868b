#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/coupling/sheet/sheet_parameters.hpp"

namespace drogue::coupling {

/// Impulse per area, Pa s, of a sheet on the air during tau, s, which the air returns. `w` is the normal
/// velocity of the sheet relative to the air before, m/s; one impulse per area changes it by `inverse_mass`,
/// m^2/kg, the sum of the inverse masses per area of both. Solves the backward Euler method
///   w1 = w - inverse_mass I,  I = tau (alpha + beta |w1|) w1
/// in closed form, so that steady flow follows the law exactly; zero without mass. Does not throw.
KOKKOS_INLINE_FUNCTION double porous_impulse(const PorousLaw& law, double w, double tau,
                                             double inverse_mass) {
  if (law.impermeable) return inverse_mass > 0.0 ? w / inverse_mass : 0.0;
  const double b = 1.0 + law.alpha * tau * inverse_mass, q = law.beta * tau * inverse_mass;
  const double after = 2.0 * w / (b + Kokkos::sqrt(b * b + 4.0 * q * Kokkos::fabs(w)));
  return tau * (law.alpha + law.beta * Kokkos::fabs(after)) * after;
}

}  // namespace drogue::coupling
