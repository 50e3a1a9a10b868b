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

/// Numbers that a rank between others sends in a step of one projection, without what the ranks agree on:
/// ghost cells, single layers, and those of a direct pressure solver. That transposes arrays where y is
/// divided; in slabs it gives two numbers per line along z to each other rank. Does not throw.
inline double numbers_sent(const std::array<int, 3>& cells, int parts_y, int parts_z) {
  const double x = cells[0], own_y = static_cast<double>(cells[1]) / parts_y,
               own_z = static_cast<double>(cells[2]) / parts_z;
  // Ghost cells of the velocity, with the faces on the high sides of axes that are not divided.
  const auto with_faces = [](int n, int parts, double own) { return parts == 1 && n > 1 ? own + 1.0 : own; };
  const double faces_x = with_faces(cells[0], 1, x), faces_y = with_faces(cells[1], parts_y, own_y),
               faces_z = with_faces(cells[2], parts_z, own_z);
  constexpr double per_edge = 3.0 * 3.0 * 3.0, per_side = 3.0 * 3.0;  // layers and components
  const double edges = parts_y > 1 && parts_z > 1 ? 4.0 * per_edge * faces_x : 0.0;
  const auto along = [&](int parts, double faces_across, double across, double solve) {
    // Both sides; the normal velocity to one and the pressure to the other.
    return parts > 1 ? 2.0 * per_side * faces_x * faces_across + 2.0 * x * across + solve : 0.0;
  };
  const auto transposed = [&](int parts) { return 2.0 * x * own_y * own_z * (1.0 - 1.0 / parts); };
  const double solve_along_z = parts_y == 1 ? 2.0 * x * own_y * (parts_z - 1) : transposed(parts_z);
  return along(parts_y, faces_z, own_z, transposed(parts_y)) + along(parts_z, faces_y, own_y, solve_along_z) +
         edges;
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
