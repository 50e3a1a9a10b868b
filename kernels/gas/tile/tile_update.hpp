#pragma once

#include "kernels/gas/stepping/control.hpp"
#include "kernels/gas/tile/tile.hpp"

namespace drogue::gas {

// Functions that `StageFunctor` (one stage per launch) and `StepFunctor` (all stages per launch) share.

/// Copy of the control-block values that a kernel reads. As a copy, their loads overlap and are not repeated
/// after stores.
struct StepInput {
  Stop stop;
  bool limited;
  int current;  ///< index of the buffer that holds U^n
  double dt;    ///< s
};

KOKKOS_INLINE_FUNCTION StepInput read_step_input(const Control& c) {
  return {c.trial.stop, c.restart.limited != 0, c.restart.current, c.trial.dt};
}

/// Writes the values that faces depend on into slot `i`.
template <class Tile, class R>
KOKKOS_INLINE_FUNCTION void store_cell(const Tile& tile, int i, const CellState<R>& s) {
  const WaveSpeeds<R> speed = wave_speeds(s.u, s.c);
  tile.store(TileField::rho, i, s.rho);
  tile.store(TileField::m, i, s.m);
  tile.store(TileField::energy, i, s.energy);
  tile.store(TileField::flux_m, i, s.m * s.u + s.p);
  tile.store(TileField::flux_energy, i, (s.energy + s.p) * s.u);
  tile.store(TileField::u, i, s.u);
  tile.store(TileField::enthalpy, i, s.enthalpy);
  tile.store(TileField::slow, i, speed.slow);
  tile.store(TileField::fast, i, speed.fast);
}

/// Fills all slots with the states from `load(cell)`. Also stores them as U^n if `keep`.
template <class R, bool keep, class Member, class Tile, class Load>
KOKKOS_INLINE_FUNCTION void load_cells(const Member& member, const Tile& tile, double gamma,
                                       const Load& load) {
  constexpr int lanes = device::Access<R>::lanes;
  for (int i = member.team_rank() * lanes; i < tile.slots + lanes - 1; i += member.team_size() * lanes) {
    const ConservedVector<R> u = load(tile.cell(i));
    if constexpr (keep) tile.store_start(i, u);
    store_cell(tile, i, cell_state<R>(gamma, u.rho, u.m, u.energy));
  }
}

/// Sum of the fluxes of the two cells beside a face.
template <class R, class Tile>
KOKKOS_INLINE_FUNCTION ConservedVector<R> flux_sum(const Tile& tile, int face) {
  const auto sum = [&](TileField field) {
    return tile.template load<R>(field, face + 2) + tile.template load<R>(field, face + 3);
  };
  return {sum(TileField::m), sum(TileField::flux_m), sum(TileField::flux_energy)};
}

template <class R, class Tile>
KOKKOS_INLINE_FUNCTION Stencil<R> load_stencil(const Tile& tile, int face) {
  Stencil<R> s;
  const auto difference = [&](TileField field, int k) {
    return tile.template load<R>(field, face + k + 1) - tile.template load<R>(field, face + k);
  };
  for (int k = 0; k < 5; ++k) {
    s.d_state[k] = {difference(TileField::rho, k), difference(TileField::m, k),
                    difference(TileField::energy, k)};
    s.d_flux_m[k] = difference(TileField::flux_m, k);
    s.d_flux_energy[k] = difference(TileField::flux_energy, k);
  }
  s.flux_sum = flux_sum<R>(tile, face);
  return s;
}

/// Maximum wave speed of each field over the six cells of the stencil, m/s.
template <class N, class R, class Tile>
KOKKOS_INLINE_FUNCTION WaveSpeeds<N> stencil_wave_speeds(const Tile& tile, int face) {
  using To = device::Convert<N>;
  R slow = tile.template load<R>(TileField::slow, face), fast = tile.template load<R>(TileField::fast, face);
  R entropy = device::absolute(tile.template load<R>(TileField::u, face));
  for (int k = 1; k < 6; ++k) {
    slow = device::maximum(slow, tile.template load<R>(TileField::slow, face + k));
    fast = device::maximum(fast, tile.template load<R>(TileField::fast, face + k));
    entropy = device::maximum(entropy, device::absolute(tile.template load<R>(TileField::u, face + k)));
  }
  return {To::from(slow), To::from(entropy), To::from(fast)};
}

template <Reconstruction scheme, class N, class R, class Tile>
KOKKOS_INLINE_FUNCTION ConservedVector<R> face_flux(const Tile& tile, int face, const Stencil<R>& s,
                                                    FaceAverage average, double gamma,
                                                    const WaveSpeeds<N>& alpha) {
  const Eigensystem<N> e = face_eigensystem<N, R>(average, gamma, tile.template face_cell<R>(face + 2),
                                                  tile.template face_cell<R>(face + 3));
  return weno5_face<scheme, N>(s, e, alpha);
}

/// Euler step U + dt L(U) of the state `in` of slot `i`.
template <class P, class Tile>
KOKKOS_INLINE_FUNCTION ConservedVector<P> euler_step(const Tile& tile, const ConservedVector<P>& in, int i,
                                                     double dt_over_dx) {
  const ConservedVector<P> left = tile.template flux<P>(i - ghost_cells),
                           right = tile.template flux<P>(i - ghost_cells + 1);
  return {in.rho + dt_over_dx * (left.rho - right.rho), in.m + dt_over_dx * (left.m - right.m),
          in.energy + dt_over_dx * (left.energy - right.energy)};
}

/// Runge-Kutta combination U^n + share (u - U^n).
template <class P>
KOKKOS_INLINE_FUNCTION ConservedVector<P> runge_kutta_combination(const ConservedVector<P>& u_n, double share,
                                                                  const ConservedVector<P>& u) {
  return {u_n.rho + share * (u.rho - u_n.rho), u_n.m + share * (u.m - u_n.m),
          u_n.energy + share * (u.energy - u_n.energy)};
}

/// Stores the state of slot `i`, whose cell belongs to the tile.
template <class P, class Tile>
KOKKOS_INLINE_FUNCTION void store_state(const Tile& tile, int i, const ConservedVector<P>& u,
                                        std::int64_t cells, double* out) {
  using Lanes = device::Access<P>;
  const std::int64_t cell = tile.cell(i);
  Lanes::store(out + cell, u.rho);
  Lanes::store(out + cells + cell, u.m);
  Lanes::store(out + 2 * cells + cell, u.energy);
}

/// Maximum wave speeds and admissibility of the cells that one thread updated.
template <class P>
struct CellReduction {
  P slow{0.0}, entropy{0.0}, fast{0.0}, admissible{1.0};

  KOKKOS_FUNCTION void check_admissible(P rho, P p) {
    const P zero(0.0);
    // Every comparison is false for a NaN.
    admissible = device::select(p > zero, admissible, zero);
    admissible = device::select(p <= P(1.7e308), admissible, zero);
    admissible = device::select(rho > zero, admissible, zero);
    admissible = device::select(rho <= P(1.7e308), admissible, zero);
  }
  KOKKOS_FUNCTION void include_wave_speeds(const WaveSpeeds<P>& speed) {
    slow = device::maximum(slow, speed.slow);
    entropy = device::maximum(entropy, speed.entropy);
    fast = device::maximum(fast, speed.fast);
  }
};

/// Merges the lanes of `packs` into `all`.
template <class R>
KOKKOS_INLINE_FUNCTION void merge_lanes(const CellReduction<R>& packs, CellReduction<double>& all) {
  using Lanes = device::Access<R>;
  for (int lane = 0; lane < Lanes::lanes; ++lane) {
    all.include_wave_speeds(
        {Lanes::lane(packs.slow, lane), Lanes::lane(packs.entropy, lane), Lanes::lane(packs.fast, lane)});
    all.admissible = device::minimum(all.admissible, Lanes::lane(packs.admissible, lane));
  }
}

/// Slow path: records an inadmissible state by the criteria of `CellReduction`.
KOKKOS_INLINE_FUNCTION void report_inadmissible(StageReduction& reduction, double gamma, int stage,
                                                std::int64_t cell, const ConservedVector<double>& u) {
  const double p = pressure(gamma, u.m, u.energy, u.m * device::reciprocal(u.rho));
  if (u.rho > 0.0 && u.rho <= 1.7e308 && p > 0.0 && p <= 1.7e308) return;
  FailureReason what = FailureReason::not_finite;
  if (u.rho <= 0.0)
    what = FailureReason::density;
  else if (p <= 0.0)
    what = FailureReason::pressure;
  Kokkos::atomic_min(&reduction.first_inadmissible, encode_inadmissible(stage, cell, what));
}

/// Stores the fluxes through the ends of the mesh for the conservation check; one thread of the outermost
/// tile does it. `left` and `right` are the outermost faces of the tile.
template <class Member, class Tile>
KOKKOS_INLINE_FUNCTION void store_boundary_fluxes(const Member& member, const Tile& tile,
                                                  StageReduction& reduction, int stage, int left, int right) {
  if (member.team_rank() != member.team_size() - 1) return;
  for (int side = 0; side < 2; ++side) {
    if (side == 0 ? tile.first != 0 : !tile.last) continue;
    const ConservedVector<double> f = tile.template flux<double>(side == 0 ? left : right);
    double(&out)[3] = reduction.boundary_flux[stage][side];
    out[0] = f.rho, out[1] = f.m, out[2] = f.energy;
  }
}

}  // namespace drogue::gas
