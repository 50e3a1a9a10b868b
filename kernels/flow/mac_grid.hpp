#pragma once

#include <cstdint>

#include <Kokkos_Core.hpp>

namespace drogue::flow {

/// Width of the ghost region along axes with more than one cell: the stencil of a fifth-order flux.
inline constexpr int ghost_width = 3;

/// Rows of the table of a stretched axis, each with an entry for every cell, ghost cells included. The width
/// of a ghost cell is that of the cell that it repeats, or whose mirror image it is.
enum class AxisRow : int {
  face,            ///< coordinate of the low face of the cell, m; of faces 0 to n of the whole grid
  inverse_width,   ///< 1/m
  inverse_gap,     ///< 1 / distance of the centre from that of the cell before, 1/m
  skew,            ///< half the difference over the sum of the width and that of the cell before
  relative_width,  ///< ratio of the width to `MacGrid::h`
  filter,          ///< factor of the cell in the squared mean width of a filter, over that of width h
  count,
};

/// Staggered (MAC) grid, Harlow and Welch 1965. Cell (i, j, k) has the pressure at its centre; component c of
/// the velocity lies on its low face along axis c. Arrays with ghost cells hold component after component,
/// x fastest. Along a bounded axis of n cells, component c of axis c has n + 1 faces; the last one is stored
/// in the first ghost cell. Any axis may have one cell: a flow in a plane has one, and no ghost cells along
/// it.
///
/// The axes are uniform, or stretched: each cell has a width of its own, from a table. A component's control
/// volume reaches along its own axis from the centre of one cell to that of the next, and is as wide as a
/// cell along the others. Indices of cells and faces in the functions below may be those of ghost cells.
///
/// On one of several ranks it is the part of a whole grid that the rank holds. Sides towards other ranks are
/// `BoundaryKind::neighbour`; along such an axis, face n belongs to the neighbour.
struct MacGrid {
  /// Of all widths, for what takes `UniformWidths` in place of the grid.
  static constexpr bool are_equal = false;

  int n[3];                ///< cells per axis
  int ghost[3];            ///< ghost cells at each side; 0 along axes with one cell
  int whole[3];            ///< cells of the whole grid per axis
  int origin[3];           ///< index of cell (0, 0, 0) in the whole grid
  bool periodic[3];        ///< with both sides on this rank
  bool whole_periodic[3];  ///< of the whole grid
  double low[3], high[3];  ///< corners of the whole grid, m
  double h[3];             ///< width of the cells, m; of a stretched axis that of its `Core`, the least
  double inverse_h[3];     ///< 1/m
  double start[3];         ///< coordinate of face 0 of the whole grid if all of its cells were h wide, m
  const double* table[3];  ///< entry 0 of a stretched axis, in memory of the backend; null along others
  std::int64_t table_row;  ///< entries of a row of `table`
  std::int64_t stride[3];  ///< of an array with ghost cells, in numbers
  std::int64_t component;  ///< numbers of one component with its ghost cells
  std::int64_t first;      ///< offset of cell (0, 0, 0) in a component

  [[nodiscard]] KOKKOS_FUNCTION bool is_stretched(int axis) const { return table[axis] != nullptr; }
  /// True with a stretched axis.
  [[nodiscard]] KOKKOS_FUNCTION bool is_stretched() const {
    return is_stretched(0) || is_stretched(1) || is_stretched(2);
  }
  /// Row of the table of a stretched axis, at cell 0.
  [[nodiscard]] KOKKOS_FUNCTION const double* row(int axis, AxisRow which) const {
    return table[axis] + static_cast<int>(which) * table_row;
  }
  /// 1 / width of cell i, 1/m.
  [[nodiscard]] KOKKOS_FUNCTION double inverse_width(int axis, int i) const {
    return is_stretched(axis) ? row(axis, AxisRow::inverse_width)[i] : inverse_h[axis];
  }
  /// 1 / distance between the centres of cells i - 1 and i, 1/m.
  [[nodiscard]] KOKKOS_FUNCTION double inverse_gap(int axis, int i) const {
    return is_stretched(axis) ? row(axis, AxisRow::inverse_gap)[i] : inverse_h[axis];
  }
  /// 1 / width along an axis of the control volume of component c at index i, 1/m.
  [[nodiscard]] KOKKOS_FUNCTION double inverse_extent(int c, int axis, int i) const {
    return c == axis ? inverse_gap(axis, i) : inverse_width(axis, i);
  }
  /// 1 / distance along an axis of component c at index i from that at i - 1, 1/m.
  [[nodiscard]] KOKKOS_FUNCTION double inverse_step(int c, int axis, int i) const {
    return c == axis ? inverse_width(axis, i - 1) : inverse_gap(axis, i);
  }
  /// 1 / least width of the cells on both sides of face i of a stretched axis, 1/m.
  [[nodiscard]] KOKKOS_FUNCTION double inverse_least_width(int axis, int i) const {
    const double* inverse = row(axis, AxisRow::inverse_width) + i;
    return inverse[-1] > inverse[0] ? inverse[-1] : inverse[0];
  }
  /// Half the difference over the sum of the widths of cells i and i - 1. With it, half the sum of two values
  /// a in cell i - 1 and b in cell i, plus `skew` (b - a), is their mean over the two halves of a control
  /// volume from the centre of cell i - 1 to that of cell i: the mass that leaves the volume is half of what
  /// leaves both cells, and equal values are kept bit for bit.
  [[nodiscard]] KOKKOS_FUNCTION double skew(int axis, int i) const {
    return is_stretched(axis) ? row(axis, AxisRow::skew)[i] : 0.0;
  }
  /// Ratio of the width of cell i to h.
  [[nodiscard]] KOKKOS_FUNCTION double relative_width(int axis, int i) const {
    return is_stretched(axis) ? row(axis, AxisRow::relative_width)[i] : 1.0;
  }
  /// Ratio of the volume of cell (i, j, k) to that of a cell with the widths h.
  [[nodiscard]] KOKKOS_FUNCTION double relative_volume(int i, int j, int k) const {
    return relative_width(0, i) * relative_width(1, j) * relative_width(2, k);
  }
  /// Coordinate of face `i` of the whole grid, or of the centre of cell `i`, m. The last face is the high
  /// side, without round-off.
  [[nodiscard]] KOKKOS_FUNCTION double coordinate(int axis, int i, bool on_faces) const {
    if (on_faces && i == whole[axis]) return high[axis];
    if (!is_stretched(axis)) return low[axis] + (i + (on_faces ? 0.0 : 0.5)) * h[axis];
    const double* faces = row(axis, AxisRow::face) + (i - origin[axis]);
    return on_faces ? faces[0] : 0.5 * (faces[0] + faces[1]);
  }
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

/// The widths of a grid without stretched axes in the form of `MacGrid`. What takes either as a parameter is
/// compiled for such grids as if there were no others: with the same bits and the same speed.
struct UniformWidths {
  static constexpr bool are_equal = true;
  const MacGrid& grid;

  [[nodiscard]] KOKKOS_FUNCTION double inverse_width(int axis, int) const { return grid.inverse_h[axis]; }
  [[nodiscard]] KOKKOS_FUNCTION double inverse_gap(int axis, int) const { return grid.inverse_h[axis]; }
  [[nodiscard]] KOKKOS_FUNCTION double inverse_extent(int, int axis, int) const {
    return grid.inverse_h[axis];
  }
  [[nodiscard]] KOKKOS_FUNCTION double inverse_step(int, int axis, int) const { return grid.inverse_h[axis]; }
  [[nodiscard]] KOKKOS_FUNCTION double relative_width(int, int) const { return 1.0; }
  [[nodiscard]] KOKKOS_FUNCTION double relative_volume(int, int, int) const { return 1.0; }
};

/// The grid, or its `UniformWidths` if it has no stretched axis. Does not throw.
template <bool is_stretched>
[[nodiscard]] KOKKOS_INLINE_FUNCTION decltype(auto) widths_of(const MacGrid& grid) {
  if constexpr (is_stretched)
    return (grid);
  else
    return UniformWidths{grid};
}

/// Calls `launch.template operator()<is_stretched>()` for a grid with stretched axes, or without: they have
/// kernels of their own.
template <class Launch>
void launch_for_widths(const MacGrid& grid, const Launch& launch) {
  grid.is_stretched() ? launch.template operator()<true>() : launch.template operator()<false>();
}

}  // namespace drogue::flow
