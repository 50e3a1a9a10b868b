#include "kernels/reference/fabric/bending.hpp"

#include <cmath>

namespace drogue::reference {

double bending_energy(double stiffness, const Mesh& mesh, const std::vector<Vector>& now) {
  const auto at_rest = [&](int i) { return mesh.rest[static_cast<std::size_t>(i)]; };
  const auto at = [&](int i) { return now[static_cast<std::size_t>(i)]; };
  double energy = 0.0;
  for (const auto& edge : triangle_edges(mesh)) {
    const Vector a = at_rest(edge[0]), b = at_rest(edge[1]);
    double squared = 0.0, areas = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) squared += (b[axis] - a[axis]) * (b[axis] - a[axis]);
    int sides = 0;
    Vector sum{};
    for (const auto& t : mesh.triangles)
      for (const int top : t) {
        int shared = 0;
        for (const int i : t) shared += i == edge[0] || i == edge[1] ? 1 : 0;
        if (shared != 2 || top == edge[0] || top == edge[1]) continue;
        const Vector c = at_rest(top);
        double along = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
          along += (c[axis] - a[axis]) * (b[axis] - a[axis]) / squared;
        const double whole = area(a, b, c), height = 2.0 * whole / std::sqrt(squared);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double foot = (1.0 - along) * at(edge[0])[axis] + along * at(edge[1])[axis];
          sum[axis] += (at(top)[axis] - foot) / height;
        }
        areas += whole;
        ++sides;
      }
    if (sides != 2) continue;
    energy += 0.5 * stiffness * squared / areas * (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  }
  return energy;
}

std::vector<Vector> bending_forces(double stiffness, const Mesh& mesh, const std::vector<Vector>& now) {
  std::vector<Vector> force(now.size()), moved = now;
  for (std::size_t i = 0; i < now.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      moved[i][axis] = now[i][axis] + 0.5;
      const double ahead = bending_energy(stiffness, mesh, moved);
      moved[i][axis] = now[i][axis] - 0.5;
      force[i][axis] = bending_energy(stiffness, mesh, moved) - ahead;
      moved[i][axis] = now[i][axis];
    }
  return force;
}

}  // namespace drogue::reference
