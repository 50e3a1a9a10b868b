#pragma once

#include "kernels/coupling/face_stencil.hpp"
#include "kernels/coupling/staggered_grid.hpp"
#include "kernels/flow/mac_grid.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Values at the faces of one component, by the indices of the faces, where the solver keeps them.
template <class ExecutionSpace>
using FaceView = Kokkos::View<double***, Kokkos::LayoutStride, typename ExecutionSpace::memory_space,
                              Kokkos::MemoryUnmanaged>;

/// Whole grid in the form that transfers between points and faces take; lengths in m. Axes with one cell are
/// periodic. A stretched axis is continued from its core with the width of the cells there, so that
/// coordinates are true in the core alone. Does not throw.
[[nodiscard]] inline coupling::StaggeredGrid coupling_grid(const MacGrid& g) {
  coupling::StaggeredGrid grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.cells[axis] = g.whole[axis];
    grid.origin[axis] = g.start[axis];
    grid.spacing[axis] = g.h[axis];
    grid.periodic[axis] = g.whole_periodic[axis] || g.whole[axis] == 1;
  }
  return grid;
}

/// Faces of a rank in that form: the low faces of its cells, and those on high sides of the domain. Does not
/// throw.
[[nodiscard]] inline coupling::FaceWindow face_window(const MacGrid& g) {
  const coupling::StaggeredGrid grid = coupling_grid(g);
  coupling::FaceWindow window{};
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_highest = g.origin[axis] + g.n[axis] == g.whole[axis];
    for (int c = 0; c < 3; ++c)
      window.set(c, axis, g.origin[axis],
                 g.n[axis] + (is_highest ? faces_along(grid, c, axis) - g.whole[axis] : 0));
  }
  return window;
}

/// Faces of the three components without ghost cells in an array of the solver, which must outlive the Views;
/// in the unit of the array. For `coupling::interpolate` and `coupling::spread`, which read and write there
/// without a copy. Does not throw.
template <class ExecutionSpace>
[[nodiscard]] coupling::FaceViews<FaceView<ExecutionSpace>> face_views(const MacGrid& g,
                                                                       const List<ExecutionSpace>& values) {
  const coupling::FaceWindow window = face_window(g);
  const auto stride = [&](int axis) { return static_cast<std::size_t>(g.stride[axis]); };
  coupling::FaceViews<FaceView<ExecutionSpace>> views;
  for (int c = 0; c < 3; ++c) {
    const auto extent = [&](int axis) { return static_cast<std::size_t>(window.faces(c, axis)); };
    views.component[c] = FaceView<ExecutionSpace>(
        values.data() + c * g.component + g.first,
        Kokkos::LayoutStride(extent(0), stride(0), extent(1), stride(1), extent(2), stride(2)));
  }
  return views;
}

}  // namespace drogue::flow
