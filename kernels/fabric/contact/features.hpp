#pragma once

#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::fabric {

/// The edges of a mesh, each once: those of triangles, then lines that are none of them.
struct CollisionEdges {
  std::vector<std::array<int, 2>> ends;
  int first_line = 0;
  double mean_length = 0.0;  ///< m, at rest
};

[[nodiscard]] CollisionEdges collision_edges(const Mesh& mesh);

/// Bit k of a triangle's word: of the triangles that share its corner k it is the first; bit 3 + k: of those
/// that share the edge from corner k to the next. What is nearest to a shared part counts once.
[[nodiscard]] std::vector<int> owned_features(const Mesh& mesh);

/// The least distance at rest, m, of a vertex from the opposite edge of one of its triangles: layers cannot
/// be kept farther apart than that where cloth folds.
[[nodiscard]] double shortest_altitude(const Mesh& mesh);

}  // namespace drogue::fabric
