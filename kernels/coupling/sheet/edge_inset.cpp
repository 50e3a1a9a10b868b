#include "kernels/coupling/sheet/edge_inset.hpp"

#include <algorithm>
#include <cmath>

namespace drogue::coupling {

namespace {

/// Rounding of positions at rest, in cells.
constexpr double rounding = 1e-6;

/// True if both ends of an edge have the same distance of at most half a cell from a side of the grid.
bool lies_along_a_side(const mesh::Mesh& mesh, const mesh::Edge& edge, const StaggeredGrid& grid) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto cells_from_origin = [&](int vertex) {
      return (mesh.rest[static_cast<std::size_t>(vertex)][axis] - grid.origin[axis]) / grid.spacing[axis];
    };
    const double first = cells_from_origin(edge[0]), second = cells_from_origin(edge[1]);
    if (std::abs(first - second) > rounding) continue;
    for (const double side : {0.0, static_cast<double>(grid.cells[axis])})
      if (std::abs(first - side) <= 0.5 - rounding) return true;
  }
  return false;
}

}  // namespace

std::vector<mesh::Edge> free_edges(const mesh::Mesh& mesh, const StaggeredGrid& grid) {
  std::vector<mesh::Edge> edges = mesh::open_edges(mesh);
  std::erase_if(edges, [&](const mesh::Edge& edge) { return lies_along_a_side(mesh, edge, grid); });
  return edges;
}

std::vector<mesh::SurfacePoint> inset_points(const mesh::Mesh& mesh, const StaggeredGrid& grid,
                                             double inset) {
  if (!(inset > 0.0)) return {};
  double cell = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (grid.cells[axis] > 1) cell = std::max(cell, grid.spacing[axis]);
  return mesh::shifted_from_edges(mesh, free_edges(mesh, grid), inset * cell, inset_band * cell);
}

}  // namespace drogue::coupling
