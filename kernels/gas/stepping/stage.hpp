#pragma once

#include <type_traits>

#include "kernels/device/memory.hpp"
#include "kernels/device/team_maximum.hpp"
#include "kernels/gas/tile/face_fluxes.hpp"
#include "kernels/gas/tile/limit_fluxes.hpp"

namespace drogue::gas {

/// One Runge-Kutta stage in one kernel. Loads a tile of cells with its halo, computes each face flux once,
/// updates the cells, and reduces the maximum wave speeds and inadmissible cells.
///
/// A league member is a tile. Scratch holds nine values per cell and three per face. On a host a member is
/// one thread that works on packs of cells; on a device a team has one face per thread.
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
      limited_cells;  ///< 1 for cells beside a limited face
  StageWeights weights;
  TileShape shape;
  BoundaryConditions boundaries;
  double gamma, inverse_dx;
  int stage;
  Splitting splitting;
  FaceAverage average;
  bool reduce_speed;

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const StepInput now = read_step_input(control());
    // This check before the loads costs a small mesh 0.3 us per stage. After the loads it cost a large mesh a
    // third of its speed.
    if (now.stop != Stop::running || now.limited != limited) return;
    const Tile<ExecutionSpace> tile(member, shape, boundaries.cells);
    const double* in = field_data(now, weights.in);
    load_cells<R, false>(member, tile, gamma,
                         [&](std::int64_t cell) { return load_state<R>(in, boundaries, cell); });
    member.team_barrier();
    compute_fluxes(member, tile, weights.dt_factor * now.dt);
    member.team_barrier();
    store_boundary_fluxes(member, tile, control().reduction, stage, 0, tile.cells);
    update_cells(member, tile, now);
  }

  KOKKOS_FUNCTION double* field_data(const StepInput& now, int role) const {
    return buffer[(now.current + role) % 3].data();
  }

  /// Maximum wave speeds over the mesh, m/s; zero if alpha is local.
  KOKKOS_FUNCTION WaveSpeeds<N> mesh_wave_speeds() const {
    using To = device::Convert<N>;
    if (splitting == Splitting::lf_stencil) return {};
    const auto& bits = control().reduction.stage_speed[stage];
    if (splitting == Splitting::lf_single) {
      const N alpha = To::from(R(max_speed(bits)));
      return {alpha, alpha, alpha};
    }
    return {To::from(R(Kokkos::bit_cast<double>(bits[0]))), To::from(R(Kokkos::bit_cast<double>(bits[1]))),
            To::from(R(Kokkos::bit_cast<double>(bits[2])))};
  }

  KOKKOS_FUNCTION void compute_fluxes(const Member& member, const Tile<ExecutionSpace>& tile,
                                      double dt) const {
    for_face_fluxes<scheme, N, R>(
        member, tile, 0, tile.cells, average, gamma, splitting == Splitting::lf_stencil, mesh_wave_speeds(),
        [&](int face, const ConservedVector<R>& flux) { tile.store_flux(face, flux); });
    if constexpr (limited) {
      member.team_barrier();
      limit_fluxes<R>(member, tile, 0, tile.cells, 2.0 * dt * inverse_dx, gamma,
                      {limited_cells.data(), boundaries.cells, &control().reduction.limited_faces});
    }
  }

  template <class P>
  KOKKOS_FUNCTION void update_cell(const Tile<ExecutionSpace>& tile, int i, double dt_over_dx,
                                   const double* u_n, double* out, CellReduction<P>& reduced) const {
    ConservedVector<P> u = euler_step<P>(tile, tile.template state<P>(i), i, dt_over_dx);
    if (weights.share != 1.0)
      u = runge_kutta_combination(state_of<P>(u_n, boundaries.cells, tile.cell(i)), weights.share, u);
    store_state(tile, i, u, boundaries.cells, out);
    const P inverse = device::reciprocal(u.rho);
    const P velocity = u.m * inverse;
    const P p = pressure(gamma, u.m, u.energy, velocity);
    reduced.check_admissible(u.rho, p);
    if (reduce_speed)
      reduced.include_wave_speeds(wave_speeds(velocity, device::square_root(gamma * (p * inverse))));
  }

  KOKKOS_FUNCTION void update_cells(const Member& member, const Tile<ExecutionSpace>& tile,
                                    const StepInput& now) const {
    const double dt_over_dx = weights.dt_factor * now.dt * inverse_dx;
    const double* u_n = field_data(now, 0);
    double* out = field_data(now, weights.out);
    constexpr int lanes = device::Access<R>::lanes;
    CellReduction<R> packs;
    const int begin = tile.halo, end = tile.halo + tile.cells, whole = begin + tile.cells / lanes * lanes;
    for (int i = begin + member.team_rank() * lanes; i < whole; i += member.team_size() * lanes)
      update_cell<R>(tile, i, dt_over_dx, u_n, out, packs);
    CellReduction<double> all;
    merge_lanes(packs, all);
    for (int i = whole; i < end; ++i) update_cell<double>(tile, i, dt_over_dx, u_n, out, all);
    if (all.admissible < 1.0) {
      for (int i = begin + member.team_rank(); i < end; i += member.team_size()) {
        const std::int64_t cell = tile.cell(i);
        report_inadmissible(control().reduction, gamma, stage, cell,
                            state_of<double>(out, boundaries.cells, cell));
      }
    }
    if (reduce_speed) reduce_speeds(member, all);
  }

  KOKKOS_FUNCTION void reduce_speeds(const Member& member, const CellReduction<double>& mine) const {
    auto& slots = control().reduction.stage_speed[stage + 1];
    if (splitting == Splitting::lf_global) {
      device::raise_to_team_maximum(member, slots[0], mine.slow);
      device::raise_to_team_maximum(member, slots[1], mine.entropy);
      device::raise_to_team_maximum(member, slots[2], mine.fast);
    } else {
      device::raise_to_team_maximum(member, slots[2], device::maximum(mine.slow, mine.fast));
    }
  }
};

}  // namespace drogue::gas
