#include "kernels/reference/flow/observables.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::reference {

namespace {

GridIndex shifted(const FlowDomain& domain, GridIndex index, std::size_t axis, int steps) {
  if (domain.cells(axis) > 1) index[axis] += steps;
  return index;
}

/// Derivative of component i along another axis j at the edge of `cell` at its low sides along both.
double edge_derivative(const FlowDomain& domain, const StaggeredField& u, std::size_t i, std::size_t j,
                       const GridIndex& cell, double time) {
  return (domain.velocity(u, i, cell, time) - domain.velocity(u, i, shifted(domain, cell, j, -1), time)) /
         domain.distance(j, cell[j]);
}

/// The four edges of a cell that are normal to axes i and j, as cells whose low edges they are.
std::array<GridIndex, 4> edges(const FlowDomain& domain, const GridIndex& cell, std::size_t i,
                               std::size_t j) {
  const GridIndex next = shifted(domain, cell, i, 1);
  return {cell, next, shifted(domain, cell, j, 1), shifted(domain, next, j, 1)};
}

/// Derivative of component i along its own axis at the centre of a cell.
double normal_derivative(const FlowDomain& domain, const StaggeredField& u, std::size_t i,
                         const GridIndex& cell, double time) {
  return (domain.velocity(u, i, shifted(domain, cell, i, 1), time) - domain.velocity(u, i, cell, time)) /
         domain.width(i, cell[i]);
}

}  // namespace

std::array<Point, 3> velocity_gradient(const FlowDomain& domain, const StaggeredField& u,
                                       const GridIndex& cell, double time) {
  std::array<Point, 3> gradient{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      if (i == j) {
        gradient[i][i] = normal_derivative(domain, u, i, cell, time);
        continue;
      }
      for (const GridIndex& edge : edges(domain, cell, i, j))
        gradient[i][j] += 0.25 * edge_derivative(domain, u, i, j, edge, time);
    }
  return gradient;
}

FlowSums flow_sums(const FlowDomain& domain, const StaggeredField& u, double time) {
  const flow::Parameters& p = domain.parameters();
  FlowSums sums;
  domain.for_each_cell([&](const GridIndex& cell) {
    const double volume = domain.volume(cell);
    double squared_speed = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double low = domain.velocity(u, c, cell, time),
                   high = domain.velocity(u, c, shifted(domain, cell, c, 1), time);
      sums.kinetic_energy += 0.25 * p.density * volume * (low * low + high * high);
      sums.momentum[c] += 0.5 * p.density * volume * (low + high);
      squared_speed += 0.25 * (low + high) * (low + high);
      const double stretching = normal_derivative(domain, u, c, cell, time);
      sums.dissipation += 2.0 * p.viscosity * volume * stretching * stretching;
      const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
      for (const GridIndex& edge : edges(domain, cell, a, b)) {
        const double ba = edge_derivative(domain, u, b, a, edge, time),
                     ab = edge_derivative(domain, u, a, b, edge, time);
        sums.enstrophy += 0.5 * 0.25 * volume * (ba - ab) * (ba - ab);
        // Twice the viscosity times two equal shear rates (ab + ba) / 2.
        sums.dissipation += 0.25 * p.viscosity * volume * (ba + ab) * (ba + ab);
      }
    }
    sums.max_speed = std::max(sums.max_speed, std::sqrt(squared_speed));
  });
  domain.for_each_face([&](std::size_t c, const GridIndex& face) {
    const int side = domain.side_of(c, face);
    if (side < 0) return;
    double area = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (axis != c) area *= domain.width(axis, face[axis]);
    sums.outflow[static_cast<std::size_t>(side)] +=
        (side % 2 == 0 ? -1.0 : 1.0) * u[c][domain.at(c, face)] * area;
  });
  return sums;
}

}  // namespace drogue::reference
