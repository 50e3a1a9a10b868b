#include "kernels/reference/coupling/porous_sheet.hpp"

#include <cmath>

namespace drogue::reference {

double porous_impulse(double alpha, double beta, double w, double tau, double inverse_mass) {
  // The impulse lies between none and the one that ends all relative motion.
  using Real = long double;
  const Real sign = w < 0.0 ? -1.0L : 1.0L, speed = std::abs(Real(w));
  const auto impulse_at = [&](Real after) { return tau * (alpha + beta * after) * after; };
  Real low = 0.0L, high = speed;
  for (int k = 0; k < 200; ++k) {
    const Real middle = 0.5L * (low + high);
    (middle + inverse_mass * impulse_at(middle) > speed ? high : low) = middle;
  }
  return static_cast<double>(sign * impulse_at(0.5L * (low + high)));
}

std::array<double, 3> no_slip_impulse(double alpha, double beta, const std::array<double, 3>& normal,
                                      const std::array<double, 3>& w, double tau,
                                      const std::array<double, 3>& inverse_mass) {
  using Real = long double;
  const auto impulse_along = [&](std::size_t axis, Real through) {
    return (w[axis] - through * normal[axis]) / inverse_mass[axis];
  };
  // Normal impulse left over by the law at a speed through the sheet: it falls with that speed.
  const auto excess = [&](Real through) {
    Real sum = -tau * (alpha + beta * std::abs(through)) * through;
    for (std::size_t axis = 0; axis < 3; ++axis) sum += normal[axis] * impulse_along(axis, through);
    return sum;
  };
  Real low = -1.0L, high = 1.0L;
  while (excess(low) < 0.0L) low *= 2.0L;
  while (excess(high) > 0.0L) high *= 2.0L;
  for (int k = 0; k < 300; ++k) {
    const Real middle = 0.5L * (low + high);
    (excess(middle) > 0.0L ? low : high) = middle;
  }
  std::array<double, 3> impulse{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    impulse[axis] = static_cast<double>(impulse_along(axis, 0.5L * (low + high)));
  return impulse;
}

}  // namespace drogue::reference
