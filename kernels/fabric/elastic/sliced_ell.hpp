#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace drogue::fabric {

/// Vertices come in slices, and of a slice all the first neighbours lie side by side, then all the second
/// ones (sliced ELLPACK, Monakov et al. 2010): threads of a warp, or lanes of a register, read consecutive
/// numbers.
inline constexpr int slice = 32;

/// What each vertex is part of, as its kernel gathers it. Slot k of vertex i lies at
/// (first[i / slice] + k) * slice + i % slice. A vertex with fewer slots than its slice has neutral ones: its
/// own number and no stiffness.
template <int values>
struct SlicedEll {
  std::vector<int> first;  ///< of every slice, and the end
  std::vector<int> neighbour;
  std::array<std::vector<double>, values> value;
};

/// What a slot holds.
template <int values>
struct EllEntry {
  int neighbour;
  std::array<double, values> value;
};

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
