#pragma once

#include "kernels/fabric/elastic/sliced_ell_views.hpp"

namespace drogue::fabric {

/// `count` numbers in the scratch memory of the team of `member`.
template <class T, class Member>
KOKKOS_FUNCTION T* team_numbers(const Member& member, std::size_t count) {
  return static_cast<T*>(member.team_scratch(0).get_shmem_aligned(count * sizeof(T), alignof(T)));
}

/// Array in the scratch memory of a team.
template <class T>
struct TeamList {
  T* data;
  KOKKOS_FUNCTION T& operator()(int i) const { return data[i]; }
};

/// Column-major table in the scratch memory of a team.
struct TeamTable {
  double* data;
  int rows;
  KOKKOS_FUNCTION double& operator()(int row, int column) const { return data[column * rows + row]; }
};

/// Table of `rows` points in the scratch memory of the team of `member`.
template <class Member>
KOKKOS_FUNCTION TeamTable team_table(const Member& member, std::size_t rows) {
  return {team_numbers<double>(member, 3 * rows), static_cast<int>(rows)};
}

/// `SlicedEll` of a patch in the scratch memory of its team.
template <int values>
struct TeamSlicedEll {
  TeamList<int> first, neighbour;
  TeamTable value;

  [[nodiscard]] static std::size_t bytes(int team, std::size_t slots) {
    return (static_cast<std::size_t>(team / slice) + 1 + slots) * sizeof(int) +
           values * slots * sizeof(double);
  }

  /// Copies the slots of the patch of `member`. The team must synchronize before it reads them.
  template <class Member, class Views>
  KOKKOS_FUNCTION TeamSlicedEll(const Member& member, int slices, const Views& from) {
    const int patch = member.league_rank() * slices;
    const int begin = from.first(patch), slots = (from.first(patch + slices) - begin) * slice;
    const auto count = static_cast<std::size_t>(slots);
    value = {team_numbers<double>(member, values * count), slots};
    first.data = team_numbers<int>(member, static_cast<std::size_t>(slices) + 1);
    neighbour.data = team_numbers<int>(member, count);
    for (int s = member.team_rank(); s <= slices; s += member.team_size())
      first(s) = from.first(patch + s) - begin;
    for (int slot = member.team_rank(); slot < slots; slot += member.team_size()) {
      neighbour(slot) = from.neighbour(begin * slice + slot);
      for (int a = 0; a < values; ++a) value(slot, a) = from.value(begin * slice + slot, a);
    }
  }

  template <class Visit>
  KOKKOS_FUNCTION void each(int i, const Visit& visit) const {
    for_each_slot(first, i, visit);
  }
  template <class Read, class Visit>
  KOKKOS_FUNCTION void each_read(int i, const Read& read, const Visit& visit) const {
    // Without reading ahead, which would cost registers: shared memory has little latency.
    each(i, [&](int slot) { visit(read(slot)); });
  }
  template <class Index, class Read, class Visit>
  KOKKOS_FUNCTION void each_pair(int i, const Index& index, const Read& read, const Visit& visit) const {
    for_each_slot_pair(first, i, index, read, visit);
  }
};

}  // namespace drogue::fabric
