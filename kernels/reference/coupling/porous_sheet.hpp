#pragma once

namespace drogue::reference {

/// Impulse per area, Pa s, that a sheet with the porous law dp = alpha w + beta |w| w gives the air in tau,
/// s, by the backward Euler method, found by bisection. `w` is the relative normal velocity before, m/s;
/// `inverse_mass`, m^2/kg, is the sum of the inverse masses per area of sheet and air.
[[nodiscard]] double porous_impulse(double alpha, double beta, double w, double tau, double inverse_mass);

}  // namespace drogue::reference
