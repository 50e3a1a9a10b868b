#pragma once

#include <type_traits>

#include "kernels/device/memory.hpp"
#include "kernels/gas/control.hpp"
#include "kernels/gas/limiter.hpp"
#include "kernels/gas/tile.hpp"

namespace drogue::gas {

/// One fused Runge-Kutta stage: loads a tile of cells with its halo, computes the fluxes of its faces once,
/// updates its cells, and reduces what the next decision needs (fastest signals, inadmissible cells).
///
/// A league member is a tile; scratch holds nine values a cell and three a face. On the host a member is one
/// thread that works on packs of cells, on a device a team with one face a thread: the same text.
template <class ExecutionSpace, Reconstruction scheme, Precision precision, bool limited>
struct StageFunctor {
  static constexpr bool on_host = device::is_host<ExecutionSpace>;
  using Member = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;
  using R = std::conditional_t<on_host, device::HostPack<double>, double>;
  using Single = std::conditional_t<on_host, device::HostPack<float>, float>;
  using N = std::conditional_t<precision == Precision::split, Single, R>;
  using Fields = FieldsView<ExecutionSpace>;

  Fields buffer[3];
  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space>
      touched;  ///< cells beside a limited face
  StageWeights weights;
  TileShape shape;
  Ends ends;
  double gamma, inverse_dx;
  int stage;
  Splitting splitting;
  Mean mean;
  bool reduce_speed;

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const Control& now = control();
    // Asking before loading costs a small mesh 0.3 us a stage; asking after it cost a large one a third of
    // its speed.
    if (now.stop != Stop::running || (now.resume.limited != 0) != limited) return;
    const Tile<ExecutionSpace> tile(member, shape, ends.cells);
    load_cells(member, tile, field_data(now, weights.in));
    member.team_barrier();
    compute_fluxes(member, tile, now);
    member.team_barrier();
    store_boundary_fluxes(member, tile);
    update_cells(member, tile, now);
  }

  KOKKOS_FUNCTION const double* field_data(const Control& now, int role) const {
    return buffer[(now.resume.current + role) % 3].data();
  }

  KOKKOS_FUNCTION void load_cells(const Member& member, const Tile<ExecutionSpace>& tile,
                                  const double* in) const {
    using Lanes = device::Access<R>;
    const int stride = member.team_size() * Lanes::lanes;
    for (int i = member.team_rank() * Lanes::lanes; i < tile.cells + 2 * ghost_cells + Lanes::lanes - 1;
         i += stride) {
      const Triple<R> u = load_state<R>(in, ends, tile.first - ghost_cells + i);
      const CellState<R> s = cell_state<R>(gamma, u.rho, u.m, u.energy);
      const Speeds<R> speed = signal_speeds(s.u, s.c);
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
  }

  KOKKOS_FUNCTION Speeds<N> splitting_speeds(const Tile<ExecutionSpace>& tile, int face,
                                             const Control& now) const {
    using To = device::Convert<N>;
    if (splitting == Splitting::lf_stencil) {
      R slow = tile.template load<R>(TileField::slow, face),
        fast = tile.template load<R>(TileField::fast, face);
      R entropy = device::absolute(tile.template load<R>(TileField::u, face));
      for (int k = 1; k < 6; ++k) {
        slow = device::maximum(slow, tile.template load<R>(TileField::slow, face + k));
        fast = device::maximum(fast, tile.template load<R>(TileField::fast, face + k));
        entropy = device::maximum(entropy, device::absolute(tile.template load<R>(TileField::u, face + k)));
      }
      return {To::from(slow), To::from(entropy), To::from(fast)};
    }
    const auto& bits = now.stage_speed[stage];
    if (splitting == Splitting::lf_single) {
      const N alpha = To::from(R(max_speed(bits)));
      return {alpha, alpha, alpha};
    }
    return {To::from(R(Kokkos::bit_cast<double>(bits[0]))), To::from(R(Kokkos::bit_cast<double>(bits[1]))),
            To::from(R(Kokkos::bit_cast<double>(bits[2])))};
  }

  KOKKOS_FUNCTION void compute_fluxes(const Member& member, const Tile<ExecutionSpace>& tile,
                                      const Control& now) const {
    using Lanes = device::Access<R>;
    const int stride = member.team_size() * Lanes::lanes;
    for (int face = member.team_rank() * Lanes::lanes; face <= tile.cells; face += stride) {
      Stencil<R> s;
      for (int k = 0; k < 6; ++k) {
        s.state[k] = tile.template state<R>(face + k);
        s.flux_m[k] = tile.template load<R>(TileField::flux_m, face + k);
        s.flux_energy[k] = tile.template load<R>(TileField::flux_energy, face + k);
      }
      const Eigensystem<N> e = face_eigensystem<N, R>(mean, gamma, tile.template face_cell<R>(face + 2),
                                                      tile.template face_cell<R>(face + 3));
      Triple<R> flux = weno5_face<scheme, N>(s, e, splitting_speeds(tile, face, now));
      if constexpr (limited) flux = limit_flux(tile, face, s, flux, now);
      tile.store_flux(face, flux);
    }
  }

  KOKKOS_FUNCTION Triple<R> limit_flux(const Tile<ExecutionSpace>& tile, int face, const Stencil<R>& s,
                                       const Triple<R>& high, const Control& now) const {
    using Lanes = device::Access<R>;
    const double alpha = max_speed(now.stage_speed[stage]);
    const Triple<R> low = lax_friedrichs(s.state[2], s.flux_m[2], s.flux_energy[2], s.state[3], s.flux_m[3],
                                         s.flux_energy[3], alpha);
    const double two_lambda = 2.0 * weights.dt_factor * now.dt * inverse_dx;
    const LimitedFlux<R> result = limit(s.state[2], s.state[3], high, low, two_lambda, gamma);
    for (int lane = 0; lane < Lanes::lanes; ++lane) {
      const int f = face + lane;
      if (f > tile.cells || !(Lanes::lane(result.theta, lane) < 1.0)) continue;
      // A face between two tiles is computed by both; the right one counts it.
      if (f < tile.cells || tile.last) Kokkos::atomic_inc(&control().touches);
      if (tile.first + f > 0) touched(tile.first + f - 1) = 1;
      if (tile.first + f < ends.cells) touched(tile.first + f) = 1;
    }
    return result.flux;
  }

  KOKKOS_FUNCTION void store_boundary_fluxes(const Member& member, const Tile<ExecutionSpace>& tile) const {
    if (member.team_rank() != 0) return;
    for (int side = 0; side < 2; ++side) {
      if (side == 0 ? tile.first != 0 : !tile.last) continue;
      const Triple<double> f = tile.template flux<double>(side == 0 ? 0 : tile.cells);
      double(&out)[3] = control().boundary_flux[stage][side];
      out[0] = f.rho, out[1] = f.m, out[2] = f.energy;
    }
  }

  /// The fastest signals and the admissibility of the cells that one thread updated.
  template <class P>
  struct Reduced {
    P slow{0.0}, entropy{0.0}, fast{0.0}, admissible{1.0};
  };

  template <class P>
  KOKKOS_FUNCTION void update_cell(const Tile<ExecutionSpace>& tile, int i, double dt_over_dx,
                                   const double* u_n, double* out, Reduced<P>& reduced) const {
    using Lanes = device::Access<P>;
    const Triple<P> in = tile.template state<P>(i + ghost_cells);
    const Triple<P> left = tile.template flux<P>(i), right = tile.template flux<P>(i + 1);
    Triple<P> u = {weights.a_in * (in.rho + dt_over_dx * (left.rho - right.rho)),
                   weights.a_in * (in.m + dt_over_dx * (left.m - right.m)),
                   weights.a_in * (in.energy + dt_over_dx * (left.energy - right.energy))};
    const std::int64_t cell = tile.first + i, n = ends.cells;
    if (weights.a_n != 0.0) {
      u.rho = weights.a_n * Lanes::load(u_n + cell) + u.rho;
      u.m = weights.a_n * Lanes::load(u_n + n + cell) + u.m;
      u.energy = weights.a_n * Lanes::load(u_n + 2 * n + cell) + u.energy;
    }
    Lanes::store(out + cell, u.rho);
    Lanes::store(out + n + cell, u.m);
    Lanes::store(out + 2 * n + cell, u.energy);
    const P inverse = device::reciprocal(u.rho);
    const P velocity = u.m * inverse;
    const P p = pressure(gamma, u.m, u.energy, velocity);
    const P zero(0.0);
    // Every comparison is false for a NaN.
    P admissible = device::select(p > zero, reduced.admissible, zero);
    admissible = device::select(p <= P(1.7e308), admissible, zero);
    reduced.admissible = device::select(u.rho > zero, admissible, zero);
    if (!reduce_speed) return;
    const Speeds<P> speed = signal_speeds(velocity, device::square_root(gamma * (p * inverse)));
    reduced.slow = device::maximum(reduced.slow, speed.slow);
    reduced.entropy = device::maximum(reduced.entropy, speed.entropy);
    reduced.fast = device::maximum(reduced.fast, speed.fast);
  }

  KOKKOS_FUNCTION void update_cells(const Member& member, const Tile<ExecutionSpace>& tile,
                                    const Control& now) const {
    const double dt_over_dx = weights.dt_factor * now.dt * inverse_dx;
    const double* u_n = field_data(now, 0);
    double* out = buffer[(now.resume.current + weights.out) % 3].data();
    constexpr int lanes = device::Access<R>::lanes;
    Reduced<R> packs;
    const int whole = tile.cells / lanes * lanes;
    for (int i = member.team_rank() * lanes; i < whole; i += member.team_size() * lanes)
      update_cell<R>(tile, i, dt_over_dx, u_n, out, packs);
    Reduced<double> all;
    if constexpr (lanes > 1) {
      for (int i = whole; i < tile.cells; ++i) update_cell<double>(tile, i, dt_over_dx, u_n, out, all);
      for (int lane = 0; lane < lanes; ++lane) {
        using Lanes = device::Access<R>;
        all.slow = device::maximum(all.slow, Lanes::lane(packs.slow, lane));
        all.entropy = device::maximum(all.entropy, Lanes::lane(packs.entropy, lane));
        all.fast = device::maximum(all.fast, Lanes::lane(packs.fast, lane));
        all.admissible = device::minimum(all.admissible, Lanes::lane(packs.admissible, lane));
      }
    } else {
      all = packs;
    }
    if (all.admissible < 1.0) report_inadmissible(member, tile, out);
    if (reduce_speed) reduce_speeds(member, all);
  }

  KOKKOS_FUNCTION void reduce_speeds(const Member& member, const Reduced<double>& mine) const {
    auto& slots = control().stage_speed[stage + 1];
    if (splitting == Splitting::lf_global) {
      raise(member, slots[0], mine.slow);
      raise(member, slots[1], mine.entropy);
      raise(member, slots[2], mine.fast);
    } else {
      raise(member, slots[2], device::maximum(mine.slow, mine.fast));
    }
  }

  /// Raises `slot` to the team's maximum: positive doubles compare as their bits do, so the result does not
  /// depend on the order of the teams.
  KOKKOS_FUNCTION void raise(const Member& member, std::uint64_t& slot, double mine) const {
    double largest = mine;
    member.team_reduce(Kokkos::Max<double>(largest));
    if (member.team_rank() != 0) return;
    const auto bits = Kokkos::bit_cast<std::uint64_t>(largest);
    if (bits > Kokkos::atomic_load(&slot)) Kokkos::atomic_max(&slot, bits);
  }

  /// Slow path: finds the first inadmissible cell of the tile among those that this thread updated.
  KOKKOS_FUNCTION void report_inadmissible(const Member& member, const Tile<ExecutionSpace>& tile,
                                           const double* out) const {
    constexpr int lanes = device::Access<R>::lanes;
    for (int i = lanes > 1 ? 0 : member.team_rank(); i<tile.cells; i += lanes> 1 ? 1 : member.team_size()) {
      const std::int64_t cell = tile.first + i, n = ends.cells;
      const double rho = out[cell], m = out[n + cell], energy = out[2 * n + cell];
      const double p = pressure(gamma, m, energy, m * device::reciprocal(rho));  // as `update_cell` has it
      if (rho > 0.0 && p > 0.0 && p <= 1.7e308) continue;
      Quantity what = Quantity::not_finite;
      if (rho <= 0.0)
        what = Quantity::density;
      else if (p <= 0.0)
        what = Quantity::pressure;
      Kokkos::atomic_min(&control().bad, inadmissible(stage, cell, what));
    }
  }
};

}  // namespace drogue::gas
