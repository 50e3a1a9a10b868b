#pragma once

#include <vector>

#include "kernels/mesh/mesh.hpp"

namespace drogue::mesh {

/// Triangles around each vertex in compressed rows: entries first[i] to first[i + 1] - 1 of `triangle`, in
/// ascending order, belong to vertex i.
struct VertexTriangles {
  std::vector<int> first;     ///< one entry per vertex, and the end
  std::vector<int> triangle;  ///< index of a triangle
};

/// Triangles around each vertex of a mesh with indices in range; none around a vertex of lines alone. Throws
/// only std::bad_alloc.
[[nodiscard]] VertexTriangles vertex_triangles(const Mesh& mesh);

}  // namespace drogue::mesh
