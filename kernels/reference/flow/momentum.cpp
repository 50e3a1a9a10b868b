#include "kernels/reference/flow/momentum.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

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
  const double linear[3] = {0.1, 0.6, 0.3}, epsilon = 1e-72, tau = std::abs(beta[0] - beta[2]);
  const auto weight_of = [&](std::size_t s) {
    switch (scheme) {
      case Advection::weno_js:
        return linear[s] / square(epsilon + beta[s]);
      case Advection::weno_z:
        return linear[s] * (1.0 + tau / (epsilon + beta[s]));
      case Advection::central:
        break;
    }
    throw std::invalid_argument("no weights of this scheme");
  };
  double sum = 0.0, value = 0.0;
  for (std::size_t s = 0; s < 3; ++s) {
    const double weight = weight_of(s);
    sum += weight;
    value += weight * candidate[s];
  }
  return value / sum;
}

namespace {

/// Outflow on which a face normal to axis d lies; -1: none.
int outflow_at(const FlowDomain& domain, std::size_t d, const GridIndex& face) {
  const int side = domain.side_of(d, face);
  return side >= 0 && domain.kind(static_cast<std::size_t>(side)) == BoundaryKind::outflow ? side : -1;
}

/// Rate of change of the normal velocity on an outflow without forces, m/s^2: advection, and the pressure on
/// the face over half a cell.
double outflow_rate(const FlowDomain& domain, const StaggeredField& u, std::size_t side,
                    const GridIndex& face, double time) {
  const bool central = !flow::is_upwind(domain.parameters().advection);
  const std::size_t c = side / 2;
  const int inward = side % 2 == 0 ? 1 : -1;
  GridIndex inner = face, cell = face;
  inner[c] += inward;
  if (side % 2 == 1) --cell[c];
  const double own = u[c][domain.at(c, face)], entering = inward * own;
  // Normal advection. Fluid that enters has no inner upwind value; central fluxes carry the mean.
  const double other = u[c][domain.at(c, inner)];
  const double carrier = entering < 0.0 ? own : central ? 0.5 * (own + other) : 0.0;
  const double width = domain.width(c, cell[c]);
  double rate = -carrier * (other - own) * inward / width;
  if (entering > 0.0) {
    const double still = std::max(0.0, inward * domain.parameters().boundary[side].velocity[c]);
    rate += inward * 0.5 * (still * still - own * own) / (0.5 * width);
  }
  // Advection along the side by the velocities of the cell, without its divergence along the side.
  for (std::size_t d = 0; d < 3; ++d) {
    if (d == c || domain.cells(d) == 1) continue;
    for (const int high : {0, 1}) {
      GridIndex carrying = cell, beyond = face;
      carrying[d] += high;
      beyond[d] += 2 * high - 1;
      const double into = domain.velocity(u, d, carrying, time) * (1 - 2 * high);
      const int end = outflow_at(domain, d, carrying);
      const double neighbour = end >= 0
                                   ? domain.parameters().boundary[static_cast<std::size_t>(end)].velocity[c]
                                   : domain.velocity(u, c, beyond, time);
      rate += (central && end < 0 ? 0.5 * into : std::max(0.0, into)) * (neighbour - own) /
              domain.width(d, cell[d]);
    }
  }
  return rate;
}

}  // namespace

double momentum_flux(const FlowDomain& domain, const StaggeredField& u, std::size_t c, std::size_t d,
                     const GridIndex& face, double time) {
  const auto carried = [&](int offset) {
    GridIndex at = face;
    at[d] += offset;
    return domain.velocity(u, c, at, time);
  };
  GridIndex before = face;
  before[c] -= 1;
  // Across its own axis, a control volume consists of half a cell on each side of the face.
  const double first = c == d ? 1.0 : domain.width(c, before[c]),
               second = c == d ? 1.0 : domain.width(c, face[c]);
  const double speed =
      (first * domain.velocity(u, d, before, time) + second * domain.velocity(u, d, face, time)) /
      (first + second);
  if (const int side = outflow_at(domain, d, face); side >= 0 && c != d && (side % 2 == 0) == (speed > 0.0))
    return speed * domain.parameters().boundary[static_cast<std::size_t>(side)].velocity[c];
  const double viscous = domain.parameters().viscosity / domain.parameters().density *
                         (carried(0) - carried(-1)) / domain.step(c, d, face[d]);
  const Advection scheme = domain.parameters().advection;
  const auto value = [&] {
    switch (scheme) {
      case Advection::central:
        return 0.5 * (carried(-1) + carried(0));
      case Advection::weno_js:
      case Advection::weno_z: {
        std::array<double, 5> q{};
        for (int m = 0; m < 5; ++m) q[static_cast<std::size_t>(m)] = carried(speed > 0.0 ? m - 3 : 2 - m);
        return upwind_value(q, scheme);
      }
    }
    throw std::invalid_argument("unknown advection scheme");
  };
  return speed * value() - viscous;
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
                  domain.extent(c, d, face[d]);
      }
    } else if (p.boundary[static_cast<std::size_t>(side)].kind == BoundaryKind::outflow) {
      result = acceleration + outflow_rate(domain, u, static_cast<std::size_t>(side), face, time);
    }
  });
  return rate;
}

StaggeredField viscous_rate(const FlowDomain& domain, const StaggeredField& u, double time) {
  const double nu = domain.parameters().viscosity / domain.parameters().density;
  StaggeredField rate = domain.zero_field();
  domain.for_each_face([&](std::size_t c, const GridIndex& face) {
    if (domain.side_of(c, face) >= 0) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (domain.cells(axis) == 1) continue;
      GridIndex low = face, high = face;
      --low[axis];
      ++high[axis];
      const double own = u[c][domain.at(c, face)];
      const double below = (own - domain.velocity(u, c, low, time)) / domain.step(c, axis, face[axis]),
                   above = (domain.velocity(u, c, high, time) - own) / domain.step(c, axis, high[axis]);
      rate[c][domain.at(c, face)] += nu * (above - below) / domain.extent(c, axis, face[axis]);
    }
  });
  return rate;
}

}  // namespace drogue::reference
