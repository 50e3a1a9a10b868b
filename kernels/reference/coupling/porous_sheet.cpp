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

}  // namespace drogue::reference
