#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "kernels/mesh/mesh.hpp"

namespace drogue::mesh {

/// Twice the area of a triangle times its unit normal, m^2. Does not throw.
[[nodiscard]] Vector doubled_area(const std::vector<Vector>& points, const std::array<int, 3>& triangle);

/// True if all triangles have parallel or antiparallel normals up to round-off. Does not throw.
[[nodiscard]] bool is_planar(const Mesh& mesh);

/// Indices of two triangles that share an edge and have opposite orientations; empty for a consistently
/// oriented mesh. Throws only std::bad_alloc.
[[nodiscard]] std::optional<std::array<int, 2>> inconsistent_triangles(const Mesh& mesh);

/// Extent of a mesh: the diagonal of the box around its vertices, m. Does not throw.
[[nodiscard]] double extent_of(const Mesh& mesh);

/// Two vertices, the smaller index first, that are nearer to each other than `distance`, m, or empty. Throws
/// only std::bad_alloc.
[[nodiscard]] std::optional<std::array<int, 2>> near_vertices(const Mesh& mesh, double distance);

/// Kinds of defects that make a mesh unusable for cloth, in the order in which `find_defect` looks for them.
enum class DefectKind {
  duplicate_vertex,     ///< vertex `part` has the position of vertex `other`
  orphan_vertex,        ///< vertex `part` belongs to no triangle and no line
  degenerate_triangle,  ///< triangle `part` has no area, or an edge that is not finite
  duplicate_triangle,   ///< triangle `part` has the corners of triangle `other`
  non_manifold_edge,    ///< triangle `part` is the third at the edge `vertices`
  duplicate_line,       ///< line `part` has the ends of line `other`, `vertices`
};

/// Defect of a mesh.
struct Defect {
  DefectKind kind;
  std::size_t part;               ///< index of the vertex, triangle or line
  int other = -1;                 ///< index of the part that it repeats, if any
  std::array<int, 2> vertices{};  ///< ends of the edge or line, if any, ascending
};

/// First defect of a mesh with indices in range, or empty. Lengths at rest in m. A triangle is degenerate if
/// its height is below 1e-12 of its longest edge, the size of rounded coordinates. Throws only
/// std::bad_alloc.
[[nodiscard]] std::optional<Defect> find_defect(const Mesh& mesh);

}  // namespace drogue::mesh
