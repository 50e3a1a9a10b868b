#pragma once

#include <vector>

#include "kernels/reference/coupling/grid_transfer.hpp"

namespace drogue::reference {

/// Line between two vertices, or body at one: `from` equals `to`.
struct DragLine {
  std::size_t from = 0, to = 0;
  double across = 0.0, along = 0.0;  ///< coefficient times diameter, m; of a body `across` times area, m^2
  std::size_t points = 1;
};

/// Free vertices under drag alone.
struct DragState {
  std::vector<Vector> positions, velocities;  ///< m, m/s
  std::vector<double> masses;                 ///< kg
};

/// Points of all lines, one after another, in the middle of a step of dt, s, m.
[[nodiscard]] std::vector<Vector> drag_points(const std::vector<DragLine>& lines, const DragState& state,
                                              double dt);

/// Takes a step of dt, s, in equal parts by the backward Euler method, with the drag on each vertex linear in
/// its velocity: speeds are those of the beginning. `air`: velocity at `drag_points`, m/s. Returns the mean
/// force of the air at each point, N.
std::vector<Vector> take_drag_step(const std::vector<DragLine>& lines, const std::vector<Vector>& air,
                                   double density, double dt, int parts, DragState& state);

}  // namespace drogue::reference
