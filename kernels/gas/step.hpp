#pragma once

#include <type_traits>

#include "kernels/device/memory.hpp"
#include "kernels/device/team_maximum.hpp"
#include "kernels/gas/faces.hpp"
#include "kernels/gas/limit_faces.hpp"

namespace drogue::gas {

/// All stages of a step in one launch: a tile loads three cells a stage and side beyond its own and computes
/// what its neighbours compute too, so that no stage waits for another tile. That needs a splitting whose
/// alpha is local. Every cell gets the bits that `StageFunctor` gives it.
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
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space> touched;  ///< by the limiter
  StageTable table;
  TileShape shape;
  Ends ends;
  double gamma, inverse_dx;
  Mean mean;

  /// What a step that has a launch of its own knows from the beginning: the state lies in memory.
  struct Known {
    StepInput now;
    KOKKOS_FUNCTION void decide() const {}
    KOKKOS_FUNCTION StepInput input() const { return now; }
    KOKKOS_FUNCTION Triple<R> load(const double* in, const Ends& ends, std::int64_t cell) const {
      return load_state<R>(in, ends, cell);
    }
    template <class P>
    KOKKOS_FUNCTION void stored(std::int64_t, const Triple<P>&) const {}
  };

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const StepInput now = read_step_input(control());
    if (now.stop != Stop::running || now.limited != limited) return;
    const TileType tile(member, shape, ends.cells);
    run(member, tile, now.current, Known{now}, control().outcome);
  }

  /// A step from the state in buffer `current`, which `decision.load(start, ends, cell)` reads; it hears of
  /// each new state by `stored(cell, state)`. All threads call `decision.decide()` once the first fluxes
  /// are computed, which need no dt but for the limiter, and `input()` after a barrier; false if that tells
  /// not to step.
  template <class AnyMember, class Decision>
  KOKKOS_FUNCTION bool run(const AnyMember& member, const TileType& tile, int current,
                           const Decision& decision, Outcome& outcome) const {
    const double* start = buffer[current].data();
    load_cells<R, TileType::keeps_start>(member, tile, gamma,
                                         [&](std::int64_t cell) { return decision.load(start, ends, cell); });
    StepInput now{};
    if constexpr (limited) now = decision.input();
    for (int stage = 0; stage < table.stages; ++stage) {
      const Range faces = faces_of(tile, stage);
      member.team_barrier();
      compute_fluxes(member, tile, faces);
      if constexpr (limited) {
        member.team_barrier();
        limit_fluxes<R>(member, tile, faces.first, faces.last,
                        2.0 * (table.stage[stage].dt_factor * now.dt) * inverse_dx, gamma,
                        {touched.data(), ends.cells, &outcome.touches});
      }
      if (stage == 0) decision.decide();
      member.team_barrier();
      if (stage == 0) {
        now = decision.input();
        if (now.stop != Stop::running || now.limited != limited) return false;
      }
      store_boundary_fluxes(member, tile, outcome, stage, tile.halo - ghost_cells,
                            tile.halo - ghost_cells + tile.cells);
      if (stage < table.stages - 1)
        update_slots<false>(member, tile, faces, stage, now, decision, outcome);
      else
        update_slots<true>(member, tile, faces, stage, now, decision, outcome);
    }
    return true;
  }

  /// Both ends included.
  struct Range {
    int first, last;
  };

  /// What a slot stands for.
  struct Image {
    int of;  ///< slot of the cell
    bool turned;
  };

  /// Slots of the cells of the mesh; those of a periodic one go on for ever.
  KOKKOS_FUNCTION Range mesh_slots(const TileType& tile) const {
    const std::int64_t left = tile.halo - tile.first, right = left + ends.cells - 1;
    const bool open_left = ends.left != Boundary::periodic && left > 0;
    const bool open_right = ends.right != Boundary::periodic && right < tile.slots - 1;
    return {open_left ? static_cast<int>(left) : 0, open_right ? static_cast<int>(right) : tile.slots - 1};
  }

  /// Faces whose stencils hold what stage `stage` begins with; each stage loses three slots a side.
  KOKKOS_FUNCTION Range faces_of(const TileType& tile, int stage) const {
    const Range mesh = mesh_slots(tile);
    const int lost = ghost_cells * stage;
    return {device::maximum(lost, mesh.first - ghost_cells),
            device::minimum(tile.slots - 2 * ghost_cells - lost, mesh.last - ghost_cells + 1)};
  }

  template <class AnyMember>
  KOKKOS_FUNCTION void compute_fluxes(const AnyMember& member, const TileType& tile,
                                      const Range& faces) const {
    for_face_fluxes<scheme, N, R>(member, tile, faces.first, faces.last, mean, gamma, true, {},
                                  [&](int face, const Triple<R>& flux) { tile.store_flux(face, flux); });
  }

  template <class P>
  KOKKOS_FUNCTION Triple<P> start_state(const TileType& tile, int i, const double* u_n) const {
    if constexpr (TileType::keeps_start)
      return tile.template start<P>(i);
    else
      return load_state<P>(u_n, ends, tile.cell(i));
  }

  template <bool final_stage, class P, class Decision>
  KOKKOS_FUNCTION void update_slot(const TileType& tile, int i, const Image& image,
                                   const StageWeights& weights, double dt_over_dx, const double* u_n,
                                   double* out, const Decision& decision, Reduced<P>& reduced) const {
    const Triple<P> in = turned(image, tile.template state<P>(i));
    Triple<P> u = euler_step<P>(tile, in, image.of, dt_over_dx);
    if (weights.share != 1.0) u = combined(turned(image, start_state<P>(tile, i, u_n)), weights.share, u);
    const CellState<P> s = cell_state<P>(gamma, u.rho, u.m, u.energy);
    reduced.judge(s.rho, s.p);
    if constexpr (final_stage) {
      store_state(tile, i, u, ends.cells, out);
      decision.stored(tile.cell(i), u);
    } else {
      store_cell(tile, i, turned(image, s));
    }
    if constexpr (final_stage || limited) reduced.raise(signal_speeds(s.u, s.c));
  }

  template <bool final_stage, class AnyMember, class Decision>
  KOKKOS_FUNCTION void update_slots(const AnyMember& member, const TileType& tile, const Range& faces,
                                    int stage, const StepInput& now, const Decision& decision,
                                    Outcome& outcome) const {
    constexpr int lanes = device::Access<R>::lanes;
    const StageWeights& weights = table.stage[stage];
    const double dt_over_dx = weights.dt_factor * now.dt * inverse_dx;
    const double* u_n = buffer[now.current].data();
    double* out = buffer[(now.current + weights.out) % 3].data();
    int begin = faces.first + ghost_cells, end = faces.last + ghost_cells;
    Reduced<double> all;
    if constexpr (lanes == 1) {
      // A ghost has a thread of its own, which does what the thread of the cell does.
      const Range mesh = mesh_slots(tile);
      const int more = final_stage ? 0 : ghost_cells;
      if (begin == mesh.first) begin = device::maximum(begin - more, 0);
      if (end == mesh.last + 1) end = device::minimum(end + more, tile.slots);
      for (int i = begin + member.team_rank(); i < end; i += member.team_size())
        update_slot<final_stage, double>(tile, i, image_at(mesh, i), weights, dt_over_dx, u_n, out, decision,
                                         all);
    } else {
      const int whole = begin + (end - begin) / lanes * lanes;
      Reduced<R> packs;
      for (int i = begin; i < whole; i += lanes)
        update_slot<final_stage, R>(tile, i, {i, false}, weights, dt_over_dx, u_n, out, decision, packs);
      merge_lanes(packs, all);
      for (int i = whole; i < end; ++i)
        update_slot<final_stage, double>(tile, i, {i, false}, weights, dt_over_dx, u_n, out, decision, all);
      if constexpr (!final_stage) fill_ghosts(tile);
    }
    if (all.admissible < 1.0) find_inadmissible<final_stage>(member, tile, begin, end, stage, out, outcome);
    if constexpr (final_stage || limited)
      device::raise_to_team_maximum(member, outcome.stage_speed[stage + 1][2],
                                    device::maximum(all.slow, all.fast));
  }

  /// The image in slot `i`: of itself within the mesh, and in a wall one that moves the other way.
  KOKKOS_FUNCTION Image image_at(const Range& mesh, int i) const {
    if (i >= mesh.first && i <= mesh.last) return {i, false};
    const int end = i < mesh.first ? mesh.first : mesh.last;
    if ((i < mesh.first ? ends.left : ends.right) == Boundary::outflow) return {end, false};
    return {end + (end - i) + (i < mesh.first ? -1 : 1), true};
  }

  template <class P>
  KOKKOS_FUNCTION static Triple<P> turned(const Image& image, const Triple<P>& u) {
    return {u.rho, image.turned ? -u.m : u.m, u.energy};
  }
  template <class P>
  KOKKOS_FUNCTION static CellState<P> turned(const Image& image, const CellState<P>& s) {
    return image.turned ? CellState<P>{s.rho, -s.m, s.energy, -s.u, s.p, s.enthalpy, s.c} : s;
  }

  /// The ghosts that lie in this tile, from the cells that they are images of.
  KOKKOS_FUNCTION void fill_ghosts(const TileType& tile) const {
    const Range mesh = mesh_slots(tile);
    for (int k = 1; k <= ghost_cells; ++k)
      for (const int i : {mesh.first - k, mesh.last + k}) {
        if (i < 0 || i >= tile.slots) continue;
        const Image image = image_at(mesh, i);
        const Triple<double> u = tile.template state<double>(image.of);
        store_cell(tile, i, turned(image, cell_state<double>(gamma, u.rho, u.m, u.energy)));
      }
  }

  /// A thread looks at the slots that it has updated, without a barrier: the range is that of the update. A
  /// ghost names the cell that it is an image of.
  template <bool final_stage, class AnyMember>
  KOKKOS_FUNCTION void find_inadmissible(const AnyMember& member, const TileType& tile, int begin, int end,
                                         int stage, const double* out, Outcome& outcome) const {
    for (int i = begin + member.team_rank(); i < end; i += member.team_size()) {
      const std::int64_t cell = source_cell(ends, tile.cell(i)).cell;
      report_inadmissible(
          outcome, gamma, stage, cell,
          final_stage ? state_of<double>(out, ends.cells, cell) : tile.template state<double>(i));
    }
  }
};

}  // namespace drogue::gas
