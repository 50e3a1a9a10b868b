#pragma once

#include <cmath>

#include "kernels/flow/launch.hpp"
#include "kernels/flow/observables/gradient.hpp"
#include "kernels/flow/parameters.hpp"
#include "kernels/flow/views.hpp"
#include "kernels/stepping/step_control.hpp"

namespace drogue::flow {

/// Model of unresolved scales and its constant C, with the width of the filter along each axis, m, in a cell
/// with the widths `MacGrid::h`; zero along axes with one cell.
struct EddyModel {
  Turbulence model;
  double constant;
  double width[3];
  double squared_mean_width;  ///< m^2, of the geometric mean over axes with more than one cell
};

/// Model with the default constant unless `parameters` has another one. Does not throw.
inline EddyModel make_eddy_model(const Parameters& parameters, const MacGrid& grid) {
  const double standard = default_constant(parameters.turbulence);
  EddyModel model{parameters.turbulence,
                  parameters.turbulence_constant > 0.0 ? parameters.turbulence_constant : standard,
                  {0.0, 0.0, 0.0},
                  0.0};
  double product = 1.0;
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.n[axis] == 1) continue;
    model.width[axis] = grid.h[axis];
    product *= grid.h[axis];
    ++axes;
  }
  model.squared_mean_width = std::pow(product, 2.0 / axes);
  return model;
}

/// The model in cell `index`. Does not throw.
KOKKOS_INLINE_FUNCTION EddyModel model_in_cell(EddyModel model, const MacGrid& g, const int (&index)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!g.is_stretched(axis)) continue;
    model.width[axis] *= g.relative_width(axis, index[axis]);
    model.squared_mean_width *= g.row(axis, AxisRow::filter)[index[axis]];
  }
  return model;
}

/// Eddy viscosity for a velocity gradient, 1/s, `gradient[i][j]` the derivative of component i along axis j,
/// m^2/s. Smagorinsky 1963: (C delta)^2 sqrt(2 S:S). Vreman 2004, eq. (5): C sqrt(B / (alpha:alpha)).
KOKKOS_INLINE_FUNCTION double eddy_viscosity(const EddyModel& m, const double gradient[3][3]) {
  if (m.model == Turbulence::smagorinsky) {
    double squared = 0.0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const double twice_strain = gradient[i][j] + gradient[j][i];
        squared += 0.5 * twice_strain * twice_strain;
      }
    return m.constant * m.constant * m.squared_mean_width * Kokkos::sqrt(squared);
  }
  double norm = 0.0, beta[3][3] = {};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      norm += gradient[i][j] * gradient[i][j];
      for (int axis = 0; axis < 3; ++axis)
        beta[i][j] += m.width[axis] * m.width[axis] * gradient[i][axis] * gradient[j][axis];
    }
  const double minors = beta[0][0] * beta[1][1] - beta[0][1] * beta[0][1] + beta[0][0] * beta[2][2] -
                        beta[0][2] * beta[0][2] + beta[1][1] * beta[2][2] - beta[1][2] * beta[1][2];
  // Round-off may make the minors negative; without a gradient there is no eddy viscosity.
  return norm > 0.0 && minors > 0.0 ? m.constant * Kokkos::sqrt(minors / norm) : 0.0;
}

/// Cells with an eddy viscosity: those of the grid, and one layer of ghost cells towards other ranks.
struct EddyCells {
  int first[3];   ///< -1 with a layer below the low side, else 0
  int extent[3];  ///< number along each axis

  /// Place in an array, x fastest, of the cell nearest to an index.
  [[nodiscard]] KOKKOS_FUNCTION std::size_t nearest(const int cell[3]) const {
    std::int64_t place = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const int along = cell[axis] - first[axis], last = extent[axis] - 1;
      place = place * extent[axis] + (along < 0 ? 0 : along > last ? last : along);
    }
    return static_cast<std::size_t>(place);
  }
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(extent[0]) * static_cast<std::size_t>(extent[1]) *
           static_cast<std::size_t>(extent[2]);
  }
};

/// Cells with an eddy viscosity of a grid with sides of these kinds. Does not throw.
inline EddyCells make_eddy_cells(const MacGrid& grid, const BoundaryKind kind[6]) {
  EddyCells cells{};
  for (int axis = 0; axis < 3; ++axis) {
    const int low = kind[2 * axis] == BoundaryKind::neighbour ? 1 : 0;
    const int high = kind[2 * axis + 1] == BoundaryKind::neighbour ? 1 : 0;
    cells.first[axis] = -low;
    cells.extent[axis] = low + grid.n[axis] + high;
  }
  return cells;
}

/// Evaluates the eddy viscosity at the centres of `cells` and its maximum, which limits dt.
template <class ExecutionSpace, bool is_stretched>
struct EddyViscosityFunctor {
  MacGrid grid;
  EddyModel model;
  List<ExecutionSpace> velocity;  ///< m/s, with ghost cells
  EddyCells cells;
  List<ExecutionSpace> viscosity;  ///< m^2/s, x fastest
  ControlView<ExecutionSpace> control;

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int k) const {
    Control& c = control();
    if (c.trial.stop != stepping::Stop::running) return;
    const int cell[3] = {i + cells.first[0], j + cells.first[1], k + cells.first[2]};
    double gradient[3][3];
    gradient_of_widths(grid, widths_of<is_stretched>(grid),
                       velocity.data() + grid.offset(cell[0], cell[1], cell[2]), cell, gradient);
    EddyModel of_cell = model;
    if constexpr (is_stretched) of_cell = model_in_cell(model, grid, cell);
    const double value = eddy_viscosity(of_cell, gradient);
    viscosity(cells.nearest(cell)) = value;
    raise(c.eddy_viscosity, Kokkos::bit_cast<std::uint64_t>(value));
  }
};

/// Acceleration by the eddy viscosity, div(2 nu_t S), at the low faces of each cell, m/s^2. The eddy
/// viscosity outside of a side is that of the cell inside.
template <class ExecutionSpace, bool is_stretched>
struct EddyStressFunctor {
  MacGrid grid;
  List<ExecutionSpace> velocity;  ///< m/s, with ghost cells
  EddyCells cells;
  List<ExecutionSpace> viscosity;     ///< m^2/s, x fastest
  List<ExecutionSpace> acceleration;  ///< m/s^2, in the layout of `velocity`
  ControlView<ExecutionSpace> control;

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int k) const {
    if (control().trial.stop != stepping::Stop::running) return;
    accelerate(widths_of<is_stretched>(grid), {i, j, k});
  }

 private:
  template <class Widths>
  KOKKOS_FUNCTION void accelerate(const Widths& widths, const int (&cell)[3]) const {
    const MacGrid& g = grid;
    const std::int64_t place = g.offset(cell[0], cell[1], cell[2]);
    const double* u = velocity.data() + place;
    for (int c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (int d = 0; d < 3; ++d)
        if (g.n[d] > 1)
          sum += widths.inverse_extent(c, d, cell[d]) *
                 (stress(widths, cell, u, c, d, 1) - stress(widths, cell, u, c, d, 0));
      acceleration(static_cast<std::size_t>(c * g.component + place)) = sum;
    }
  }

  /// Stress 2 nu_t S_cd, m^2/s^2, on the low (0) or high (1) face along d of the control volume of component
  /// c.
  template <class Widths>
  KOKKOS_FUNCTION double stress(const Widths& widths, const int cell[3], const double* u, int c, int d,
                                int high) const {
    const MacGrid& g = grid;
    int at[3] = {cell[0], cell[1], cell[2]};
    if (c == d) {
      // The faces lie at the centres of the cells on both sides of the velocity.
      const int shift = high - 1;
      at[c] += shift;
      return 2.0 * at_cell(at) * staggered_derivative(g, widths, u + shift * g.stride[c], c, c, at[c]);
    }
    at[d] += high;
    const double* edge = u + high * g.stride[d];
    const double strain = staggered_derivative(g, widths, edge, c, d, at[d]) +
                          staggered_derivative(g, widths, edge, d, c, at[c]);
    if (strain == 0.0) return 0.0;
    double sum = 0.0;
    for (int neighbour = 0; neighbour < 4; ++neighbour) {
      int other[3] = {at[0], at[1], at[2]};
      other[c] -= neighbour % 2;
      other[d] -= neighbour / 2;
      sum += 0.25 * at_cell(other);
    }
    return sum * strain;
  }

  KOKKOS_FUNCTION double at_cell(const int cell[3]) const {
    int at[3];
    for (int axis = 0; axis < 3; ++axis) {
      const int n = grid.n[axis], i = cell[axis];
      at[axis] = !grid.periodic[axis] ? i : i < 0 ? i + n : i >= n ? i - n : i;
    }
    return viscosity(cells.nearest(at));
  }
};

}  // namespace drogue::flow
