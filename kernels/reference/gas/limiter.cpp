#include "kernels/reference/gas/limiter.hpp"

#include <algorithm>

namespace drogue::reference {

namespace {

/// State after one face's share of the update of its cell.
Conserved share(const Conserved& cell, const Conserved& flux, double signed_lambda) {
  Conserved U{};
  for (std::size_t s = 0; s < 3; ++s) U[s] = cell[s] + 2.0 * signed_lambda * flux[s];
  return U;
}

/// Weight of the high-order flux that keeps a concave quantity above the floor.
double weight(double low, double high) {
  if (high >= positivity_floor) return 1.0;
  if (low <= positivity_floor) return 0.0;
  return (low - positivity_floor) / (low - high);
}

Conserved blend(const Conserved& low, const Conserved& high, double theta) {
  Conserved flux{};
  for (std::size_t s = 0; s < 3; ++s) flux[s] = (1.0 - theta) * low[s] + theta * high[s];
  return flux;
}

}  // namespace

LimitedFlux limit_flux(const Conserved& high, const Conserved& low, const Conserved& a, const Conserved& b,
                       double lambda, double gamma) {
  LimitedFlux result{high, false};
  const Conserved low_a = share(a, low, -lambda);
  const Conserved low_b = share(b, low, lambda);

  const double theta_rho =
      std::min(weight(low_a[0], share(a, high, -lambda)[0]), weight(low_b[0], share(b, high, lambda)[0]));
  if (theta_rho < 1.0) result = {blend(low, high, theta_rho), true};

  const double p_a = pressure(share(a, result.flux, -lambda), gamma);
  const double p_b = pressure(share(b, result.flux, lambda), gamma);
  const double theta_p = std::min(weight(pressure(low_a, gamma), p_a), weight(pressure(low_b, gamma), p_b));
  if (theta_p < 1.0) result = {blend(low, result.flux, theta_p), true};
  return result;
}

}  // namespace drogue::reference
