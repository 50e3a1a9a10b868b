#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/flow/axis_lines.hpp"
#include "kernels/flow/observables/gradient.hpp"
#include "kernels/flow/parameters.hpp"
#include "kernels/flow/state.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Contributions to `Totals`: sums first, then maxima.
enum TotalIndex : int {
  total_energy,
  total_enstrophy,
  total_dissipation,
  total_momentum_x,
  total_momentum_y,
  total_momentum_z,
  total_squared_divergence,
  total_sums,
  total_squared_speed = total_sums,
  total_divergence,
  total_count,
};

template <class ExecutionSpace>
using TotalsView =
    Kokkos::View<double* [total_count], Kokkos::LayoutLeft, typename ExecutionSpace::memory_space>;

/// The larger of two values; a NaN stays. Does not throw.
KOKKOS_INLINE_FUNCTION double larger_or_nan(double a, double b) { return (b <= a || a != a) ? a : b; }

/// Combines contributions: adds the sums, keeps the larger maxima. A NaN stays.
KOKKOS_INLINE_FUNCTION void combine_totals(double into[total_count], const double from[total_count]) {
  for (int q = 0; q < total_sums; ++q) into[q] += from[q];
  for (int q = total_sums; q < total_count; ++q) into[q] = larger_or_nan(into[q], from[q]);
}

/// Adds the parts that a component with these values at the faces of a cell, m/s, has in the kinetic energy
/// per mass and the squared speed at the centre, m^2/s^2.
KOKKOS_INLINE_FUNCTION void add_energy(double low, double high, double& energy, double& squared_speed) {
  const double mean = 0.5 * (low + high);
  energy += 0.25 * (low * low + high * high);
  squared_speed += mean * mean;
}

/// Number of cells, and of partial sums, that one thread combines.
inline constexpr int sum_radix = 16;

/// Contributions of up to `sum_radix` cells of a column along z, in order, per unit density and volume of a
/// cell with the widths `MacGrid::h`.
template <class ExecutionSpace>
struct ColumnTotalsFunctor {
  MacGrid grid;
  List<ExecutionSpace> velocity;
  TotalsView<ExecutionSpace> columns;

  KOKKOS_FUNCTION void operator()(const int column) const {
    if (grid.is_stretched())
      add_column(grid, column);
    else
      add_column(UniformWidths{grid}, column);
  }

 private:
  template <class Widths>
  KOKKOS_FUNCTION void add_column(const Widths& widths, const int column) const {
    const MacGrid& g = grid;
    const int row = column / g.n[0], begin = row / g.n[1] * sum_radix,
              end = begin + sum_radix < g.n[2] ? begin + sum_radix : g.n[2];
    double sum[total_count] = {};
    for (int k = begin; k < end; ++k) {
      double own[total_count];
      const int cell[3] = {column % g.n[0], row % g.n[1], k};
      of_cell(widths, velocity.data() + g.offset(cell[0], cell[1], cell[2]), cell, own);
      const double volume = widths.relative_volume(cell[0], cell[1], cell[2]);
      for (int q = 0; q < total_sums; ++q) own[q] *= volume;
      combine_totals(sum, own);
    }
    for (int q = 0; q < total_count; ++q)
      columns(static_cast<std::size_t>(column), static_cast<std::size_t>(q)) = sum[q];
  }

  template <class Widths>
  KOKKOS_FUNCTION void of_cell(const Widths& widths, const double* u, const int (&cell)[3],
                               double own[total_count]) const {
    const MacGrid& g = grid;
    double energy = 0.0, squared_speed = 0.0, squared_vorticity = 0.0, squared_strain = 0.0, divergence = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double low = u[c * g.component], high = u[c * g.component + edge_step(g, c)],
                   mean = 0.5 * (low + high);
      add_energy(low, high, energy, squared_speed);
      own[total_momentum_x + c] = mean;
      const double diagonal = staggered_derivative(g, widths, u, c, c, cell[c]);
      divergence += diagonal;
      squared_strain += diagonal * diagonal;
      // Mean of the squares at the four edges parallel to axis c.
      const int a = (c + 1) % 3, b = (c + 2) % 3;
      for (int edge = 0; edge < 4; ++edge) {
        const double* at = u + (edge % 2) * edge_step(g, a) + (edge / 2) * edge_step(g, b);
        const double ba = staggered_derivative(g, widths, at, b, a, cell[a] + edge % 2),
                     ab = staggered_derivative(g, widths, at, a, b, cell[b] + edge / 2);
        squared_vorticity += 0.25 * (ba - ab) * (ba - ab);
        squared_strain += 0.125 * (ba + ab) * (ba + ab);
      }
    }
    own[total_energy] = energy;
    own[total_enstrophy] = 0.5 * squared_vorticity;
    own[total_dissipation] = 2.0 * squared_strain;
    own[total_squared_divergence] = divergence * divergence;
    own[total_squared_speed] = squared_speed;
    own[total_divergence] = Kokkos::fabs(divergence);
  }
};

/// Index j combines rows j, j + n_out, ... of the previous level.
template <class ExecutionSpace>
struct CombineTotalsFunctor {
  TotalsView<ExecutionSpace> in, out;

  KOKKOS_FUNCTION void operator()(const int j) const {
    const int rows = in.extent_int(0), step = out.extent_int(0);
    double sum[total_count] = {};
    for (int row = j; row < rows; row += step) {
      double own[total_count];
      for (int q = 0; q < total_count; ++q) own[q] = in(row, q);
      combine_totals(sum, own);
    }
    for (int q = 0; q < total_count; ++q) out(j, q) = sum[q];
  }
};

/// Sum of the normal velocity over a row of faces of each bounded side, outwards, by their areas over that of
/// a face of widths `MacGrid::h`, m/s.
template <class ExecutionSpace>
struct OutflowRowsFunctor {
  MacGrid grid;
  List<ExecutionSpace> velocity;
  List<ExecutionSpace> rows;  ///< side after side, `longest` entries each
  int longest;

  KOKKOS_FUNCTION void operator()(const int entry) const {
    const MacGrid& g = grid;
    const int side = entry / longest, row = entry % longest, axis = side / 2;
    const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    double sum = 0.0;
    if (!g.periodic[axis] && g.n[axis] > 1 && row < g.n[b]) {
      int index[3];
      index[axis] = side % 2 == 1 ? g.n[axis] : 0;
      index[b] = row;
      for (int i = 0; i < g.n[a]; ++i) {
        index[a] = i;
        sum +=
            g.relative_width(a, i) * g.relative_width(b, row) *
            velocity(static_cast<std::size_t>(axis * g.component + g.offset(index[0], index[1], index[2])));
      }
    }
    rows(static_cast<std::size_t>(entry)) = side % 2 == 1 ? sum : -sum;
  }
};

/// Sums over the cells of a rank.
struct PartTotals {
  double sum[total_count] = {};  ///< contributions of the cells
  double outflow[6] = {};        ///< of each side, as `OutflowRowsFunctor`
};

/// Sums over a velocity field in an order that does not depend on the backend, with their scratch memory.
template <class ExecutionSpace>
class TotalsSum {
 public:
  /// `scratch` holds the sums of the columns if it is large enough; `enqueue` then overwrites it. Throws
  /// std::bad_alloc.
  TotalsSum(const MacGrid& grid, const List<ExecutionSpace>& scratch) : _grid(grid) {
    const auto quotient = [](std::size_t rows) { return (rows + sum_radix - 1) / sum_radix; };
    std::size_t rows = static_cast<std::size_t>(grid.n[0]) * static_cast<std::size_t>(grid.n[1]) *
                       quotient(static_cast<std::size_t>(grid.n[2]));
    if (scratch.size() >= total_count * rows)
      _levels.emplace_back(scratch.data(), rows);
    else
      _levels.emplace_back("drogue::flow::column_totals", rows);
    while (rows > 1) _levels.emplace_back("drogue::flow::partial_totals", rows = quotient(rows));
    _outflow_rows =
        List<ExecutionSpace>("drogue::flow::outflow_rows", 6 * static_cast<std::size_t>(longest_row()));
    _sum_on_host = Kokkos::create_mirror_view(_levels.back());
    _outflow_rows_on_host = Kokkos::create_mirror_view(_outflow_rows);
  }

  /// Enqueues the sums of a velocity, m/s, with ghost cells, and their copy to the host. Asynchronous. Throws
  /// only after a failed launch.
  void enqueue(const ExecutionSpace& space, const List<ExecutionSpace>& velocity) {
    device::launch_each(space, "drogue::flow::column_totals", _levels.front().extent_int(0),
                        ColumnTotalsFunctor<ExecutionSpace>{_grid, velocity, _levels.front()});
    for (std::size_t level = 1; level < _levels.size(); ++level)
      device::launch_each(space, "drogue::flow::combine_totals", _levels[level].extent_int(0),
                          CombineTotalsFunctor<ExecutionSpace>{_levels[level - 1], _levels[level]});
    device::launch_each(space, "drogue::flow::outflow_rows", 6 * longest_row(),
                        OutflowRowsFunctor<ExecutionSpace>{_grid, velocity, _outflow_rows, longest_row()});
    device::copy_out(space, _sum_on_host.data(), _levels.back(), _levels.back().size());
    device::copy_out(space, _outflow_rows_on_host.data(), _outflow_rows, _outflow_rows.size());
  }

  /// Sums of the last `enqueue`, whose work must be complete; no outflow towards other ranks. Does not throw.
  [[nodiscard]] PartTotals result(const BoundaryKind (&sides)[6]) const {
    PartTotals part;
    for (std::size_t q = 0; q < total_count; ++q) part.sum[q] = _sum_on_host(0, q);
    for (int side = 0; side < 6; ++side) {
      if (sides[side] == BoundaryKind::neighbour) continue;
      for (int row = 0; row < longest_row(); ++row)
        part.outflow[side] += _outflow_rows_on_host(static_cast<std::size_t>(side * longest_row() + row));
    }
    return part;
  }

 private:
  [[nodiscard]] int longest_row() const { return std::max(_grid.n[1], _grid.n[2]); }

  MacGrid _grid;
  std::vector<TotalsView<ExecutionSpace>> _levels;  ///< of the sum; the last one has one row
  List<ExecutionSpace> _outflow_rows;
  typename TotalsView<ExecutionSpace>::host_mirror_type _sum_on_host;
  typename List<ExecutionSpace>::host_mirror_type _outflow_rows_on_host;
};

/// Totals, SI units, from the sums of all ranks; step, time and dt are left out. Does not throw.
inline Totals make_totals(const PartTotals& whole, const Parameters& parameters, const MacGrid& grid) {
  const double volume = grid.h[0] * grid.h[1] * grid.h[2], mass = parameters.density * volume;
  // In cells of the widths h, as the sums.
  double cells = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    cells *=
        is_stretched(parameters, axis) ? (grid.high[axis] - grid.low[axis]) / grid.h[axis] : grid.whole[axis];
  Totals totals;
  totals.kinetic_energy = mass * whole.sum[total_energy];
  totals.enstrophy = volume * whole.sum[total_enstrophy];
  totals.dissipation = parameters.viscosity * volume * whole.sum[total_dissipation];
  for (int c = 0; c < 3; ++c) totals.momentum[c] = mass * whole.sum[total_momentum_x + c];
  totals.max_speed = std::sqrt(whole.sum[total_squared_speed]);
  totals.divergence_rms = std::sqrt(whole.sum[total_squared_divergence] / cells);
  totals.divergence_max = whole.sum[total_divergence];
  for (int side = 0; side < 6; ++side) totals.outflow[side] = whole.outflow[side] * volume / grid.h[side / 2];
  return totals;
}

}  // namespace drogue::flow
