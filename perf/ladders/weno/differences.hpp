#pragma once

#include "kernels/gas/flux/characteristic.hpp"
#include "perf/ladders/weno/direct_flux.hpp"
#include "perf/ladders/weno/stage_kernel.hpp"

namespace drogue::perf::ladder {

/// Differences of neighbours among six cells, their fluxes, and the sum of the fluxes beside the face.
template <class R>
KOKKOS_FUNCTION gas::Stencil<R> difference_stencil(const CellState<R> (&cells)[6]) {
  gas::Stencil<R> s;
  const auto flux_m = [](const CellState<R>& w) { return w.m * w.u + w.p; };
  const auto flux_energy = [](const CellState<R>& w) { return w.u * (w.energy + w.p); };
  for (int k = 0; k < 5; ++k) {
    const CellState<R>&a = cells[k], &b = cells[k + 1];
    s.d_state[k] = {b.rho - a.rho, b.m - a.m, b.energy - a.energy};
    s.d_flux_m[k] = flux_m(b) - flux_m(a);
    s.d_flux_energy[k] = flux_energy(b) - flux_energy(a);
  }
  const CellState<R>&left = cells[2], &right = cells[3];
  s.flux_sum = {left.m + right.m, flux_m(left) + flux_m(right), flux_energy(left) + flux_energy(right)};
  return s;
}

/// Largest wave speeds of six cells.
template <class R>
KOKKOS_FUNCTION gas::WaveSpeeds<R> largest_speeds(const CellState<R> (&cells)[6]) {
  gas::WaveSpeeds<R> largest = gas::wave_speeds(cells[0].u, cells[0].c);
  for (int k = 1; k < 6; ++k) {
    const gas::WaveSpeeds<R> s = gas::wave_speeds(cells[k].u, cells[k].c);
    largest = {device::maximum(largest.slow, s.slow), device::maximum(largest.entropy, s.entropy),
               device::maximum(largest.fast, s.fast)};
  }
  return largest;
}

/// Nonlinear part of the flux of a characteristic field from one side.
struct JiangShuCorrection {
  /// w_0/3 (a - 2b + c) + (w_2 - 1/2)/6 (b - 2c + d) with the weights of Jiang and Shu.
  template <class R>
  KOKKOS_FUNCTION static R of(const R (&d)[4]) {
    const R second[3] = {d[1] - d[0], d[2] - d[1], d[3] - d[2]};
    const R first[3] = {3.0 * d[1] - d[0], d[1] + d[2], d[3] - 3.0 * d[2]};
    constexpr double linear[3] = {0.1, 0.6, 0.3};
    R weight[3];
    for (int k = 0; k < 3; ++k) {
      const R beta = 13.0 / 12.0 * (second[k] * second[k]) + 0.25 * (first[k] * first[k]) + 1e-6;
      weight[k] = R(linear[k]) / (beta * beta);
    }
    const R sum = weight[0] + weight[1] + weight[2];
    return weight[0] / sum * ((1.0 / 3.0) * (second[1] - second[0])) +
           (weight[2] / sum - 0.5) * ((1.0 / 6.0) * (second[2] - second[1]));
  }
};

/// Flux in difference form: a linear flux of fourth order, less nonlinear corrections of the differences of
/// neighbours. Constants cancel, so that 5 differences replace 6 values, and eigenvectors need no full
/// matrix.
template <class Correction>
struct DifferenceFluxWith : DirectFlux {
  /// Operations per face, counted by tests/kernels/ladders/.
  static constexpr Arithmetic arithmetic{266, 260, 32, 1, 0};

  template <class R>
  KOKKOS_FUNCTION static ConservedVector<R> face(double gamma, const CellState<R> (&cells)[6]) {
    const gas::Stencil<R> s = difference_stencil(cells);
    const R u = 0.5 * (cells[2].u + cells[3].u), h = 0.5 * (cells[2].enthalpy + cells[3].enthalpy);
    const R kinetic = 0.5 * u * u, unit = h - kinetic, c = device::square_root((gamma - 1.0) * unit);
    const gas::Eigensystem<R> e{.u = u,
                                .c = c,
                                .enthalpy = h,
                                .kinetic = kinetic,
                                .unit = unit,
                                .inverse_unit = R(1.0) / unit,
                                .width = unit / c};
    const gas::WaveSpeeds<R> alpha = largest_speeds(cells);
    R right[3][4], left[3][4];
    for (int k = 0; k < 5; ++k) {
      const auto du = gas::project(e, s.d_state[k].rho, s.d_state[k].m, s.d_state[k].energy);
      const auto df = gas::project(e, s.d_state[k].m, s.d_flux_m[k], s.d_flux_energy[k]);
      // `project` scales its acoustic fields by 2 `unit`.
      const R scale = 0.5 * e.inverse_unit;
      const R state[3] = {scale * du.slow, du.entropy, scale * du.fast};
      const R flux[3] = {scale * df.slow, df.entropy, scale * df.fast};
      const R speed[3] = {alpha.slow, alpha.entropy, alpha.fast};
      for (int field = 0; field < 3; ++field) {
        if (k < 4) right[field][k] = 0.5 * (flux[field] + speed[field] * state[field]);
        if (k > 0) left[field][4 - k] = 0.5 * (flux[field] - speed[field] * state[field]);
      }
    }
    R k[3];
    for (int field = 0; field < 3; ++field)
      k[field] = Correction::of(right[field]) - Correction::of(left[field]);
    const ConservedVector<R> central = s.central();
    return {central.rho - (k[0] + k[1] + k[2]), central.m - (u * (k[0] + k[1] + k[2]) + c * (k[2] - k[0])),
            central.energy - (h * (k[0] + k[2]) + kinetic * k[1] + u * c * (k[2] - k[0]))};
  }
};

using DifferenceFlux = DifferenceFluxWith<JiangShuCorrection>;

/// Rung 4. The same flux from differences of neighbours (docs/gas.md, section 2).
///
/// Prediction: 26 % fewer operations per face, three divisions more.
template <class ExecutionSpace, class Flux = DifferenceFlux>
Rung differences_rung(const Shared<WenoProblem>& problem) {
  return make_rung<StageRung<ExecutionSpace, Flux>>(
      RungText{"differences", "The flux from differences of neighbours: fewer operations.",
               "On a host 1.14 times as fast, 1.12 to 1.14 predicted: counting operations predicts the "
               "ratio of two similar kernels better than the time of either."},
      stage_work(*problem, 1, 9, Flux::arithmetic), problem, "drogue::perf::ladder::differences");
}

}  // namespace drogue::perf::ladder
