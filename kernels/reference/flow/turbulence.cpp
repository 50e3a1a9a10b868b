#include "kernels/reference/flow/turbulence.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::reference {
namespace {

using Tensor = std::array<std::array<double, 3>, 3>;

GridIndex shifted(GridIndex index, std::size_t axis, int by) {
  index[axis] += by;
  return index;
}

/// Derivatives of the velocity components (first index) along the axes at the centre of a cell, 1/s: means of
/// the differences of velocities at the centres on both sides.
Tensor gradient_at(const FlowDomain& domain, const StaggeredField& u, const GridIndex& cell, double time) {
  const auto at_centre = [&](std::size_t c, const GridIndex& of) {
    return 0.5 * (domain.velocity(u, c, of, time) + domain.velocity(u, c, shifted(of, c, 1), time));
  };
  /// Derivative on the low face of a cell.
  const auto slope = [&](std::size_t c, std::size_t axis, const GridIndex& of) {
    return (at_centre(c, of) - at_centre(c, shifted(of, axis, -1))) / domain.distance(axis, of[axis]);
  };
  Tensor gradient{};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (domain.cells(axis) == 1) continue;
      gradient[c][axis] =
          axis == c ? (domain.velocity(u, c, shifted(cell, c, 1), time) - domain.velocity(u, c, cell, time)) /
                          domain.width(axis, cell[axis])
                    : 0.5 * (slope(c, axis, shifted(cell, axis, 1)) + slope(c, axis, cell));
    }
  return gradient;
}

/// Sum of the products of all entries.
double contraction(const Tensor& a, const Tensor& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) sum += a[i][j] * b[i][j];
  return sum;
}

double smagorinsky(const FlowDomain& domain, const GridIndex& cell, const Tensor& gradient, double constant) {
  double volume = 1.0, axes = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (domain.cells(axis) > 1) {
      volume *= domain.width(axis, cell[axis]);
      axes += 1.0;
    }
  Tensor strain{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) strain[i][j] = 0.5 * (gradient[i][j] + gradient[j][i]);
  return std::pow(constant * std::pow(volume, 1.0 / axes), 2) * std::sqrt(2.0 * contraction(strain, strain));
}

double vreman(const FlowDomain& domain, const GridIndex& cell, const Tensor& gradient, double constant) {
  Tensor beta{};
  double trace = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t m = 0; m < 3; ++m)
        beta[i][j] += std::pow(domain.width(m, cell[m]), 2) * gradient[i][m] * gradient[j][m];
    trace += beta[i][i];
  }
  // The sum of the principal minors of a symmetric tensor.
  const double minors = 0.5 * (trace * trace - contraction(beta, beta));
  const double norm = contraction(gradient, gradient);
  return norm > 0.0 ? constant * std::sqrt(std::max(0.0, minors) / norm) : 0.0;
}

}  // namespace

std::vector<double> eddy_viscosity(const FlowDomain& domain, const StaggeredField& u, double time) {
  const flow::Parameters& p = domain.parameters();
  std::vector<double> viscosity;
  domain.for_each_cell([&](const GridIndex& cell) {
    const Tensor gradient = gradient_at(domain, u, cell, time);
    const auto constant = [&](double standard) {
      return p.turbulence_constant > 0.0 ? p.turbulence_constant : standard;
    };
    if (p.turbulence == flow::Turbulence::smagorinsky)
      viscosity.push_back(smagorinsky(domain, cell, gradient, constant(0.17)));
    else
      viscosity.push_back(
          p.turbulence == flow::Turbulence::vreman ? vreman(domain, cell, gradient, constant(0.07)) : 0.0);
  });
  return viscosity;
}

StaggeredField eddy_acceleration(const FlowDomain& domain, const StaggeredField& u, double time) {
  const std::vector<double> viscosity = eddy_viscosity(domain, u, time);
  const auto at_cell = [&](GridIndex cell) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int n = domain.cells(axis);
      cell[axis] = domain.is_bounded(axis) ? std::clamp(cell[axis], 0, n - 1) : (cell[axis] + n) % n;
    }
    return viscosity[domain.cell_at(cell)];
  };
  /// Difference of a component from that before it along an axis over their distance, 1/s.
  const auto difference = [&](std::size_t c, std::size_t axis, const GridIndex& at) {
    if (domain.cells(axis) == 1) return 0.0;
    return (domain.velocity(u, c, at, time) - domain.velocity(u, c, shifted(at, axis, -1), time)) /
           domain.step(c, axis, at[axis]);
  };
  /// Stress of component c on the face normal to an axis between a face and the one before it, m^2/s^2.
  const auto stress = [&](std::size_t c, std::size_t axis, const GridIndex& face) {
    if (c == axis) return 2.0 * at_cell(shifted(face, c, -1)) * difference(c, c, face);
    const GridIndex before = shifted(face, c, -1);
    const double mean = 0.25 * (at_cell(face) + at_cell(shifted(face, axis, -1)) + at_cell(before) +
                                at_cell(shifted(before, axis, -1)));
    return mean * (difference(c, axis, face) + difference(axis, c, face));
  };
  StaggeredField acceleration = domain.zero_field();
  domain.for_each_face([&](std::size_t c, const GridIndex& face) {
    if (domain.side_of(c, face) >= 0) return;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (domain.cells(axis) > 1)
        acceleration[c][domain.at(c, face)] +=
            (stress(c, axis, shifted(face, axis, 1)) - stress(c, axis, face)) /
            domain.extent(c, axis, face[axis]);
  });
  return acceleration;
}

}  // namespace drogue::reference
