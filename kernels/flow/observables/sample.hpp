#pragma once

#include "kernels/flow/launch.hpp"
#include "kernels/flow/observables/gradient.hpp"
#include "kernels/flow/views.hpp"

namespace drogue::flow {

/// Number of components of a field at the cell centres. Does not throw.
[[nodiscard]] KOKKOS_INLINE_FUNCTION constexpr int components(CellField field) {
  return field == CellField::velocity || field == CellField::vorticity ? 3 : 1;
}

/// Evaluates a field at the cell centres, in the order of an array (nx, ny, nz, components), last index
/// fastest.
template <class ExecutionSpace>
struct SampleFunctor {
  MacGrid grid;
  List<ExecutionSpace> velocity;  ///< m/s, with ghost cells
  List<ExecutionSpace> pressure;  ///< kinematic, m^2/s^2
  List<ExecutionSpace> samples;
  double density;  ///< kg/m^3
  CellField field;

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int k) const {
    const MacGrid& g = grid;
    const double* u = velocity.data() + g.offset(i, j, k);
    const std::int64_t cell = (static_cast<std::int64_t>(i) * g.n[1] + j) * g.n[2] + k;
    double* out = samples.data() + cell * components(field);
    switch (field) {
      case CellField::velocity:
        for (int c = 0; c < 3; ++c) {
          const double* q = u + c * g.component;
          out[c] = 0.5 * (q[0] + q[edge_step(g, c)]);
        }
        break;
      case CellField::vorticity: {
        double d[3][3];
        centred_gradient(g, u, {i, j, k}, d);
        for (int c = 0; c < 3; ++c) out[c] = d[(c + 2) % 3][(c + 1) % 3] - d[(c + 1) % 3][(c + 2) % 3];
        break;
      }
      case CellField::pressure:
        out[0] = density *
                 pressure(static_cast<std::size_t>(i + g.n[0] * (j + static_cast<std::int64_t>(g.n[1]) * k)));
        break;
      case CellField::q_criterion: {
        double d[3][3], sum = 0.0;
        centred_gradient(g, u, {i, j, k}, d);
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) sum -= 0.5 * d[a][b] * d[b][a];
        out[0] = sum;
        break;
      }
    }
  }
};

/// Copies a component between an array with ghost cells and a contiguous one, x fastest.
template <class ExecutionSpace>
struct PackFunctor {
  MacGrid grid;
  List<ExecutionSpace> field, contiguous;
  std::int64_t first;  ///< of the component
  int extent[3];
  bool to_field;
  int bounded_axis;  ///< axis whose low faces have their values in the ghost cells below them; -1: none

  KOKKOS_FUNCTION void operator()(const int i, const int j, const int k) const {
    int index[3] = {i, j, k};
    if (bounded_axis >= 0 && index[bounded_axis] == 0) index[bounded_axis] = -1;
    const auto place = static_cast<std::size_t>(first + grid.offset(index[0], index[1], index[2]));
    const auto at = static_cast<std::size_t>(i + extent[0] * (j + static_cast<std::int64_t>(extent[1]) * k));
    if (to_field)
      field(place) = contiguous(at);
    else
      contiguous(at) = field(place);
  }
};

}  // namespace drogue::flow
