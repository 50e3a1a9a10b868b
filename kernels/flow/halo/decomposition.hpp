#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string>

#include "kernels/flow/parameters.hpp"
#include "kernels/linear/parallel/cell_box.hpp"

namespace drogue::flow {

/// Fewest cells of a rank along a divided axis: a neighbour needs that many ghost cells from it.
inline constexpr int least_cells_of_rank = 3;

/// Count, dimensionless, of the numbers that a rank sends in a step of one projection, per cell along x:
/// ghost cells, and transpositions of a direct pressure solver. Does not throw.
inline double numbers_sent(const std::array<int, 3>& cells, int parts_y, int parts_z) {
  const double own_y = static_cast<double>(cells[1]) / parts_y,
               own_z = static_cast<double>(cells[2]) / parts_z;
  constexpr double ghosts = 2.0 * 3.0 * 3.0;  // sides, components, layers
  const auto along = [&](int parts, double across) {
    return parts > 1 ? ghosts * across + 2.0 * own_y * own_z * (1.0 - 1.0 / parts) : 0.0;
  };
  return along(parts_y, own_z) + along(parts_z, own_y);
}

/// Division of a grid of cells among ranks along y and z, or along z alone (`slabs`), with the fewest numbers
/// sent; none if a rank would have too few cells. Axes with one cell and x are not divided. Does not throw.
inline std::optional<linear::PencilRanks> find_division(const std::array<int, 3>& cells, int ranks, int rank,
                                                        bool slabs) {
  std::optional<linear::PencilRanks> best;
  double least = 0.0;
  for (int parts_y = 1; parts_y <= (slabs ? 1 : ranks); ++parts_y) {
    const int parts_z = ranks / parts_y;
    const auto fits = [](int n, int parts) { return parts == 1 || n / parts >= least_cells_of_rank; };
    if (parts_y * parts_z != ranks || !fits(cells[1], parts_y) || !fits(cells[2], parts_z)) continue;
    const double sent = numbers_sent(cells, parts_y, parts_z);
    if (best && sent >= least) continue;
    least = sent;
    best = {{1, parts_y, parts_z}, {0, rank % parts_y, rank / parts_y}};
  }
  return best;
}

/// The same. Throws std::invalid_argument, with one sentence that names the largest number of ranks that
/// works, if a rank would have too few cells.
inline linear::PencilRanks decompose(const std::array<int, 3>& cells, int ranks, int rank,
                                     bool slabs = false) {
  if (const auto division = find_division(cells, ranks, rank, slabs)) return *division;
  int most = ranks;
  while (!find_division(cells, most, 0, slabs)) --most;
  const std::string y = std::to_string(cells[1]), z = std::to_string(cells[2]);
  throw std::invalid_argument("flow solver: " + std::to_string(ranks) + " ranks cannot share " +
                              (slabs ? z + " cells along z" : y + " x " + z + " cells along y and z") +
                              ": each needs at least " + std::to_string(least_cells_of_rank) +
                              " along a divided axis; use " + std::to_string(most) +
                              (most == 1 ? " rank" : " ranks"));
}

/// Place of a rank in the division of a flow, which `on_device` is along z alone. Throws
/// std::invalid_argument, with one sentence, if the flow cannot be divided among so many ranks.
inline linear::PencilRanks ranks_of(const Parameters& p, int ranks, int rank, bool on_device) {
  return decompose(p.cells, ranks, rank, p.slabs || on_device);
}

/// True if the side of this rank's cells borders another rank. Does not throw.
[[nodiscard]] constexpr bool borders_rank(const Parameters& p, const linear::PencilRanks& ranks,
                                          std::size_t side) {
  const std::size_t axis = side / 2;
  if (ranks.parts[axis] == 1) return false;
  if (p.boundary[side].kind == BoundaryKind::periodic) return true;
  return side % 2 == 0 ? ranks.place[axis] > 0 : ranks.place[axis] + 1 < ranks.parts[axis];
}

/// Place of the rank beyond a side for which `borders_rank` is true. Does not throw.
[[nodiscard]] constexpr std::array<int, 3> place_beyond(const linear::PencilRanks& ranks, std::size_t side) {
  const std::size_t axis = side / 2;
  std::array<int, 3> place = ranks.place;
  const int parts = ranks.parts[axis];
  place[axis] = (place[axis] + (side % 2 == 0 ? parts - 1 : 1)) % parts;
  return place;
}

/// Part that a rank holds of an array of the whole shape `extents`: its cells, and on the last ranks along a
/// bounded axis the faces of the high side. Does not throw.
[[nodiscard]] constexpr linear::CellBox part_of(const std::array<int, 3>& whole, const Parameters& p,
                                                const linear::PencilRanks& ranks) {
  linear::CellBox box = linear::box_of(ranks, p.cells);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (ranks.place[axis] + 1 == ranks.parts[axis]) box.cells[axis] = whole[axis] - box.begin[axis];
  return box;
}

}  // namespace drogue::flow
