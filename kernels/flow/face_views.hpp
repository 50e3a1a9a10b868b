#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/coupling/face_stencil.hpp"
#include "kernels/coupling/staggered_grid.hpp"
#include "kernels/flow/core.hpp"
#include "kernels/flow/mac_grid.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Values at the faces of one component, by the indices of the faces, where the solver keeps them.
template <class ExecutionSpace>
using FaceView = Kokkos::View<double***, Kokkos::LayoutStride, typename ExecutionSpace::memory_space,
                              Kokkos::MemoryUnmanaged>;

/// All cells of a grid. A stretched axis is continued from its core with the width of the cells there, so
/// that coordinates are true in the core alone. Does not throw.
[[nodiscard]] inline Core whole_box(const MacGrid& g) {
  Core box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.cells[axis] = g.whole[axis];
    box.low[axis] = g.start[axis];
    box.spacing[axis] = g.h[axis];
    box.high[axis] = box.low[axis] + box.cells[axis] * box.spacing[axis];
  }
  return box;
}

/// Cells of a box of the whole grid in the form that transfers between points and faces take; lengths in m.
/// Axes with one cell are periodic, others where the box has all cells of a periodic axis. Does not throw.
[[nodiscard]] inline coupling::StaggeredGrid coupling_grid(const MacGrid& g, const Core& box) {
  coupling::StaggeredGrid grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.cells[axis] = box.cells[axis];
    grid.origin[axis] = box.low[axis];
    grid.spacing[axis] = box.spacing[axis];
    const bool is_whole = box.cells[axis] == g.whole[axis];
    grid.periodic[axis] = is_whole && (g.whole_periodic[axis] || g.whole[axis] == 1);
  }
  return grid;
}
[[nodiscard]] inline coupling::StaggeredGrid coupling_grid(const MacGrid& g) {
  return coupling_grid(g, whole_box(g));
}

/// Faces of a rank in that form, by their indices in the box: the low faces of its cells, and those on high
/// sides of the domain. Does not throw.
[[nodiscard]] inline coupling::FaceWindow face_window(const MacGrid& g, const Core& box) {
  const coupling::StaggeredGrid whole = coupling_grid(g), grid = coupling_grid(g, box);
  coupling::FaceWindow window{};
  for (int axis = 0; axis < 3; ++axis) {
    const int before = box.begin[static_cast<std::size_t>(axis)],
              begin = std::max(g.origin[axis] - before, 0);
    const bool is_highest = g.origin[axis] + g.n[axis] == g.whole[axis];
    for (int c = 0; c < 3; ++c) {
      const int own = g.n[axis] + (is_highest ? faces_along(whole, c, axis) - g.whole[axis] : 0),
                end = std::min(g.origin[axis] + own - before, faces_along(grid, c, axis));
      window.set(c, axis, begin, std::max(end - begin, 0));
    }
  }
  return window;
}
[[nodiscard]] inline coupling::FaceWindow face_window(const MacGrid& g) {
  return face_window(g, whole_box(g));
}

/// Faces of a rank in a box of the grid, of the three components without ghost cells in an array of the
/// solver, which must outlive the Views; in the unit of the array. For `coupling::interpolate` and
/// `coupling::spread`, which read and write there without a copy. Does not throw.
template <class ExecutionSpace>
[[nodiscard]] coupling::FaceViews<FaceView<ExecutionSpace>> face_views(const MacGrid& g, const Core& box,
                                                                       const List<ExecutionSpace>& values) {
  const coupling::FaceWindow window = face_window(g, box);
  const auto stride = [&](int axis) { return static_cast<std::size_t>(g.stride[axis]); };
  coupling::FaceViews<FaceView<ExecutionSpace>> views;
  for (int c = 0; c < 3; ++c) {
    const auto extent = [&](int axis) { return static_cast<std::size_t>(window.faces(c, axis)); };
    std::int64_t first = c * g.component + g.first;
    for (int axis = 0; axis < 3; ++axis)
      if (extent(axis) > 0)
        first += g.stride[axis] *
                 (window.first(c, axis) + box.begin[static_cast<std::size_t>(axis)] - g.origin[axis]);
    views.component[c] = FaceView<ExecutionSpace>(
        values.data() + first,
        Kokkos::LayoutStride(extent(0), stride(0), extent(1), stride(1), extent(2), stride(2)));
  }
  return views;
}
template <class ExecutionSpace>
[[nodiscard]] coupling::FaceViews<FaceView<ExecutionSpace>> face_views(const MacGrid& g,
                                                                       const List<ExecutionSpace>& values) {
  return face_views<ExecutionSpace>(g, whole_box(g), values);
}

}  // namespace drogue::flow
