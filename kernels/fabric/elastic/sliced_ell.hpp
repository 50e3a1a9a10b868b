#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace drogue::fabric {

/// Vertices per slice. The first neighbours of all vertices of a slice are adjacent in memory, then the
/// second ones (sliced ELLPACK, Monakov et al. 2010), so that threads of a warp, or lanes of a register, read
/// consecutive numbers.
inline constexpr int slice = 32;

/// Adjacency of the vertices in sliced ELLPACK format. Slot k of vertex i has the index
/// (first[i / slice] + k) * slice + i % slice. Neutral slots, which name the vertex itself and have zero
/// values, fill vertices with fewer slots than their slice.
template <int values>
struct SlicedEll {
  std::vector<int> first;  ///< first row of slots of every slice, and the end
  std::vector<int> neighbour;
  std::array<std::vector<double>, values> value;
};

/// Contents of a slot.
template <int values>
struct EllEntry {
  int neighbour;
  std::array<double, values> value;
};

/// Packs the entries of every vertex in their order. Throws only std::bad_alloc.
template <int values>
SlicedEll<values> sliced(const std::vector<std::vector<EllEntry<values>>>& of_vertex) {
  SlicedEll<values> slots;
  const std::size_t n = of_vertex.size(), slices = (n + slice - 1) / slice;
  slots.first.push_back(0);
  for (std::size_t s = 0; s < slices; ++s) {
    std::size_t most = 0;
    for (std::size_t i = s * slice; i < std::min(n, (s + 1) * slice); ++i)
      most = std::max(most, of_vertex[i].size());
    for (std::size_t k = 0; k < most; ++k)
      for (std::size_t i = s * slice; i < (s + 1) * slice; ++i) {
        const bool there = i < n && k < of_vertex[i].size();
        slots.neighbour.push_back(there ? of_vertex[i][k].neighbour : static_cast<int>(i));
        for (std::size_t a = 0; a < values; ++a)
          slots.value[a].push_back(there ? of_vertex[i][k].value[a] : 0.0);
      }
    slots.first.push_back(slots.first.back() + static_cast<int>(most));
  }
  return slots;
}

}  // namespace drogue::fabric
