#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "kernels/mesh/mesh.hpp"

namespace drogue::mesh {

/// Two vertices, the smaller index first.
using Edge = std::array<int, 2>;

/// Edge with the ends a and b in canonical order. Does not throw.
[[nodiscard]] Edge edge_between(int a, int b);

/// Distance of two vertices at rest, m. Does not throw.
[[nodiscard]] double rest_distance(const Mesh& mesh, int a, int b);

/// Length of a line without tension, m. Does not throw.
[[nodiscard]] double rest_length(const Mesh& mesh, std::size_t line);

/// Edge opposite corner k (0, 1, 2) of a triangle. Does not throw.
[[nodiscard]] Edge opposite_edge(const std::array<int, 3>& triangle, std::size_t k);

/// Unique edges of the triangles in ascending order. Throws only std::bad_alloc.
[[nodiscard]] std::vector<Edge> triangle_edges(const Mesh& mesh);

/// Unique edges of the triangles and lines in ascending order. Throws only std::bad_alloc.
[[nodiscard]] std::vector<Edge> edges_of(const Mesh& mesh);

/// Length at rest of the shortest edge or line, m; zero for a mesh without edges. Throws only std::bad_alloc.
[[nodiscard]] double shortest_edge(const Mesh& mesh);

}  // namespace drogue::mesh
