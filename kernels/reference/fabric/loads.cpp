#include "kernels/reference/fabric/loads.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace drogue::reference {

std::vector<Vector> pressure_forces(const Mesh& mesh, const std::vector<double>& pressure,
                                    const std::vector<Vector>& now) {
  std::vector<Vector> force(now.size(), Vector{});
  for (const auto& t : mesh.triangles) {
    const Vector &a = now[static_cast<std::size_t>(t[0])], &b = now[static_cast<std::size_t>(t[1])],
                 &c = now[static_cast<std::size_t>(t[2])];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
      // Signed area projected along the axis, by the shoelace formula.
      const double projected_area =
          0.5 * (a[y] * b[z] - b[y] * a[z] + b[y] * c[z] - c[y] * b[z] + c[y] * a[z] - a[y] * c[z]);
      for (const int i : t)
        force[static_cast<std::size_t>(i)][axis] +=
            pressure[static_cast<std::size_t>(i)] * projected_area / 3.0;
    }
  }
  return force;
}

double enclosed_volume(const Mesh& mesh, const std::vector<Vector>& now) {
  double volume = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vector &a = now[static_cast<std::size_t>(t[0])], &b = now[static_cast<std::size_t>(t[1])],
                 &c = now[static_cast<std::size_t>(t[2])];
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0])) /
              6.0;
  }
  return volume;
}

std::vector<Vector> dashpot_forces(const Mesh& mesh, const std::vector<double>& mass, double rate,
                                   const std::vector<Vector>& x, const std::vector<Vector>& v) {
  std::set<std::array<int, 2>> pairs;
  for (const auto& edge : triangle_edges(mesh)) pairs.insert(edge);
  for (const auto& line : mesh.lines) pairs.insert({std::min(line[0], line[1]), std::max(line[0], line[1])});
  std::vector<Vector> force(x.size(), Vector{});
  for (const auto& pair : pairs) {
    const auto i = static_cast<std::size_t>(pair[0]), j = static_cast<std::size_t>(pair[1]);
    const double length = std::hypot(x[j][0] - x[i][0], x[j][1] - x[i][1], x[j][2] - x[i][2]);
    double lengthening = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      lengthening += (v[j][axis] - v[i][axis]) * (x[j][axis] - x[i][axis]) / length;
    const double tension = rate / (1.0 / mass[i] + 1.0 / mass[j]) * lengthening;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      force[i][axis] += tension * (x[j][axis] - x[i][axis]) / length;
      force[j][axis] -= tension * (x[j][axis] - x[i][axis]) / length;
    }
  }
  return force;
}

}  // namespace drogue::reference
