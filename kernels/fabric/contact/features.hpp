#pragma once

#include <vector>

#include "kernels/fabric/material.hpp"

namespace drogue::fabric {

/// Edges of a mesh, each once: those of triangles, then lines that are not edges of triangles.
struct CollisionEdges {
  std::vector<std::array<int, 2>> ends;
  int first_line = 0;
  double mean_length = 0.0;  ///< m, at rest
};

/// Edges that take part in contact. Throws only std::bad_alloc.
[[nodiscard]] CollisionEdges collision_edges(const Mesh& mesh);

/// Number in `edges`, those of the mesh, of every line of the mesh; -1 for an edge of a triangle. Throws only
/// std::bad_alloc.
[[nodiscard]] std::vector<int> edges_of_lines(const Mesh& mesh, const CollisionEdges& edges);

/// Lines whose length at rest is at least four times the mean of all edges, such as suspension lines, in
/// ascending order. `edges`: those of the mesh. Throws only std::bad_alloc.
[[nodiscard]] std::vector<int> long_lines(const Mesh& mesh, const CollisionEdges& edges);

/// Bit sets of the features that each triangle owns, so that a contact at a shared feature counts once. Bit
/// k: it is the first triangle with its corner k; bit 3 + k: the first with the edge from corner k to the
/// next. Throws only std::bad_alloc.
[[nodiscard]] std::vector<int> owned_features(const Mesh& mesh);

/// Least altitude of all triangles at rest, m, infinite without triangles. In a fold, layers cannot be
/// farther apart than that. Does not throw.
[[nodiscard]] double shortest_altitude(const Mesh& mesh);

}  // namespace drogue::fabric
