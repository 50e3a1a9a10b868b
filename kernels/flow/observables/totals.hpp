#pragma once

#include "kernels/device/launch.hpp"
#include "kernels/flow/observables/gradient.hpp"
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

/// Combines contributions: adds the sums, keeps the larger maxima. A NaN stays.
KOKKOS_INLINE_FUNCTION void combine_totals(double into[total_count], const double from[total_count]) {
  for (int q = 0; q < total_sums; ++q) into[q] += from[q];
  for (int q = total_sums; q < total_count; ++q) into[q] = from[q] <= into[q] ? into[q] : from[q];
}

/// Contributions of the cells of a column along z, in order, per unit density and cell volume.
template <class ExecutionSpace>
struct ColumnTotalsFunctor {
  MacGrid grid;
  List<ExecutionSpace> velocity;
  TotalsView<ExecutionSpace> columns;

  KOKKOS_FUNCTION void operator()(const int column) const {
    const MacGrid& g = grid;
    double sum[total_count] = {};
    for (int k = 0; k < g.n[2]; ++k) {
      double own[total_count];
      of_cell(velocity.data() + g.offset(column % g.n[0], column / g.n[0], k), own);
      combine_totals(sum, own);
    }
    for (int q = 0; q < total_count; ++q)
      columns(static_cast<std::size_t>(column), static_cast<std::size_t>(q)) = sum[q];
  }

 private:
  KOKKOS_FUNCTION void of_cell(const double* u, double own[total_count]) const {
    const MacGrid& g = grid;
    double energy = 0.0, squared_speed = 0.0, squared_vorticity = 0.0, squared_strain = 0.0, divergence = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double low = u[c * g.component], high = u[c * g.component + edge_step(g, c)],
                   mean = 0.5 * (low + high);
      energy += 0.25 * (low * low + high * high);
      squared_speed += mean * mean;
      own[total_momentum_x + c] = mean;
      const double diagonal = staggered_derivative(g, u, c, c);
      divergence += diagonal;
      squared_strain += diagonal * diagonal;
      // Mean of the squares at the four edges parallel to axis c.
      const int a = (c + 1) % 3, b = (c + 2) % 3;
      for (int edge = 0; edge < 4; ++edge) {
        const double* at = u + (edge % 2) * edge_step(g, a) + (edge / 2) * edge_step(g, b);
        const double ba = staggered_derivative(g, at, b, a), ab = staggered_derivative(g, at, a, b);
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

/// Combines the columns of one x in order of y.
template <class ExecutionSpace>
struct PlaneTotalsFunctor {
  int nx, ny;
  TotalsView<ExecutionSpace> columns, planes;

  KOKKOS_FUNCTION void operator()(const int i) const {
    double sum[total_count] = {};
    for (int j = 0; j < ny; ++j) {
      double own[total_count];
      for (int q = 0; q < total_count; ++q)
        own[q] = columns(static_cast<std::size_t>(i + nx * j), static_cast<std::size_t>(q));
      combine_totals(sum, own);
    }
    for (int q = 0; q < total_count; ++q)
      planes(static_cast<std::size_t>(i), static_cast<std::size_t>(q)) = sum[q];
  }
};

/// Sum of the normal velocity over a row of faces of each bounded side, outwards, m/s.
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
            velocity(static_cast<std::size_t>(axis * g.component + g.offset(index[0], index[1], index[2])));
      }
    }
    rows(static_cast<std::size_t>(entry)) = side % 2 == 1 ? sum : -sum;
  }
};

}  // namespace drogue::flow
