#pragma once

#include <cstddef>
#include <vector>

#include "kernels/fabric/elastic/adjacency.hpp"

namespace drogue::fabric {

/// Two triangles, or the last one, of each vertex of a slice that follow one another in the rings.
struct PairRow {
  int vertex;     ///< first of the slice, of its team
  int slot;       ///< first of the slice, of the first triangles
  int triangles;  ///< 1 or 2
};

/// A mesh in patches, one for each team of a persistent kernel. Rank r of patch p stands at p * team + r. A
/// team numbers what it holds: its ranks first, then its halo, the vertices of other patches that share a
/// triangle or spring with its own. Who reads a vertex of another patch has one that is read there:
/// neighbours wait for each other.
struct Patches {
  int team = 0;             ///< ranks, whole slices
  std::vector<int> vertex;  ///< (patches * team): of the mesh; -1 for ranks without
  std::vector<int> place;   ///< (patches * team): of the board, where others read the vertex; -1 if none does
  std::vector<int> first_halo;               ///< of every patch, and the end
  std::vector<int> halo_vertex, halo_place;  ///< of the mesh, of the board
  int places = 0;                            ///< of the board
  int most_halo = 0;
  RingAdjacency triangles;  ///< of (patches * team) vertices, neighbours by their teams' numbers
  SpringAdjacency springs;
  std::vector<PairRow> row;    ///< of all triangles, in the order of patches and slices
  std::vector<int> first_row;  ///< of every patch, and the end
  int most_rows = 0;

  [[nodiscard]] int count() const { return static_cast<int>(first_halo.size()) - 1; }
};

/// Cuts a mesh by halves across its longest extent, again and again, into `count` patches (at most
/// as many as there are vertices) that differ by one vertex at most. `triangles` and `springs` are the slots
/// that forces read; a patch reads the same in the same order. Teams are as large as the largest patch.
[[nodiscard]] Patches make_patches(const std::vector<Vector>& rest, const RingAdjacency& triangles,
                                   const SpringAdjacency& springs, int count);

/// Threads of a team: one a rank, at least, and up to `most` if it has as many vertices in its halo, or
/// `rows`.
[[nodiscard]] int team_threads(const Patches& patches, int rows, int most);

/// Slots of the patch that has the most.
template <int values>
[[nodiscard]] std::size_t most_slots(const Patches& patches, const SlicedEll<values>& slots) {
  const int slices = patches.team / slice;
  int most = 0;
  for (int p = 0; p < patches.count(); ++p)
    most = std::max(most, slots.first[static_cast<std::size_t>((p + 1) * slices)] -
                              slots.first[static_cast<std::size_t>(p * slices)]);
  return static_cast<std::size_t>(most) * slice;
}

}  // namespace drogue::fabric
