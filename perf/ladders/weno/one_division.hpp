#pragma once

#include "perf/ladders/weno/differences.hpp"

namespace drogue::perf::ladder {

/// As `JiangShuCorrection`, but with the weights over their common denominator: one division.
struct OneDivisionCorrection {
  template <class R>
  KOKKOS_FUNCTION static R of(const R (&d)[4]) {
    const R second[3] = {d[1] - d[0], d[2] - d[1], d[3] - d[2]};
    const R first[3] = {3.0 * d[1] - d[0], d[1] + d[2], d[3] - 3.0 * d[2]};
    R square[3];
    for (int k = 0; k < 3; ++k) {
      const R beta = 13.0 / 12.0 * (second[k] * second[k]) + 0.25 * (first[k] * first[k]) + 1e-6;
      square[k] = beta * beta;
    }
    const R w0 = 0.1 * (square[1] * square[2]), w1 = 0.6 * (square[0] * square[2]),
            w2 = 0.3 * (square[0] * square[1]), inverse = R(1.0) / (w0 + w1 + w2);
    return w0 * inverse * ((1.0 / 3.0) * (second[1] - second[0])) +
           (w2 * inverse - 0.5) * ((1.0 / 6.0) * (second[2] - second[1]));
  }
};

/// Flux by the point functions of the library: weights over a common denominator, one division per side and
/// field; roots and reciprocals from the approximations of the hardware on a GPU.
struct OneDivisionFlux {
  /// Operations per face, counted by tests/kernels/ladders/.
  static constexpr Arithmetic arithmetic{254, 247, 7, 1, 0};

  template <class R>
  KOKKOS_FUNCTION static CellState<R> cell(double gamma, const ConservedVector<R>& u) {
    return gas::cell_state<R>(gamma, u.rho, u.m, u.energy);
  }

  template <class R>
  KOKKOS_FUNCTION static ConservedVector<R> face(double gamma, const CellState<R> (&cells)[6]) {
    const gas::Eigensystem<R> e = gas::eigensystem<R, R>(gamma, 0.5 * (cells[2].u + cells[3].u),
                                                         0.5 * (cells[2].enthalpy + cells[3].enthalpy));
    return gas::weno5_face<gas::Reconstruction::js, R>(difference_stencil(cells), e, largest_speeds(cells));
  }
};

/// Rung 5. Weights are ratios: multiplied by their common denominator they need one division instead of five
/// per side and field.
///
/// Prediction: 7 divisions of 32 per face are left.
template <class ExecutionSpace>
Rung one_division_rung(const Shared<WenoProblem>& problem) {
  return make_rung<StageRung<ExecutionSpace, OneDivisionFlux>>(
      RungText{"one-division", "Weights over a common denominator: one division of five.",
               "On a host 1.20 to 1.21 times as fast, 1.56 to 1.62 predicted: the processor overlaps a "
               "division with other work, so that one that goes saves less than its own time. On an H100 "
               "2.13 times as fast, 1.02 predicted, since the model has launches as the bound there: "
               "14.2 us, after 30.2 us. A thread waits for its divisions one after the other "
               "(docs/lessons/tables.md)."},
      stage_work(*problem, 1, 9, OneDivisionFlux::arithmetic), problem, "drogue::perf::ladder::one_division");
}

}  // namespace drogue::perf::ladder
