#include "kernels/reference/flow/momentum.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/reference/flow/turbulence.hpp"

namespace drogue::reference {

using flow::Advection;
using flow::BoundaryKind;

double upwind_value(const std::array<double, 5>& q, Advection scheme) {
  const auto square = [](double x) { return x * x; };
  const double candidate[3] = {(2.0 * q[0] - 7.0 * q[1] + 11.0 * q[2]) / 6.0,
                               (-q[1] + 5.0 * q[2] + 2.0 * q[3]) / 6.0,
                               (2.0 * q[2] + 5.0 * q[3] - q[4]) / 6.0};
  const double beta[3] = {
      13.0 / 12.0 * square(q[0] - 2.0 * q[1] + q[2]) + 0.25 * square(q[0] - 4.0 * q[1] + 3.0 * q[2]),
      13.0 / 12.0 * square(q[1] - 2.0 * q[2] + q[3]) + 0.25 * square(q[1] - q[3]),
      13.0 / 12.0 * square(q[2] - 2.0 * q[3] + q[4]) + 0.25 * square(3.0 * q[2] - 4.0 * q[3] + q[4])};
  const double linear[3] = {0.1, 0.6, 0.3}, epsilon = 1e-40, tau = std::abs(beta[0] - beta[2]);
  double sum = 0.0, value = 0.0;
  for (std::size_t s = 0; s < 3; ++s) {
    const double weight = scheme == Advection::weno_js ? linear[s] / square(epsilon + beta[s])
                                                       : linear[s] * (1.0 + tau / (epsilon + beta[s]));
    sum += weight;
    value += weight * candidate[s];
  }
  return value / sum;
}

double momentum_flux(const FlowDomain& domain, const StaggeredField& u, std::size_t c, std::size_t d,
                     const GridIndex& face, double time) {
  const auto carried = [&](int offset) {
    GridIndex at = face;
    at[d] += offset;
    return domain.velocity(u, c, at, time);
  };
  GridIndex before = face;
  before[c] -= 1;
  const double speed = 0.5 * (domain.velocity(u, d, before, time) + domain.velocity(u, d, face, time));
  const double viscous = domain.parameters().viscosity / domain.parameters().density *
                         (carried(0) - carried(-1)) / domain.spacing(d);
  if (domain.parameters().advection == Advection::central)
    return speed * 0.5 * (carried(-1) + carried(0)) - viscous;
  std::array<double, 5> q{};
  for (int m = 0; m < 5; ++m) q[static_cast<std::size_t>(m)] = carried(speed > 0.0 ? m - 3 : 2 - m);
  return speed * upwind_value(q, domain.parameters().advection) - viscous;
}

StaggeredField momentum_rate(const FlowDomain& domain, const StaggeredField& u, double time) {
  const flow::Parameters& p = domain.parameters();
  StaggeredField rate = eddy_acceleration(domain, u, time);
  domain.for_each_face([&](std::size_t c, const GridIndex& face) {
    double& result = rate[c][domain.at(c, face)];
    const double acceleration = (p.body_force[c] + p.pressure_drop[c] / (p.high[c] - p.low[c])) / p.density;
    const int side = domain.side_of(c, face);
    if (side < 0) {
      result += acceleration;
      for (std::size_t d = 0; d < 3; ++d) {
        if (domain.cells(d) == 1) continue;
        GridIndex next = face;
        next[d] += 1;
        result -= (momentum_flux(domain, u, c, d, next, time) - momentum_flux(domain, u, c, d, face, time)) /
                  domain.spacing(d);
      }
    } else if (p.boundary[static_cast<std::size_t>(side)].kind == BoundaryKind::outflow) {
      GridIndex inner = face;
      inner[c] += side % 2 == 0 ? 1 : -1;
      const double own = u[c][domain.at(c, face)];
      const double outward = std::max(0.0, side % 2 == 0 ? -own : own);
      result = acceleration - outward * (own - u[c][domain.at(c, inner)]) / domain.spacing(c);
    }
  });
  return rate;
}

StaggeredField viscous_rate(const FlowDomain& domain, const StaggeredField& u, double time,
                            bool outflows_have_shear) {
  const double nu = domain.parameters().viscosity / domain.parameters().density;
  StaggeredField rate = domain.zero_field();
  domain.for_each_face([&](std::size_t c, const GridIndex& face) {
    if (domain.side_of(c, face) >= 0) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (domain.cells(axis) == 1) continue;
      GridIndex low = face, high = face;
      --low[axis];
      ++high[axis];
      if (!outflows_have_shear && axis != c) {
        if (face[axis] == 0 && domain.kind(2 * axis) == BoundaryKind::outflow) low = face;
        if (high[axis] == domain.cells(axis) && domain.kind(2 * axis + 1) == BoundaryKind::outflow)
          high = face;
      }
      rate[c][domain.at(c, face)] += nu *
                                     (domain.velocity(u, c, low, time) - 2.0 * u[c][domain.at(c, face)] +
                                      domain.velocity(u, c, high, time)) /
                                     (domain.spacing(axis) * domain.spacing(axis));
    }
  });
  return rate;
}

}  // namespace drogue::reference
