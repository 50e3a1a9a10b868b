#pragma once

#include <array>

namespace drogue::reference {

/// Impulse per area, Pa s, that a sheet with the porous law dp = alpha w + beta |w| w gives the air in tau,
/// s, by the backward Euler method, found by bisection. `w` is the relative normal velocity before, m/s;
/// `inverse_mass`, m^2/kg, is the sum of the inverse masses per area of sheet and air.
[[nodiscard]] double porous_impulse(double alpha, double beta, double w, double tau, double inverse_mass);

/// Impulse per area, Pa s, of the same sheet if the air does not slip along it: the relative velocity `w`,
/// m/s, becomes s n with the unit normal n, and n I obeys the law for s, found by bisection. `inverse_mass`,
/// m^2/kg, > 0, along each axis.
[[nodiscard]] std::array<double, 3> no_slip_impulse(double alpha, double beta,
                                                    const std::array<double, 3>& normal,
                                                    const std::array<double, 3>& w, double tau,
                                                    const std::array<double, 3>& inverse_mass);

}  // namespace drogue::reference
