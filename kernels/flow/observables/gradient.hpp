#pragma once

#include "kernels/flow/mac_grid.hpp"

namespace drogue::flow {

/// Derivative of velocity component i along axis j around a cell of a staggered field with ghost cells, 1/s:
/// at the centre for i == j, else at the edge at the low sides along i and j. Zero along axes with one cell.
/// `u` points at component 0 of the cell, whose index along axis j is `index`. `widths`: the grid, or its
/// `UniformWidths`.
template <class Widths>
KOKKOS_INLINE_FUNCTION double staggered_derivative(const MacGrid& g, const Widths& widths, const double* u,
                                                   int i, int j, int index) {
  if (g.n[j] == 1) return 0.0;
  const double* q = u + i * g.component;
  return (i == j ? widths.inverse_width(j, index) : widths.inverse_gap(j, index)) *
         (i == j ? q[g.stride[j]] - q[0] : q[0] - q[-g.stride[j]]);
}

/// Step to the next edge along an axis; zero along axes with one cell, whose ghost cells do not exist.
KOKKOS_INLINE_FUNCTION std::int64_t edge_step(const MacGrid& g, int axis) {
  return g.n[axis] > 1 ? g.stride[axis] : 0;
}

/// `centred_gradient` with the widths of the grid, or its `UniformWidths`.
template <class Widths>
KOKKOS_INLINE_FUNCTION void gradient_of_widths(const MacGrid& g, const Widths& widths, const double* u,
                                               const int (&cell)[3], double gradient[3][3]) {
  const auto derivative = [&](const double* at, int i, int j, int index) {
    return staggered_derivative(g, widths, at, i, j, index);
  };
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int low = cell[j], high = low + 1;
      if (i == j) {
        gradient[i][j] = derivative(u, i, j, low);
        continue;
      }
      const std::int64_t a = edge_step(g, i), b = edge_step(g, j);
      gradient[i][j] = 0.25 * (derivative(u, i, j, low) + derivative(u + a, i, j, low) +
                               derivative(u + b, i, j, high) + derivative(u + a + b, i, j, high));
    }
}

/// Velocity gradient at the centre of a cell, 1/s, second order: `gradient[i][j]` is the derivative of
/// component i along axis j, a mean over the four edges parallel to the third axis for i != j. `u` points at
/// component 0 of the cell.
KOKKOS_INLINE_FUNCTION void centred_gradient(const MacGrid& g, const double* u, const int (&cell)[3],
                                             double gradient[3][3]) {
  if (g.is_stretched())
    gradient_of_widths(g, g, u, cell, gradient);
  else
    gradient_of_widths(g, UniformWidths{g}, u, cell, gradient);
}

}  // namespace drogue::flow
