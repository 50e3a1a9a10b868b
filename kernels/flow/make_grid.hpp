#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/flow/axis_lines.hpp"
#include "kernels/flow/halo/decomposition.hpp"
#include "kernels/flow/mac_grid.hpp"
#include "kernels/flow/parameters.hpp"
#include "kernels/linear/parallel/cell_box.hpp"

namespace drogue::flow {

static_assert(least_cells_of_rank >= ghost_width,
              "the ghost cells of a rank come from one neighbour per axis");

/// Grid of a solver, on one of several ranks its part, without the tables of stretched axes (`AxisTables`).
/// Rows start at multiples of 64 bytes. Does not throw.
inline MacGrid make_grid(const Parameters& p, const linear::PencilRanks& ranks = {}) {
  MacGrid grid{};
  // Eight ghost cells before a row keep its first cell at a multiple of 64 bytes.
  constexpr int row_alignment = 8;
  const linear::CellBox box = linear::box_of(ranks, p.cells);
  const Core core = core_of(p);
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
    grid.h[axis] = core.spacing[a];
    grid.inverse_h[axis] = 1.0 / grid.h[axis];
    grid.start[axis] = core.low[a] - core.begin[a] * core.spacing[a];
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
