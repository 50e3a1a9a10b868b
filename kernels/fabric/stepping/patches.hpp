#pragma once

#include <cstddef>
#include <vector>

#include "kernels/fabric/elastic/adjacency.hpp"

namespace drogue::fabric {

/// Row of pairs: two consecutive triangles, or the last one, of each vertex of a slice.
struct PairRow {
  int vertex;     ///< first vertex of the slice in its team
  int slot;       ///< first slot of the first triangles
  int triangles;  ///< 1 or 2
};

/// Mesh partition with one patch per team of a persistent kernel. Rank r of patch p has the index
/// p * team + r. A team numbers its ranks first, then its halo: the vertices of other patches that share a
/// triangle or spring with its own. The relation is symmetric, so that neighbouring patches wait for each
/// other.
struct Patches {
  int team = 0;              ///< ranks per patch, whole slices
  std::vector<int> vertex;   ///< (patches * team): vertex of the mesh; -1 for unused ranks
  std::vector<int> message;  ///< (patches * team): halo message of the vertex; -1 if no other patch reads it
  std::vector<int> first_halo;                 ///< first halo vertex of every patch, and the end
  std::vector<int> halo_vertex, halo_message;  ///< vertices of the mesh and their halo messages
  int messages = 0;                            ///< number of halo messages
  int max_halo = 0;
  RingAdjacency triangles;  ///< (patches * team) vertices with the neighbour numbers of their teams
  SpringAdjacency springs;
  std::vector<PairRow> row;    ///< of all triangles in the order of patches and slices
  std::vector<int> first_row;  ///< first row of every patch, and the end
  int max_rows = 0;

  [[nodiscard]] int count() const { return static_cast<int>(first_halo.size()) - 1; }
};

/// Partition by recursive bisection across the longest extent into `count` patches, at most one per vertex,
/// whose sizes differ by one vertex at most. A patch has the slots of `triangles` and `springs` in the same
/// order. Teams are as large as the largest patch. Throws only std::bad_alloc.
[[nodiscard]] Patches make_patches(const std::vector<Vector>& rest, const RingAdjacency& triangles,
                                   const SpringAdjacency& springs, int count);

/// Threads of a team: at least one per rank, and up to `most` for its halo vertices and `rows` of pairs. Does
/// not throw.
[[nodiscard]] int team_threads(const Patches& patches, int rows, int most);

/// Largest number of slots of a patch. Does not throw.
template <int values>
[[nodiscard]] std::size_t max_slots(const Patches& patches, const SlicedEll<values>& slots) {
  const int slices = patches.team / slice;
  int most = 0;
  for (int p = 0; p < patches.count(); ++p)
    most = std::max(most, slots.first[static_cast<std::size_t>((p + 1) * slices)] -
                              slots.first[static_cast<std::size_t>(p * slices)]);
  return static_cast<std::size_t>(most) * slice;
}

}  // namespace drogue::fabric
