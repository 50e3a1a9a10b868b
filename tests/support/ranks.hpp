#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "kernels/linear/parallel/cell_box.hpp"
#include "kernels/linear/parallel/rank_group.hpp"

namespace drogue::testing {

/// The first `size` processes of the program. The others get a group that they do not use.
inline linear::RankGroup first_ranks(int size) {
  const linear::RankGroup world = linear::RankGroup::world();
  return world.split(world.rank() < size ? 0 : 1);
}
inline bool belongs_to_first(int size) { return linear::RankGroup::world().rank() < size; }

/// Calls `visit(entry, part entry)` for the entries of a part of a whole array, x fastest, with `size`
/// numbers per entry.
template <class Visit>
void for_each_entry(const std::array<int, 3>& whole, const linear::CellBox& part, const Visit& visit) {
  std::size_t at = 0;
  for (int k = 0; k < part.cells[2]; ++k)
    for (int j = 0; j < part.cells[1]; ++j)
      for (int i = 0; i < part.cells[0]; ++i, ++at)
        visit(static_cast<std::size_t>(part.begin[0] + i) +
                  static_cast<std::size_t>(whole[0]) *
                      (static_cast<std::size_t>(part.begin[1] + j) +
                       static_cast<std::size_t>(whole[1]) * static_cast<std::size_t>(part.begin[2] + k)),
              at);
}

/// Part of a whole array.
inline std::vector<double> cut(const std::vector<double>& values, const std::array<int, 3>& whole,
                               const linear::CellBox& part) {
  std::vector<double> own(part.size());
  for_each_entry(whole, part, [&](std::size_t from, std::size_t to) { own[to] = values[from]; });
  return own;
}

/// Whole array, on all ranks, from their parts.
inline std::vector<double> joined(const linear::RankGroup& group, const std::vector<double>& own,
                                  const std::array<int, 3>& whole, const linear::CellBox& part) {
  std::vector<double> values(linear::CellBox{{0, 0, 0}, whole}.size(), 0.0);
  for_each_entry(whole, part, [&](std::size_t to, std::size_t from) { values[to] = own[from]; });
  group.sum(values);
  return values;
}

}  // namespace drogue::testing
