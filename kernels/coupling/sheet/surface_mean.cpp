#include "kernels/coupling/sheet/surface_mean.hpp"

#include <cmath>

#include "kernels/mesh/topology.hpp"

namespace drogue::coupling {

int smoothing_sweeps(const mesh::Mesh& mesh, const StaggeredGrid& grid) {
  if (mesh.triangles.empty()) return 1;
  std::vector<mesh::Vector> places = mesh.rest;
  for (mesh::Vector& place : places)
    for (std::size_t axis = 0; axis < 3; ++axis) place[axis] /= grid.spacing[axis];
  double area = 0.0;
  for (const auto& corners : mesh.triangles) {
    const mesh::Vector doubled = mesh::doubled_area(places, corners);
    area += 0.5 * std::hypot(doubled[0], doubled[1], doubled[2]);
  }
  const auto triangles = static_cast<double>(mesh.triangles.size());
  return area > 0.32 * triangles ? 1 : static_cast<int>(std::ceil(0.32 * triangles / area));
}

}  // namespace drogue::coupling
