#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>

#include "kernels/device/launch.hpp"
#include "kernels/flow/boundary/conditions.hpp"
#include "kernels/flow/launch.hpp"
#include "kernels/flow/parameters.hpp"

namespace drogue::flow {

/// Throws std::invalid_argument if the grid of a flow cannot move along the marked axes: along axes of one
/// cell, towards walls or slip sides, and with sides whose velocity is an expression.
inline void check_frame(const Parameters& parameters, const std::array<bool, 3>& axes) {
  for (std::size_t side = 0; side < 6; ++side) {
    const Boundary& boundary = parameters.boundary[side];
    if (!boundary.velocity_expressions.empty())
      throw std::invalid_argument("flow solver: a moving frame needs sides with constant velocities");
    if (!axes[side / 2]) continue;
    if (parameters.cells[side / 2] == 1)
      throw std::invalid_argument("flow solver: a frame cannot move along an axis of one cell");
    if (boundary.kind == BoundaryKind::wall || boundary.kind == BoundaryKind::slip)
      throw std::invalid_argument("flow solver: a frame cannot move towards a wall or a slip side");
  }
}

/// Subtracts a uniform velocity from all components, ghost cells included: the discrete divergence of the
/// cells does not change.
template <class ExecutionSpace>
struct ShiftVelocityFunctor {
  List<ExecutionSpace> velocity;
  std::int64_t component;  ///< numbers of one component
  double shift[3];         ///< m/s

  KOKKOS_FUNCTION void operator()(const int i) const {
    for (int c = 0; c < 3; ++c)
      if (shift[c] != 0.0) velocity(static_cast<std::size_t>(c * component + i)) -= shift[c];
  }
};

/// Changes the rates of the previous step, which AB2 extrapolates, to those in a frame that moves faster by
/// `shift`: advection -(u grad) u becomes -((u - shift) grad) u. Needs the velocity before its shift, with
/// ghost cells; central differences of second order, and upwind ones of first order on outflows, as the rates
/// there.
template <class ExecutionSpace>
struct ShiftRatesFunctor {
  MacGrid grid;
  BoundaryConditions<ExecutionSpace> boundary;
  List<ExecutionSpace> velocity, rate;
  double shift[3];  ///< m/s; zero along axes of one cell

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int k) const {
    const MacGrid& g = grid;
    const int index[3] = {i, j, k};
    for (int c = 0; c < 3; ++c) {
      const std::int64_t at = c * g.component + g.offset(i, j, k);
      double change = 0.0;
      for (int a = 0; a < 3; ++a)
        if (shift[a] != 0.0)
          change +=
              0.5 * g.inverse_h[a] * shift[a] * (velocity(at + g.stride[a]) - velocity(at - g.stride[a]));
      rate(at) += change;
    }
    for (int side = 0; side < 6; ++side) {
      const int axis = side / 2;
      const bool high = side % 2 == 1;
      if (g.n[axis] == 1 || boundary.kind[side] != BoundaryKind::outflow ||
          index[axis] != (high ? g.n[axis] - 1 : 0))
        continue;
      const std::int64_t cell = axis * g.component + g.offset(i, j, k), stride = g.stride[axis],
                         face = high ? cell + stride : cell;
      double change = 0.0;
      if (high ? velocity(face) > 0.0 : velocity(face) < 0.0)
        change = shift[axis] * g.inverse_h[axis] * (velocity(cell + stride) - velocity(cell));
      for (int a = 0; a < 3; ++a)
        if (a != axis && shift[a] != 0.0)
          change +=
              0.5 * g.inverse_h[a] * shift[a] * (velocity(face + g.stride[a]) - velocity(face - g.stride[a]));
      // The rate of the low face stands in the ghost cell below it (`BoundaryFacesFunctor`).
      rate(high ? face : face - stride) += change;
    }
  }
};

/// Enqueues the change of a velocity, m/s, and of its rates, m/s^2, unless `rate` is empty, to those in a
/// frame that moves faster by `shift`, m/s. Asynchronous. Throws only after a failed launch.
template <class ExecutionSpace>
void launch_frame_shift(const ExecutionSpace& space, const MacGrid& grid,
                        const BoundaryConditions<ExecutionSpace>& boundary,
                        const List<ExecutionSpace>& velocity, const List<ExecutionSpace>& rate,
                        const double (&shift)[3]) {
  if (rate.size() > 0)
    launch_cells(
        space, "drogue::flow::shift_rates", grid.n,
        ShiftRatesFunctor<ExecutionSpace>{grid, boundary, velocity, rate, {shift[0], shift[1], shift[2]}});
  device::launch_each(
      space, "drogue::flow::shift_velocity", static_cast<int>(grid.component),
      ShiftVelocityFunctor<ExecutionSpace>{velocity, grid.component, {shift[0], shift[1], shift[2]}});
}

}  // namespace drogue::flow
