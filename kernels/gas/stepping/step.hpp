#pragma once

#include <type_traits>

#include "kernels/device/memory.hpp"
#include "kernels/device/team_maximum.hpp"
#include "kernels/gas/tile/face_fluxes.hpp"
#include "kernels/gas/tile/limit_fluxes.hpp"

namespace drogue::gas {

/// All stages of a step in one launch. A tile loads three cells per stage and side beyond its own and
/// recomputes the values of its neighbours, so that no stage waits for another tile. Requires a splitting
/// with local alpha. Every cell gets the same bits as with `StageFunctor`.
template <class ExecutionSpace, Reconstruction scheme, Precision precision, bool limited>
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
  /// 1 for cells beside a limited face
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space> limited_cells;
  StageTable table;
  TileShape shape;
  BoundaryConditions boundaries;
  double gamma, inverse_dx;
  FaceAverage average;

  /// Hooks of a step with a launch of its own: the control values are known and the state lies in memory.
  struct SingleStepHooks {
    StepInput now;
    KOKKOS_FUNCTION void finish_previous_step() const {}
    KOKKOS_FUNCTION StepInput input() const { return now; }
    KOKKOS_FUNCTION ConservedVector<R> load(const double* in, const BoundaryConditions& ends,
                                            std::int64_t cell) const {
      return load_state<R>(in, ends, cell);
    }
    template <class P>
    KOKKOS_FUNCTION void state_stored(std::int64_t, const ConservedVector<P>&) const {}
  };

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const StepInput now = read_step_input(control());
    if (now.stop != Stop::running || now.limited != limited) return;
    const TileType tile(member, shape, boundaries.cells);
    run(member, tile, now.current, SingleStepHooks{now}, control().reduction);
  }

  /// Takes a step from the state in buffer `current`, which `hooks.load(start, boundaries, cell)` reads, and
  /// passes each new state to `hooks.state_stored(cell, state)`. All threads call
  /// `hooks.finish_previous_step()` after the first fluxes, which need no dt without the limiter, and
  /// `hooks.input()` after a barrier. Returns false if the input requests a stop.
  template <class AnyMember, class Hooks>
  KOKKOS_FUNCTION bool run(const AnyMember& member, const TileType& tile, int current, const Hooks& hooks,
                           StageReduction& reduction) const {
    const double* start = buffer[current].data();
    load_cells<R, TileType::keeps_start>(
        member, tile, gamma, [&](std::int64_t cell) { return hooks.load(start, boundaries, cell); });
    StepInput now{};
    if constexpr (limited) now = hooks.input();
    for (int stage = 0; stage < table.stages; ++stage) {
      const IndexRange faces = faces_of(tile, stage);
      member.team_barrier();
      compute_fluxes(member, tile, faces);
      if constexpr (limited) {
        member.team_barrier();
        limit_fluxes<R>(member, tile, faces.first, faces.last,
                        2.0 * (table.stage[stage].dt_factor * now.dt) * inverse_dx, gamma,
                        {limited_cells.data(), boundaries.cells, &reduction.limited_faces});
      }
      if (stage == 0) hooks.finish_previous_step();
      member.team_barrier();
      if (stage == 0) {
        now = hooks.input();
        if (now.stop != Stop::running || now.limited != limited) return false;
      }
      store_boundary_fluxes(member, tile, reduction, stage, tile.halo - ghost_cells,
                            tile.halo - ghost_cells + tile.cells);
      if (stage < table.stages - 1)
        update_slots<false>(member, tile, faces, stage, now, hooks, reduction);
      else
        update_slots<true>(member, tile, faces, stage, now, hooks, reduction);
    }
    return true;
  }

  /// Range of indices, both ends included.
  struct IndexRange {
    int first, last;
  };

  /// Cell that a slot represents.
  struct SlotImage {
    int slot;  ///< slot of that cell
    bool reflected;
  };

  /// Slots of the cells of the mesh. A periodic mesh covers all slots.
  KOKKOS_FUNCTION IndexRange mesh_slots(const TileType& tile) const {
    const std::int64_t left = tile.halo - tile.first, right = left + boundaries.cells - 1;
    const bool open_left = boundaries.left != Boundary::periodic && left > 0;
    const bool open_right = boundaries.right != Boundary::periodic && right < tile.slots - 1;
    return {open_left ? static_cast<int>(left) : 0, open_right ? static_cast<int>(right) : tile.slots - 1};
  }

  /// Faces whose stencils are valid at the start of stage `stage`. Each stage consumes three slots per side.
  KOKKOS_FUNCTION IndexRange faces_of(const TileType& tile, int stage) const {
    const IndexRange mesh = mesh_slots(tile);
    const int lost = ghost_cells * stage;
    return {device::maximum(lost, mesh.first - ghost_cells),
            device::minimum(tile.slots - 2 * ghost_cells - lost, mesh.last - ghost_cells + 1)};
  }

  template <class AnyMember>
  KOKKOS_FUNCTION void compute_fluxes(const AnyMember& member, const TileType& tile,
                                      const IndexRange& faces) const {
    for_face_fluxes<scheme, N, R>(
        member, tile, faces.first, faces.last, average, gamma, true, {},
        [&](int face, const ConservedVector<R>& flux) { tile.store_flux(face, flux); });
  }

  template <class P>
  KOKKOS_FUNCTION ConservedVector<P> start_state(const TileType& tile, int i, const double* u_n) const {
    if constexpr (TileType::keeps_start)
      return tile.template start<P>(i);
    else
      return load_state<P>(u_n, boundaries, tile.cell(i));
  }

  template <bool final_stage, class P, class Hooks>
  KOKKOS_FUNCTION void update_slot(const TileType& tile, int i, const SlotImage& image,
                                   const StageWeights& weights, double dt_over_dx, const double* u_n,
                                   double* out, const Hooks& hooks, CellReduction<P>& reduced) const {
    const ConservedVector<P> in = reflected(image, tile.template state<P>(i));
    ConservedVector<P> u = euler_step<P>(tile, in, image.slot, dt_over_dx);
    if (weights.share != 1.0)
      u = runge_kutta_combination(reflected(image, start_state<P>(tile, i, u_n)), weights.share, u);
    const CellState<P> s = cell_state<P>(gamma, u.rho, u.m, u.energy);
    reduced.check_admissible(s.rho, s.p);
    if constexpr (final_stage) {
      store_state(tile, i, u, boundaries.cells, out);
      hooks.state_stored(tile.cell(i), u);
    } else {
      store_cell(tile, i, reflected(image, s));
    }
    if constexpr (final_stage || limited) reduced.include_wave_speeds(wave_speeds(s.u, s.c));
  }

  template <bool final_stage, class AnyMember, class Hooks>
  KOKKOS_FUNCTION void update_slots(const AnyMember& member, const TileType& tile, const IndexRange& faces,
                                    int stage, const StepInput& now, const Hooks& hooks,
                                    StageReduction& reduction) const {
    constexpr int lanes = device::Access<R>::lanes;
    const StageWeights& weights = table.stage[stage];
    const double dt_over_dx = weights.dt_factor * now.dt * inverse_dx;
    const double* u_n = buffer[now.current].data();
    double* out = buffer[(now.current + weights.out) % 3].data();
    int begin = faces.first + ghost_cells, end = faces.last + ghost_cells;
    CellReduction<double> all;
    if constexpr (lanes == 1) {
      // A ghost slot has a thread of its own, which repeats the work of the thread of its cell.
      const IndexRange mesh = mesh_slots(tile);
      const int more = final_stage ? 0 : ghost_cells;
      if (begin == mesh.first) begin = device::maximum(begin - more, 0);
      if (end == mesh.last + 1) end = device::minimum(end + more, tile.slots);
      for (int i = begin + member.team_rank(); i < end; i += member.team_size())
        update_slot<final_stage, double>(tile, i, slot_image(mesh, i), weights, dt_over_dx, u_n, out, hooks,
                                         all);
    } else {
      const int whole = begin + (end - begin) / lanes * lanes;
      CellReduction<R> packs;
      for (int i = begin; i < whole; i += lanes)
        update_slot<final_stage, R>(tile, i, {i, false}, weights, dt_over_dx, u_n, out, hooks, packs);
      merge_lanes(packs, all);
      for (int i = whole; i < end; ++i)
        update_slot<final_stage, double>(tile, i, {i, false}, weights, dt_over_dx, u_n, out, hooks, all);
      if constexpr (!final_stage) fill_ghosts(tile);
    }
    if (all.admissible < 1.0)
      report_inadmissible_cells<final_stage>(member, tile, begin, end, stage, out, reduction);
    if constexpr (final_stage || limited)
      device::raise_to_team_maximum(member, reduction.stage_speed[stage + 1][2],
                                    device::maximum(all.slow, all.fast));
  }

  /// Image in slot `i`: the cell itself inside the mesh, a reflected cell beyond a wall.
  KOKKOS_FUNCTION SlotImage slot_image(const IndexRange& mesh, int i) const {
    if (i >= mesh.first && i <= mesh.last) return {i, false};
    const int end = i < mesh.first ? mesh.first : mesh.last;
    if ((i < mesh.first ? boundaries.left : boundaries.right) == Boundary::outflow) return {end, false};
    return {end + (end - i) + (i < mesh.first ? -1 : 1), true};
  }

  template <class P>
  KOKKOS_FUNCTION static ConservedVector<P> reflected(const SlotImage& image, const ConservedVector<P>& u) {
    return {u.rho, image.reflected ? -u.m : u.m, u.energy};
  }
  template <class P>
  KOKKOS_FUNCTION static CellState<P> reflected(const SlotImage& image, const CellState<P>& s) {
    return image.reflected ? CellState<P>{.rho = s.rho,
                                          .m = -s.m,
                                          .energy = s.energy,
                                          .u = -s.u,
                                          .p = s.p,
                                          .enthalpy = s.enthalpy,
                                          .c = s.c}
                           : s;
  }

  /// Fills the ghost slots of this tile from their image cells.
  KOKKOS_FUNCTION void fill_ghosts(const TileType& tile) const {
    const IndexRange mesh = mesh_slots(tile);
    for (int k = 1; k <= ghost_cells; ++k)
      for (const int i : {mesh.first - k, mesh.last + k}) {
        if (i < 0 || i >= tile.slots) continue;
        const SlotImage image = slot_image(mesh, i);
        const ConservedVector<double> u = tile.template state<double>(image.slot);
        store_cell(tile, i, reflected(image, cell_state<double>(gamma, u.rho, u.m, u.energy)));
      }
  }

  /// A thread checks only the slots that it updated, so no barrier is needed; the index range equals that of
  /// the update. A ghost slot reports its image cell.
  template <bool final_stage, class AnyMember>
  KOKKOS_FUNCTION void report_inadmissible_cells(const AnyMember& member, const TileType& tile, int begin,
                                                 int end, int stage, const double* out,
                                                 StageReduction& reduction) const {
    for (int i = begin + member.team_rank(); i < end; i += member.team_size()) {
      const std::int64_t cell = boundary_image(boundaries, tile.cell(i)).cell;
      report_inadmissible(
          reduction, gamma, stage, cell,
          final_stage ? state_of<double>(out, boundaries.cells, cell) : tile.template state<double>(i));
    }
  }
};

}  // namespace drogue::gas
