#include "kernels/reference/coupling/sharp_sheet.hpp"

#include <cmath>

#include "kernels/reference/coupling/porous_sheet.hpp"

namespace drogue::reference {
namespace {

using Real = long double;
using WideVector = std::array<Real, 3>;

WideVector wide_difference(const WideVector& a, const WideVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

WideVector wide_cross(const WideVector& a, const WideVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Real wide_dot(const WideVector& a, const WideVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Triple product of the edges from p.
Real volume(const WideVector& p, const WideVector& a, const WideVector& b, const WideVector& c) {
  return wide_dot(wide_difference(a, p), wide_cross(wide_difference(b, p), wide_difference(c, p)));
}

struct Hit {
  std::size_t component = 0, face = 0, triangle = 0;
  std::array<Real, 3> weight{};
};

}  // namespace

SharpForces sharp_forces(const coupling::StaggeredGrid& grid, const SharpSheet& sheet, const FaceField& air,
                         double density, double dt) {
  std::vector<Hit> hits;
  FaceField count = zero_field(grid);
  const auto corner = [&](std::size_t t, std::size_t k) {
    const Vector& x = sheet.positions[static_cast<std::size_t>(sheet.triangles[t][k])];
    return WideVector{x[0], x[1], x[2]};
  };
  for (std::size_t d = 0; d < 3; ++d) {
    if (grid.cells[d] == 1) continue;
    std::array<int, 3> cell{};
    for (cell[2] = 0; cell[2] < grid.cells[2]; ++cell[2])
      for (cell[1] = 0; cell[1] < grid.cells[1]; ++cell[1])
        for (cell[0] = 0; cell[0] < grid.cells[0]; ++cell[0]) {
          const bool is_last = cell[d] + 1 == grid.cells[d];
          if (is_last && !grid.periodic[d]) continue;
          WideVector from{};
          for (std::size_t a = 0; a < 3; ++a) from[a] = grid.origin[a] + (cell[a] + 0.5L) * grid.spacing[a];
          WideVector to = from;
          to[d] += grid.spacing[d];
          std::array<int, 3> face = cell;
          face[d] = is_last ? 0 : cell[d] + 1;
          const auto at = static_cast<std::size_t>(
              face[0] + faces_along(grid, d, 0) * (face[1] + faces_along(grid, d, 1) * face[2]));
          for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
            const WideVector a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
            if ((volume(from, a, b, c) > 0.0L) == (volume(to, a, b, c) > 0.0L)) continue;
            const Real u = volume(from, to, b, c), v = volume(from, to, c, a), w = volume(from, to, a, b);
            if (!((u > 0.0L && v > 0.0L && w > 0.0L) || (u < 0.0L && v < 0.0L && w < 0.0L))) continue;
            const Real sum = u + v + w;
            hits.push_back({d, at, t, {u / sum, v / sum, w / sum}});
            count[d][at] += 1.0;
          }
        }
  }
  SharpForces result{zero_field(grid), std::vector<Vector>(sheet.positions.size(), Vector{}),
                     static_cast<int>(hits.size())};
  for (const Hit& hit : hits) {
    const std::size_t d = hit.component;
    const WideVector normal = wide_cross(wide_difference(corner(hit.triangle, 1), corner(hit.triangle, 0)),
                                         wide_difference(corner(hit.triangle, 2), corner(hit.triangle, 0)));
    const Real part = normal[d] / std::sqrt(wide_dot(normal, normal));
    Real moving = 0.0L;
    for (std::size_t k = 0; k < 3; ++k)
      moving +=
          hit.weight[k] * sheet.velocities[static_cast<std::size_t>(sheet.triangles[hit.triangle][k])][d];
    const Real through = (moving - air[d][hit.face]) / part,
               inverse_mass = count[d][hit.face] / (density * grid.spacing[d] * std::abs(part));
    const double impulse =
        (part > 0.0L ? 1.0 : -1.0) * porous_impulse(sheet.alpha, sheet.beta, static_cast<double>(through), dt,
                                                    static_cast<double>(inverse_mass));
    result.density[d][hit.face] += impulse / (dt * grid.spacing[d]);
    const double force = impulse / dt * grid.spacing[(d + 1) % 3] * grid.spacing[(d + 2) % 3];
    for (std::size_t k = 0; k < 3; ++k)
      result.vertices[static_cast<std::size_t>(sheet.triangles[hit.triangle][k])][d] +=
          static_cast<double>(hit.weight[k]) * force;
  }
  return result;
}

}  // namespace drogue::reference
