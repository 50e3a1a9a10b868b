#pragma once

#include "kernels/flow/boundary/conditions.hpp"

namespace drogue::flow {

/// Ghost value of a component: `constant` + `factor` times the value at cell `index`.
struct GhostValue {
  int index;
  double constant, factor;
};

/// Ghost value along one axis. `index[axis]` lies outside of [0, n), on a boundary face or inside. A
/// component normal to the axis lies on its faces, the others between them.
///
/// Walls and inflows: linear extrapolation through the prescribed velocity at the side. Slip: even extension
/// of tangential, odd extension of normal components. Outflow: constant extension. Ghost cells towards other
/// ranks keep their values.
template <class ExecutionSpace>
KOKKOS_INLINE_FUNCTION GhostValue ghost_value(const MacGrid& g, const BoundaryConditions<ExecutionSpace>& b,
                                              int axis, int component, const int index[3]) {
  const int n = g.n[axis], i = index[axis];
  const bool normal = axis == component;
  if (n == 1) return {0, 0.0, 1.0};
  if (g.periodic[axis]) return {i < 0 ? i + n : i >= n ? i - n : i, 0.0, 1.0};
  const bool low = i <= 0 && (normal || i < 0);
  const bool high = i >= n;
  if (!low && !high) return {i, 0.0, 1.0};
  const int side = 2 * axis + (high ? 1 : 0);
  // Mirror image across the face at 0 or n.
  const int face = high ? n : 0;
  const int mirror = normal ? 2 * face - i : 2 * face - 1 - i;
  switch (b.kind[side]) {
    case BoundaryKind::slip:
      if (!normal) return {mirror, 0.0, 1.0};
      return i == face ? GhostValue{i, 0.0, 0.0} : GhostValue{mirror, 0.0, -1.0};
    case BoundaryKind::outflow:
      // The normal velocity on the face is an unknown of the projection.
      return {normal ? face : high ? n - 1 : 0, 0.0, 1.0};
    case BoundaryKind::neighbour:
      return {i, 0.0, 1.0};
    default: {
      const double value = b.value(g, side, component, index);
      if (normal && i == face) return {i, value, 0.0};
      return {mirror, 2.0 * value, -1.0};
    }
  }
}

/// Fills ghost cells and boundary faces of all components, unless the step has failed: then the tables are
/// not those of the velocity. On the edge between two sides a component has the velocity of the side that it
/// is tangential to: the condition of its own axis comes last, whatever the order of the axes.
template <class ExecutionSpace>
struct GhostFunctor {
  MacGrid grid;
  BoundaryConditions<ExecutionSpace> boundary;
  List<ExecutionSpace> velocity;
  ControlView<ExecutionSpace> control;
  int slab[3];                 ///< boundary layers at each side, with the boundary faces; see `launch_ghosts`
  std::int64_t slab_cells[3];  ///< cells of the slabs normal to each axis

  KOKKOS_FUNCTION void operator()(std::int64_t cell) const {
    if (control().has_failed()) return;
    const MacGrid& g = grid;
    int axis = 2;
    while (axis > 0 && cell >= slab_cells[axis]) cell -= slab_cells[axis--];
    // The slabs normal to z span all cells with ghosts, those normal to y the inner planes, and so on.
    int index[3], extent[3];
    for (int a = 0; a < 3; ++a)
      extent[a] = a < axis ? g.n[a] + 2 * g.ghost[a] : a == axis ? 2 * slab[a] - 1 : inner(a);
    index[0] = static_cast<int>(cell % extent[0]);
    index[1] = static_cast<int>(cell / extent[0] % extent[1]);
    index[2] = static_cast<int>(cell / extent[0] / extent[1]);
    for (int a = 0; a < 3; ++a) {
      if (a < axis)
        index[a] -= g.ghost[a];
      else if (a == axis)
        index[a] = index[a] < slab[a] ? index[a] - g.ghost[a] : g.n[a] + index[a] - slab[a];
      else
        index[a] += slab[a] - g.ghost[a];
    }
    for (int c = 0; c < 3; ++c) {
      double constant = 0.0, factor = 1.0;
      int from[3] = {index[0], index[1], index[2]};
      for (int turn = 1; turn <= 3; ++turn) {
        const int a = (c + turn) % 3;
        const GhostValue value = ghost_value(g, boundary, a, c, from);
        from[a] = value.index;
        constant += factor * value.constant;
        factor *= value.factor;
      }
      const std::int64_t base = c * g.component;
      const double source = factor != 0.0 ? velocity(base + g.offset(from[0], from[1], from[2])) : 0.0;
      velocity(base + g.offset(index[0], index[1], index[2])) = constant + factor * source;
    }
  }

 private:
  /// Cells along an axis between its slabs.
  [[nodiscard]] KOKKOS_FUNCTION int inner(int axis) const {
    return grid.ghost[axis] > 0 ? grid.n[axis] - 1 : grid.n[axis];
  }
};

/// Enqueues the fill of the ghost cells and boundary faces of a velocity field, but for those that are in no
/// layer of ghost cells along `first_axis` or a later axis. Asynchronous.
template <class ExecutionSpace>
void launch_ghosts(const ExecutionSpace& space, const MacGrid& g,
                   const BoundaryConditions<ExecutionSpace>& boundary, const List<ExecutionSpace>& velocity,
                   const ControlView<ExecutionSpace>& control, int first_axis = 0) {
  GhostFunctor<ExecutionSpace> functor{.grid = g,
                                       .boundary = boundary,
                                       .velocity = velocity,
                                       .control = control,
                                       .slab = {},
                                       .slab_cells = {}};
  std::int64_t total = 0;  // below 2^31 for any grid that fits a device
  for (int axis = first_axis; axis < 3; ++axis) {
    // Layers -ghost .. 0 and n .. n + ghost - 1: the low boundary face belongs to the slab.
    functor.slab[axis] = g.ghost[axis] > 0 ? g.ghost[axis] + 1 : 0;
    if (g.ghost[axis] == 0) continue;
    std::int64_t cells = 2 * functor.slab[axis] - 1;
    for (int a = 0; a < 3; ++a) {
      if (a < axis) cells *= g.n[a] + 2 * g.ghost[a];
      if (a > axis) cells *= g.ghost[a] > 0 ? g.n[a] - 1 : g.n[a];
    }
    functor.slab_cells[axis] = cells;
    total += cells;
  }
  device::launch_each(space, "drogue::flow::ghosts", static_cast<int>(total), functor);
}

}  // namespace drogue::flow
