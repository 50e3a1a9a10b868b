#pragma once

#include <type_traits>

#include "kernels/device/memory.hpp"
#include "kernels/device/team_maximum.hpp"
#include "kernels/gas/tile_update.hpp"

namespace drogue::gas {

/// All stages of a step in one launch: a tile loads three cells a stage and side beyond its own and computes
/// what its neighbours compute too, so that no stage waits for another tile. That needs a splitting whose
/// alpha is local, and no limiter (whose dissipation looks at the whole mesh). Every cell gets the bits that
/// `StageFunctor` gives it.
template <class ExecutionSpace, Reconstruction scheme, Precision precision>
struct StepFunctor {
  static constexpr bool on_host = device::is_host<ExecutionSpace>;
  using Member = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;
  using R = std::conditional_t<on_host, device::HostPack<double>, double>;
  using Single = std::conditional_t<on_host, device::HostPack<float>, float>;
  using N = std::conditional_t<precision == Precision::split, Single, R>;
  using Fields = FieldsView<ExecutionSpace>;
  using TileType = Tile<ExecutionSpace>;

  Fields buffer[3];
  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  StageTable table;
  TileShape shape;
  Ends ends;
  double gamma, inverse_dx;
  Mean mean;

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const StepInput now = read_step_input(control());
    if (now.stop != Stop::running || now.limited) return;
    const TileType tile(member, shape, ends.cells);
    load_cells<R>(member, tile, ends, gamma, buffer[now.current].data());
    for (int stage = 0; stage < table.stages; ++stage) {
      const Range faces = faces_of(tile, stage);
      member.team_barrier();
      compute_fluxes(member, tile, faces);
      member.team_barrier();
      store_boundary_fluxes(member, tile, control(), stage, tile.halo - ghost_cells,
                            tile.halo - ghost_cells + tile.cells);
      if (stage < table.stages - 1)
        update_slots<false>(member, tile, faces, stage, now);
      else
        update_slots<true>(member, tile, faces, stage, now);
    }
  }

  /// Both ends included.
  struct Range {
    int first, last;
  };

  /// Slots of the cells of the mesh; those of a periodic one go on for ever.
  KOKKOS_FUNCTION Range mesh_slots(const TileType& tile) const {
    const std::int64_t left = tile.halo - tile.first, right = left + ends.cells - 1;
    const bool open_left = ends.left != Boundary::periodic && left > 0;
    const bool open_right = ends.right != Boundary::periodic && right < tile.slots - 1;
    return {open_left ? static_cast<int>(left) : 0, open_right ? static_cast<int>(right) : tile.slots - 1};
  }

  KOKKOS_FUNCTION bool at_an_end(const TileType& tile) const {
    const Range mesh = mesh_slots(tile);
    return mesh.first > 0 || mesh.last < tile.slots - 1;
  }

  /// Faces whose stencils hold what stage `stage` begins with; each stage loses three slots a side.
  KOKKOS_FUNCTION Range faces_of(const TileType& tile, int stage) const {
    const Range mesh = mesh_slots(tile);
    const int lost = ghost_cells * stage;
    return {device::maximum(lost, mesh.first - ghost_cells),
            device::minimum(tile.slots - 2 * ghost_cells - lost, mesh.last - ghost_cells + 1)};
  }

  KOKKOS_FUNCTION void compute_fluxes(const Member& member, const TileType& tile, const Range& faces) const {
    constexpr int lanes = device::Access<R>::lanes;
    for (int face = faces.first + member.team_rank() * lanes; face <= faces.last;
         face += member.team_size() * lanes)
      tile.store_flux(face, face_flux<scheme, N>(tile, face, load_stencil<R>(tile, face), mean, gamma,
                                                 stencil_speeds<N, R>(tile, face)));
  }

  template <bool final_stage, class P>
  KOKKOS_FUNCTION CellState<P> update_slot(const TileType& tile, int i, const StageWeights& weights,
                                           double dt_over_dx, const double* u_n, double* out,
                                           Reduced<P>& reduced) const {
    Triple<P> u = euler_step<P>(tile, i, weights.a_in, dt_over_dx);
    if (weights.a_n != 0.0) u = combined(weights.a_n, load_state<P>(u_n, ends, tile.cell(i)), u);
    const CellState<P> s = cell_state<P>(gamma, u.rho, u.m, u.energy);
    reduced.judge(s.rho, s.p);
    if constexpr (final_stage) {
      store_state(tile, i, u, ends.cells, out);
      reduced.raise(signal_speeds(s.u, s.c));
    } else {
      store_cell(tile, i, s);
    }
    return s;
  }

  template <bool final_stage>
  KOKKOS_FUNCTION void update_slots(const Member& member, const TileType& tile, const Range& faces, int stage,
                                    const StepInput& now) const {
    constexpr int lanes = device::Access<R>::lanes;
    const StageWeights& weights = table.stage[stage];
    const double dt_over_dx = weights.dt_factor * now.dt * inverse_dx;
    const double* u_n = buffer[now.current].data();
    double* out = buffer[(now.current + weights.out) % 3].data();
    const int begin = faces.first + ghost_cells, end = faces.last + ghost_cells;
    const int whole = begin + (end - begin) / lanes * lanes;
    Reduced<R> packs;
    for (int i = begin + member.team_rank() * lanes; i < whole; i += member.team_size() * lanes) {
      const CellState<R> s = update_slot<final_stage, R>(tile, i, weights, dt_over_dx, u_n, out, packs);
      if constexpr (!final_stage && lanes == 1) fill_ghosts(tile, i, s);
    }
    Reduced<double> all;
    merge_lanes(packs, all);
    if constexpr (lanes > 1) {
      for (int i = whole; i < end; ++i)
        update_slot<final_stage, double>(tile, i, weights, dt_over_dx, u_n, out, all);
      if (!final_stage && at_an_end(tile))
        for (int i = begin; i < end; ++i) {
          if (!is_imaged(tile.cell(i))) continue;
          const Triple<double> u = tile.template state<double>(i);
          fill_ghosts(tile, i, cell_state<double>(gamma, u.rho, u.m, u.energy));
        }
    }
    if (all.admissible < 1.0) find_inadmissible<final_stage>(member, tile, begin, end, stage, out);
    if constexpr (final_stage)
      device::raise_to_team_maximum(member, control().stage_speed[table.stages][2],
                                    device::maximum(all.slow, all.fast));
  }

  KOKKOS_FUNCTION bool is_imaged(std::int64_t cell) const {
    return cell < ghost_cells || cell >= ends.cells - ghost_cells;
  }

  /// The ghosts are images of the three cells beside an end of the mesh; who computes such a cell, in slot
  /// `i`, renews them.
  KOKKOS_FUNCTION void fill_ghosts(const TileType& tile, int i, const CellState<double>& s) const {
    const std::int64_t cell = tile.cell(i);
    const Range mesh = mesh_slots(tile);
    if (cell < ghost_cells) fill_side(tile, i, s, mesh.first, -1, ends.left);
    if (cell >= ends.cells - ghost_cells) fill_side(tile, i, s, mesh.last, 1, ends.right);
  }

  /// `end` is the slot of the last cell on this side, `out` the direction out of the mesh.
  KOKKOS_FUNCTION void fill_side(const TileType& tile, int i, const CellState<double>& s, int end, int out,
                                 Boundary kind) const {
    if (kind == Boundary::reflecting) {
      store_ghost(tile, end + (end - i) + out, {s.rho, -s.m, s.energy, -s.u, s.p, s.enthalpy, s.c});
    } else if (kind == Boundary::outflow && i == end) {
      for (int k = 1; k <= ghost_cells; ++k) store_ghost(tile, end + out * k, s);
    }
  }

  KOKKOS_FUNCTION void store_ghost(const TileType& tile, int i, const CellState<double>& s) const {
    if (i >= 0 && i < tile.slots) store_cell(tile, i, s);
  }

  template <bool final_stage>
  KOKKOS_FUNCTION void find_inadmissible(const Member& member, const TileType& tile, int begin, int end,
                                         int stage, const double* out) const {
    for (int i = begin + member.team_rank(); i < end; i += member.team_size()) {
      const std::int64_t cell = source_cell(ends, tile.cell(i)).cell;
      report_inadmissible(
          control(), gamma, stage, cell,
          final_stage ? state_of<double>(out, ends.cells, cell) : tile.template state<double>(i));
    }
  }
};

}  // namespace drogue::gas
