#include "kernels/coupling/sheet/edge_inset.hpp"

#include <cmath>

namespace drogue::coupling {

namespace {

/// Rounding of positions at rest, in cells.
constexpr double rounding = 1e-6;

/// The surface at rest in cells from the origin of a grid.
mesh::Mesh in_cells(const mesh::Mesh& mesh, const StaggeredGrid& grid) {
  mesh::Mesh scaled;
  scaled.rest = mesh.rest;
  scaled.triangles = mesh.triangles;
  for (mesh::Vector& place : scaled.rest)
    for (std::size_t axis = 0; axis < 3; ++axis)
      place[axis] = (place[axis] - grid.origin[axis]) / grid.spacing[axis];
  return scaled;
}

/// True if the sheet ends at a side of the grid: an edge, in cells, lies along the side, at most half a cell
/// from it, and the sheet lies across it rather than along it.
bool ends_at_a_side(const mesh::Mesh& mesh, const mesh::OpenEdge& edge, const StaggeredGrid& grid) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto place = [&](int vertex) { return mesh.rest[static_cast<std::size_t>(vertex)][axis]; };
    const double first = place(edge.ends[0]), second = place(edge.ends[1]);
    if (std::abs(first - second) > rounding || std::abs(edge.inward[axis]) < 0.5) continue;
    for (const double side : {0.0, static_cast<double>(grid.cells[axis])})
      if (std::abs(first - side) <= 0.5 - rounding) return true;
  }
  return false;
}

}  // namespace

std::vector<mesh::SurfacePoint> inset_points(const mesh::Mesh& mesh, const StaggeredGrid& grid,
                                             double inset) {
  if (!(inset > 0.0)) return {};
  const mesh::Mesh scaled = in_cells(mesh, grid);
  std::vector<mesh::OpenEdge> edges = mesh::open_edges(scaled);
  std::erase_if(edges, [&](const mesh::OpenEdge& edge) { return ends_at_a_side(scaled, edge, grid); });
  return mesh::shifted_from_edges(scaled, edges, inset, inset_band);
}

}  // namespace drogue::coupling
