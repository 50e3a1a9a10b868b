#include "kernels/reference/fabric/mass.hpp"

#include <cmath>

namespace drogue::reference {

std::vector<double> row_sum_masses(const Mesh& mesh, double area_density, double line_density) {
  std::vector<double> mass(mesh.rest.size(), 0.0);
  for (const auto& t : mesh.triangles) {
    std::array<Vector, 3> x;
    for (std::size_t k = 0; k < 3; ++k) x[k] = mesh.rest[static_cast<std::size_t>(t[k])];
    const double whole = area_density * area(x[0], x[1], x[2]);
    // Quadrature at the midpoints of the edges, with weights of 1/3.
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t point = 0; point < 3; ++point) {
          const double shape_i = i == point ? 0.0 : 0.5, shape_j = j == point ? 0.0 : 0.5;
          mass[static_cast<std::size_t>(t[i])] += whole / 3.0 * shape_i * shape_j;
        }
  }
  for (std::size_t k = 0; k < mesh.lines.size(); ++k) {
    const auto& line = mesh.lines[k];
    const double density = mesh.line_density.empty() ? line_density : mesh.line_density[k];
    double squared = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double d = mesh.rest[static_cast<std::size_t>(line[1])][axis] -
                       mesh.rest[static_cast<std::size_t>(line[0])][axis];
      squared += d * d;
    }
    const bool has_length = !mesh.line_length.empty() && mesh.line_length[k] > 0.0;
    const double length = has_length ? mesh.line_length[k] : std::sqrt(squared);
    // Diagonal entry 1/3 plus off-diagonal entry 1/6.
    for (const int i : line) mass[static_cast<std::size_t>(i)] += density * length * (1.0 / 3.0 + 1.0 / 6.0);
  }
  return mass;
}

}  // namespace drogue::reference
