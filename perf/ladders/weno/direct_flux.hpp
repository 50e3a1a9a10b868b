#pragma once

#include "perf/ladders/weno/tile.hpp"
#include "perf/models/gas_step.hpp"

namespace drogue::perf::ladder {

/// Flux of a face as the literature writes it: split fluxes of six cells in characteristic fields, three
/// candidate values per side with their weights, a division for each (Jiang and Shu 1996, section 2).
struct DirectFlux {
  /// Operations per face, counted by tests/kernels/ladders/.
  static constexpr Arithmetic arithmetic{331, 381, 29, 1, 0};

  template <class R>
  KOKKOS_FUNCTION static CellState<R> cell(double gamma, const ConservedVector<R>& w) {
    const R u = w.m / w.rho, p = gas::pressure(gamma, w.m, w.energy, u);
    return {.rho = w.rho,
            .m = w.m,
            .energy = w.energy,
            .u = u,
            .p = p,
            .enthalpy = (w.energy + p) / w.rho,
            .c = device::square_root(gamma * p / w.rho)};
  }

  /// Value at the face from five values, the face right of the third.
  template <class R>
  KOKKOS_FUNCTION static R reconstructed(const R* f, int step) {
    const R a = f[0], b = f[step], c = f[2 * step], d = f[3 * step], e = f[4 * step];
    const R second[3] = {a - 2.0 * b + c, b - 2.0 * c + d, c - 2.0 * d + e};
    const R first[3] = {a - 4.0 * b + 3.0 * c, b - d, 3.0 * c - 4.0 * d + e};
    const R value[3] = {2.0 * a - 7.0 * b + 11.0 * c, 5.0 * c - b + 2.0 * d, 2.0 * c + 5.0 * d - e};
    constexpr double linear[3] = {0.1, 0.6, 0.3};
    R sum(0.0), weights(0.0);
    for (int k = 0; k < 3; ++k) {
      const R beta = 13.0 / 12.0 * (second[k] * second[k]) + 0.25 * (first[k] * first[k]) + 1e-6;
      const R weight = R(linear[k]) / (beta * beta);
      sum = sum + weight * value[k], weights = weights + weight;
    }
    return sum / (6.0 * weights);
  }

  template <class R>
  KOKKOS_FUNCTION static ConservedVector<R> face(double gamma, const CellState<R> (&cells)[6]) {
    const R u = 0.5 * (cells[2].u + cells[3].u), h = 0.5 * (cells[2].enthalpy + cells[3].enthalpy);
    const R c = device::square_root((gamma - 1.0) * (h - 0.5 * u * u));
    const R b2 = R(gamma - 1.0) / (c * c), b1 = 0.5 * b2 * u * u;
    ConservedVector<R> flux{R(0.0), R(0.0), R(0.0)};
    for (int field = -1; field <= 1; ++field) {
      const double s = field;
      // Rows of the left and columns of the right eigenvectors of dF/dU.
      const bool acoustic = field != 0;
      const R l0 = acoustic ? 0.5 * (b1 - s * u / c) : R(1.0) - b1;
      const R l1 = acoustic ? 0.5 * (s / c - b2 * u) : b2 * u;
      const R l2 = acoustic ? 0.5 * b2 : -b2;
      R alpha(0.0), right[6], left[6];
      for (const CellState<R>& cell : cells)
        alpha = device::maximum(alpha, device::absolute(cell.u + s * cell.c));
      for (int k = 0; k < 6; ++k) {
        const CellState<R>& w = cells[k];
        const R state = l0 * w.rho + l1 * w.m + l2 * w.energy;
        const R physical = l0 * w.m + l1 * (w.m * w.u + w.p) + l2 * (w.u * (w.energy + w.p));
        right[k] = 0.5 * (physical + alpha * state), left[k] = 0.5 * (physical - alpha * state);
      }
      const R value = reconstructed(right, 1) + reconstructed(left + 5, -1);
      flux.rho = flux.rho + value;
      flux.m = flux.m + (u + s * c) * value;
      flux.energy = flux.energy + (acoustic ? h + s * u * c : 0.5 * u * u) * value;
    }
    return flux;
  }
};

/// Fluxes of all faces of the mesh from the state of the cells ([Shi], listing 4.3): a team per tile, a
/// thread per face, cells in scratch memory.
template <class ExecutionSpace>
struct FluxFunctor {
  Fields<ExecutionSpace> state;  ///< (cells, 3)
  Fields<ExecutionSpace> flux;   ///< (cells + 1, 3)
  double gamma;

  template <class Member>
  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const CellTile tile(member);
    load_tile<DirectFlux, double>(member, tile, state.data(), static_cast<std::int64_t>(state.extent(0)),
                                  gamma);
    for_tile_faces<DirectFlux, double>(member, tile, gamma, [&](int face, const ConservedVector<double>& f) {
      const std::int64_t i = tile.first + face;
      flux(i, 0) = f.rho, flux(i, 1) = f.m, flux(i, 2) = f.energy;
    });
  }
};

}  // namespace drogue::perf::ladder
