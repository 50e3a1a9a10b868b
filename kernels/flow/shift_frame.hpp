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

/// Adds `weight`, 1/s, times the change of the velocity that a stage predicts to the rates of the previous
/// step, which AB2 extrapolates.
template <class ExecutionSpace>
struct AddRatesFunctor {
  MacGrid grid;
  BoundaryConditions<ExecutionSpace> boundary;
  List<ExecutionSpace> velocity, predicted, rate;
  double weight;

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int k) const {
    const MacGrid& g = grid;
    const int index[3] = {i, j, k};
    const auto change = [&](std::int64_t face) { return weight * (predicted(face) - velocity(face)); };
    for (int c = 0; c < 3; ++c) {
      const std::int64_t face = c * g.component + g.offset(i, j, k), next = face + g.stride[c];
      rate(face) += change(face);
      if (g.n[c] == 1) continue;
      // The rate of a low outflow stands in the ghost cell below it (`BoundaryFacesFunctor`).
      if (index[c] == 0 && boundary.kind[2 * c] == BoundaryKind::outflow)
        rate(face - g.stride[c]) += change(face);
      if (index[c] == g.n[c] - 1 && boundary.kind[2 * c + 1] == BoundaryKind::outflow)
        rate(next) += change(next);
    }
  }
};

}  // namespace drogue::flow
