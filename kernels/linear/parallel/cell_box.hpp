#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace drogue::linear {

/// First of the `n` indices that part `part` of `parts` nearly equal parts holds. Does not throw.
[[nodiscard]] constexpr int part_begin(int n, int parts, int part) {
  return static_cast<int>(static_cast<std::int64_t>(n) * part / parts);
}

/// Number of indices of a part. Does not throw.
[[nodiscard]] constexpr int part_size(int n, int parts, int part) {
  return part_begin(n, parts, part + 1) - part_begin(n, parts, part);
}

/// Division of a box of cells along y and z among the ranks of a group. Rank 0 is at place (0, 0); the place
/// along y varies fastest. Each rank has all cells along x.
struct PencilRanks {
  std::array<int, 3> parts = {1, 1, 1};  ///< along each axis
  std::array<int, 3> place = {0, 0, 0};  ///< of this rank

  /// True if several ranks divide z alone. Does not throw.
  [[nodiscard]] constexpr bool are_slabs() const { return parts[1] == 1 && parts[2] > 1; }

  /// Rank at a place. Does not throw.
  [[nodiscard]] constexpr int rank_at(const std::array<int, 3>& at) const { return at[1] + parts[1] * at[2]; }
};

/// Cells of a rank within a whole grid.
struct CellBox {
  std::array<int, 3> begin = {0, 0, 0};
  std::array<int, 3> cells = {1, 1, 1};

  /// Number of cells. Does not throw.
  [[nodiscard]] constexpr std::size_t size() const {
    return static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) *
           static_cast<std::size_t>(cells[2]);
  }
};

/// Cells of this rank. Does not throw.
[[nodiscard]] constexpr CellBox box_of(const PencilRanks& ranks, const std::array<int, 3>& whole) {
  CellBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.begin[axis] = part_begin(whole[axis], ranks.parts[axis], ranks.place[axis]);
    box.cells[axis] = part_size(whole[axis], ranks.parts[axis], ranks.place[axis]);
  }
  return box;
}

}  // namespace drogue::linear
