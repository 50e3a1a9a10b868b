#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/flow/axis_lines.hpp"
#include "kernels/flow/mac_grid.hpp"
#include "kernels/flow/parameters.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Tables of the stretched axes of a grid (`MacGrid::table`), in memory of a backend. Takes none for uniform
/// ones.
template <class ExecutionSpace>
class AxisTables {
 public:
  /// Blocks. Throws std::runtime_error if memory runs out.
  AxisTables(const ExecutionSpace& space, const Parameters& p) {
    std::vector<double> entries;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (is_stretched(p, axis)) _row = std::max(_row, p.cells[axis] + before + after);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!is_stretched(p, axis)) continue;
      _first[axis] = static_cast<std::int64_t>(entries.size()) + before;
      entries.resize(entries.size() + rows * static_cast<std::size_t>(_row));
      fill(p, axis, entries.data() + _first[axis]);
    }
    if (entries.empty()) return;
    _entries = List<ExecutionSpace>(
        Kokkos::view_alloc(space, Kokkos::WithoutInitializing, "drogue::flow::axis_tables"), entries.size());
    device::copy_in(space, _entries, entries.data(), entries.size());
    space.fence("drogue::flow::axis_tables: allocated");
  }

  /// The grid, or a rank's part of it, with the tables, which must outlive it. Does not throw.
  [[nodiscard]] MacGrid attach(MacGrid grid) const {
    grid.table_row = _row;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (_first[axis] >= 0) grid.table[axis] = _entries.data() + _first[axis] + grid.origin[axis];
    return grid;
  }

 private:
  static constexpr std::size_t rows = static_cast<std::size_t>(AxisRow::count);
  /// Entries before cell 0, and from cell n on: packs may load beyond the ghost cells.
  static constexpr int before = ghost_width, after = 16;

  void fill(const Parameters& p, std::size_t axis, double* cell_0) const {
    const int n = p.cells[axis];
    const bool is_periodic = p.boundary[2 * axis].kind == BoundaryKind::periodic;
    const double h = core_of(p).spacing[axis];
    const auto width = [&](int i) {
      if (is_periodic) return cell_width(p, axis, (i + n) % n);
      return cell_width(p, axis, i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i);
    };
    int axes = 0;
    for (const int cells : p.cells) axes += cells > 1 ? 1 : 0;
    const auto at = [&](AxisRow which, int i) -> double& {
      return cell_0[static_cast<int>(which) * _row + i];
    };
    for (int i = 0; i <= n; ++i) at(AxisRow::face, i) = face_coordinate(p, axis, i);
    for (int i = -ghost_width; i < n + ghost_width; ++i) {
      const double own = width(i), last = i > -ghost_width ? width(i - 1) : own;
      at(AxisRow::inverse_width, i) = 1.0 / own;
      at(AxisRow::inverse_gap, i) = 2.0 / (last + own);
      at(AxisRow::skew, i) = 0.5 * (own - last) / (own + last);
      at(AxisRow::relative_width, i) = own / h;
      at(AxisRow::filter, i) = std::pow(own / h, 2.0 / axes);
    }
  }

  int _row = 0;
  std::array<std::int64_t, 3> _first = {-1, -1, -1};
  List<ExecutionSpace> _entries;
};

}  // namespace drogue::flow
