#pragma once

#include <cstdint>

#include <Kokkos_Core.hpp>

#include "kernels/flow/halo/decomposition.hpp"
#include "kernels/flow/parameters.hpp"

namespace drogue::flow {

/// Width of the ghost region along axes with more than one cell: the stencil of a fifth-order flux.
inline constexpr int ghost_width = 3;
static_assert(least_cells_of_rank >= ghost_width,
              "the ghost cells of a rank come from one neighbour per axis");

/// Staggered (MAC) grid, Harlow and Welch 1965. Cell (i, j, k) has the pressure at its centre; component c of
/// the velocity lies on its low face along axis c. Arrays with ghost cells hold component after component,
/// x fastest. Along a bounded axis of n cells, component c of axis c has n + 1 faces; the last one is stored
/// in the first ghost cell. Any axis may have one cell: a flow in a plane has one, and no ghost cells along
/// it.
///
/// On one of several ranks it is the part of a whole grid that the rank holds. Sides towards other ranks are
/// `BoundaryKind::neighbour`; along such an axis, face n belongs to the neighbour.
struct MacGrid {
  int n[3];                ///< cells per axis
  int ghost[3];            ///< ghost cells at each side; 0 along axes with one cell
  int whole[3];            ///< cells of the whole grid per axis
  int origin[3];           ///< index of cell (0, 0, 0) in the whole grid
  bool periodic[3];        ///< with both sides on this rank
  bool whole_periodic[3];  ///< of the whole grid
  double low[3], high[3];  ///< corners of the whole grid, m
  double h[3];             ///< spacing, m
  double inverse_h[3];     ///< 1/m
  std::int64_t stride[3];  ///< of an array with ghost cells, in numbers
  std::int64_t component;  ///< numbers of one component with its ghost cells
  std::int64_t first;      ///< offset of cell (0, 0, 0) in a component

  /// Offset of cell (i, j, k) within a component; ghost cells have indices below 0 or from n on.
  [[nodiscard]] KOKKOS_FUNCTION std::int64_t offset(int i, int j, int k) const {
    return first + i + j * stride[1] + k * stride[2];
  }
  /// Number of cells.
  [[nodiscard]] KOKKOS_FUNCTION std::int64_t cells() const {
    return static_cast<std::int64_t>(n[0]) * n[1] * n[2];
  }
  /// Number of cell (i, j, k) in the whole grid, x fastest.
  [[nodiscard]] KOKKOS_FUNCTION std::int64_t number(int i, int j, int k) const {
    return origin[0] + i +
           static_cast<std::int64_t>(whole[0]) *
               (origin[1] + j + static_cast<std::int64_t>(whole[1]) * (origin[2] + k));
  }
};

/// Grid of a solver, on one of several ranks its part. Rows start at multiples of 64 bytes. Does not throw.
inline MacGrid make_grid(const Parameters& p, const linear::PencilRanks& ranks = {}) {
  MacGrid grid{};
  // Eight ghost cells before a row keep its first cell at a multiple of 64 bytes.
  constexpr int row_alignment = 8;
  const linear::CellBox box = linear::box_of(ranks, p.cells);
  int extent[3];
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    grid.n[axis] = box.cells[a];
    grid.ghost[axis] = p.cells[a] > 1 ? ghost_width : 0;
    grid.whole[axis] = p.cells[a];
    grid.origin[axis] = box.begin[a];
    grid.whole_periodic[axis] = p.boundary[2 * a].kind == BoundaryKind::periodic;
    grid.periodic[axis] = grid.whole_periodic[axis] && ranks.parts[a] == 1;
    grid.low[axis] = p.low[a];
    grid.high[axis] = p.high[a];
    grid.h[axis] = (p.high[a] - p.low[a]) / p.cells[a];
    grid.inverse_h[axis] = 1.0 / grid.h[axis];
    extent[axis] = grid.n[axis] + 2 * grid.ghost[axis];
  }
  const int before = grid.ghost[0] > 0 ? row_alignment : 0;
  const int row = (before + grid.n[0] + grid.ghost[0] + row_alignment - 1) / row_alignment * row_alignment;
  grid.stride[0] = 1;
  grid.stride[1] = row;
  grid.stride[2] = static_cast<std::int64_t>(row) * extent[1];
  grid.component = grid.stride[2] * extent[2];
  grid.first = before + grid.ghost[1] * grid.stride[1] + grid.ghost[2] * grid.stride[2];
  return grid;
}

}  // namespace drogue::flow
