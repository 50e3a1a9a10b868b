#include "miniapps/parachute/canopy/stiffness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/mesh/edges.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Largest singular value of a 2 by 2 matrix by the sum of the squares of its entries and its determinant.
double spectral_norm(double squares, double determinant) {
  const double twice = 2.0 * std::abs(determinant);
  return 0.5 * (std::sqrt(squares + twice) + std::sqrt(std::max(0.0, squares - twice)));
}

/// Row of the stiffness that belongs to a vertex, for Gershgorin's theorem: its own block, the sum of the
/// norms of the others, N/m, and the least height of its triangles, m.
struct StiffnessRow {
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0, others = 0.0;
  double least_height = std::numeric_limits<double>::infinity();

  /// Adds a times the product of v with itself.
  void add_square(double a, const Vector& v) {
    xx += a * v[0] * v[0];
    yy += a * v[1] * v[1];
    zz += a * v[2] * v[2];
    xy += a * v[0] * v[1];
    xz += a * v[0] * v[2];
    yz += a * v[1] * v[2];
  }

  /// Norm of the own block, which acts within the cloth, and those of the others.
  [[nodiscard]] double sum() const {
    const double trace = xx + yy + zz,
                 squares = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + xz * xz + yz * yz);
    return 0.5 * (trace + std::sqrt(std::max(0.0, 2.0 * squares - trace * trace))) + others;
  }
};

/// Stiffness of the membrane at rest: plane stress with the moduli lambda and mu, N/m. With the gradients g
/// of the linear functions of a triangle of area A, block (i, j) is A (lambda g_i g_j^T + mu (g_j g_i^T + g_i
/// g_j)).
std::vector<StiffnessRow> stiffness_rows(const Canopy& canopy, const mesh::Mesh& mesh) {
  const double modulus = canopy.membrane_modulus, poisson = canopy.poisson;
  const double lambda = modulus * poisson / (1.0 - poisson * poisson), mu = 0.5 * modulus / (1.0 + poisson);
  std::vector<StiffnessRow> rows(mesh.rest.size());
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    std::array<Vector, 3> opposite, gradient;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector &from = mesh.rest[static_cast<std::size_t>(triangle[(k + 1) % 3])],
                   &to = mesh.rest[static_cast<std::size_t>(triangle[(k + 2) % 3])];
      opposite[k] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    }
    const Vector twice_area = cross(opposite[0], opposite[1]);
    const double squared = dot(twice_area, twice_area), area = 0.5 * std::sqrt(squared);
    for (std::size_t k = 0; k < 3; ++k) {
      gradient[k] = cross(twice_area, opposite[k]);
      for (double& part : gradient[k]) part /= squared;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      StiffnessRow& row = rows[static_cast<std::size_t>(triangle[i])];
      const double a = std::sqrt(dot(gradient[i], gradient[i]));
      row.least_height = std::min(row.least_height, 1.0 / a);
      // Along the gradient and across it.
      row.add_square(area * (lambda + 2.0 * mu), gradient[i]);
      row.add_square(area * mu / squared, cross(twice_area, gradient[i]));
      for (const std::size_t j : {(i + 1) % 3, (i + 2) % 3}) {
        const double along = dot(gradient[i], gradient[j]),
                     across = dot(twice_area, cross(gradient[i], gradient[j])) / (2.0 * area);
        const double first = (lambda + 2.0 * mu) * along, second = lambda * across, third = mu * across,
                     fourth = mu * along;
        row.others += area * spectral_norm(first * first + second * second + third * third + fourth * fourth,
                                           first * fourth - second * third);
      }
    }
  }
  return rows;
}

/// The cloth by its stiffest vertex. Triangles much smaller than `edge_length` are due to the vent.
StiffPart cloth_part(const Canopy& canopy, const fabric::Parameters& p) {
  constexpr double much_smaller = 0.125;
  StiffPart part = {"membrane_modulus", canopy.membrane_modulus, "N/m"};
  const std::vector<StiffnessRow> rows = stiffness_rows(canopy, p.mesh);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (p.pinned[i] == 7 || !(p.mass[i] > 0.0)) continue;
    const double frequency = std::sqrt(rows[i].sum() / p.mass[i]);
    if (!(frequency > part.frequency)) continue;
    const bool by_vent = canopy.vent > 0.0 && rows[i].least_height < much_smaller * canopy.edge_length;
    part = by_vent ? StiffPart{.key = "vent",
                               .value = canopy.vent,
                               .unit = "m",
                               .frequency = frequency,
                               .remedy = "another"}
                   : StiffPart{"membrane_modulus", canopy.membrane_modulus, "N/m", frequency};
  }
  return part;
}

}  // namespace

StiffPart stiffest_part(const Canopy& canopy, const CanopyMesh& mesh) {
  const fabric::Parameters& p = mesh.fabric;
  StiffPart stiffest = cloth_part(canopy, p);
  const auto compare = [&](const std::string& key, double stiffness, int line) {
    const auto k = static_cast<std::size_t>(line);
    double inverse_mass = 0.0;
    for (const int i : p.mesh.lines[k])
      if (const auto end = static_cast<std::size_t>(i); p.pinned[end] != 7) inverse_mass += 1.0 / p.mass[end];
    const double frequency =
        std::sqrt(p.mesh.line_stiffness[k] / mesh::rest_length(p.mesh, k) * inverse_mass);
    if (frequency > stiffest.frequency) stiffest = {key, stiffness, "N", frequency};
  };
  for (const int line : mesh.suspension) compare("lines.stiffness", canopy.lines.stiffness, line);
  if (canopy.reefing)
    for (const int line : mesh.reefing) compare("reefing.stiffness", canopy.reefing->stiffness, line);
  if (canopy.riser && mesh.riser) compare("riser.stiffness", canopy.riser->stiffness, *mesh.riser);
  if (canopy.vent_lines)
    for (const int line : mesh.vent_lines)
      compare("vent_lines.stiffness", canopy.vent_lines->stiffness, line);
  // Bands come before all other lines.
  const int bands = static_cast<int>(p.mesh.lines.size() - mesh.suspension.size() - mesh.reefing.size() -
                                     mesh.vent_lines.size()) -
                    (mesh.riser ? 1 : 0);
  for (int line = 0; line < bands; ++line)
    compare("reinforcement", p.mesh.line_stiffness[static_cast<std::size_t>(line)], line);
  return stiffest;
}

}  // namespace drogue::parachute_app
