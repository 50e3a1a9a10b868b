#pragma once

#include <array>
#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::fabric {

/// Two vertices, the smaller first.
using Edge = std::array<int, 2>;

[[nodiscard]] Edge edge_between(int a, int b);

/// How far apart they are at rest, m.
[[nodiscard]] double rest_distance(const Mesh& mesh, int a, int b);

/// The edge of a triangle that its corner k (0, 1, 2) is no end of.
[[nodiscard]] Edge opposite_edge(const std::array<int, 3>& triangle, std::size_t k);

/// Every edge of the triangles once, ascending.
[[nodiscard]] std::vector<Edge> triangle_edges(const Mesh& mesh);

/// Every edge of the triangles and every line once, ascending.
[[nodiscard]] std::vector<Edge> edges_of(const Mesh& mesh);

/// The length at rest of the shortest of them, m; zero where there is none.
[[nodiscard]] double shortest_edge(const Mesh& mesh);

}  // namespace drogue::fabric
