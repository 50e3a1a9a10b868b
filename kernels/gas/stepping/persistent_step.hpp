#pragma once

#include "kernels/device/persistent_kernel.hpp"
#include "kernels/device/relaxed_access.hpp"
#include "kernels/gas/stepping/finish_step.hpp"
#include "kernels/gas/stepping/step.hpp"

namespace drogue::gas {

/// Many steps in one launch, for a mesh whose tiles are all resident at once. It does the work of
/// `StepFunctor` and `FinishFunctor`, but every team takes the decisions itself, from the same numbers. After
/// a step a team reads its halo cells from the halo exchange buffer as soon as its neighbours have written
/// them, and starts the fluxes, which do not depend on dt. Meanwhile its last warp reduces the maximum wave
/// speed over all teams and decides on the step.
template <class ExecutionSpace, Reconstruction scheme, Precision precision>
struct PersistentStepFunctor {
  using Step = StepFunctor<ExecutionSpace, scheme, precision, false>;
  static constexpr std::uint64_t inadmissible_mark = ~std::uint64_t{0};  ///< sent instead of a wave speed

  Step step;
  Kokkos::View<Status, device::HostPinnedSpace<ExecutionSpace>> status;
  StepConstants constants;
  std::int64_t max_steps_per_launch;

  /// Hooks of `StepFunctor::run`: acceptance of the previous step, the next dt, and the halo exchange.
  template <class Member>
  struct PersistentStepHooks {
    const PersistentStepFunctor& self;
    const Member& member;
    const Tile<ExecutionSpace>& tile;
    TeamControl& team;
    std::uint64_t epoch;  ///< of the previous step
    std::int64_t done;    ///< steps completed in this launch
    double dt;            ///< of the previous step, s

    KOKKOS_FUNCTION void finish_previous_step() const {
      const int lane = member.team_rank() - first_of_last_warp(member);
      if (lane >= 0) self.finish_previous_step(member, team, lane, *this);
    }
    KOKKOS_FUNCTION StepInput input() const {
      const StepTrial& trial = team.trial;
      return {team.ends_launch ? Stop::pause : trial.stop, false, team.restart.current, trial.dt};
    }
    /// At the start of a launch all cells are in memory; the cells of this team always are.
    KOKKOS_FUNCTION ConservedVector<double> load(const double* in, const BoundaryConditions& boundaries,
                                                 std::int64_t cell) const {
      const BoundaryImage from = boundary_image(boundaries, cell);
      const std::int64_t in_tile = from.cell - tile.first;
      if (done == 0 || (in_tile >= 0 && in_tile < tile.cells))
        return load_state<double>(in, boundaries, cell);
      const device::HaloValue u = member.get(epoch, static_cast<std::size_t>(from.cell));
      return {u.value[0], from.sign * u.value[1], u.value[2]};
    }
    /// Sends cells that lie in the halo of a neighbour.
    KOKKOS_FUNCTION void state_stored(std::int64_t cell, const ConservedVector<double>& u) const {
      const std::int64_t in_tile = cell - tile.first;
      if (in_tile < tile.halo || in_tile >= tile.cells - tile.halo)
        member.put(epoch + 1, static_cast<std::size_t>(cell), {{u.rho, u.m, u.energy}});
    }
  };

  template <class Member>
  KOKKOS_FUNCTION static int first_of_last_warp(const Member& member) {
    return member.team_size() - 32;
  }

  template <class Member>
  KOKKOS_FUNCTION void finish_previous_step(const Member& member, TeamControl& team, int lane,
                                            const PersistentStepHooks<Member>& last) const {
    if (last.done > 0) {
      // Work that does not depend on other teams comes before the wait. Local copies, because the compiler
      // reloads scratch memory after every wait.
      const int side = lane / 3, field = lane % 3;
      const bool at_end = side < 2 && is_at_end(member, side);
      const double flux = at_end ? boundary_flux(team.reduction, step.table, side, field) : 0.0;
      Progress now = team.restart;
      StepTrial trial = team.trial;
      const std::uint64_t fastest = member.await_largest(last.epoch);
      const bool accepted = fastest != inadmissible_mark;
      if (lane == 0) {
        if (accepted)
          accept(now, trial, team.failure, {no_failure, 0, {0, 0, fastest}}, constants, result_buffer(),
                 false);
        else
          reject(now, trial, team.failure, first_inadmissible_cell(member, last.epoch), constants, false);
        static_cast<Progress&>(team.restart) = now;
        team.trial = trial;
      }
      if (accepted && at_end)
        add_compensated(team.restart.boundary[side][field], team.restart.compensation[side][field],
                        last.dt * flux);
    }
    if (lane == 0)
      team.ends_launch =
          last.done == max_steps_per_launch || team.trial.stop != Stop::running || team.restart.limited != 0;
  }

  [[nodiscard]] KOKKOS_FUNCTION int result_buffer() const {
    return step.table.stage[step.table.stages - 1].out;
  }

  /// Slow path: the first inadmissible cell of all teams, from global memory.
  template <class Member>
  KOKKOS_FUNCTION std::uint64_t first_inadmissible_cell(const Member& member, std::uint64_t epoch) const {
    member.publish(epoch);
    for (int team = 0; team < member.league_size(); ++team) member.await(team, epoch);
    return device::relaxed_load(&step.control().reduction.first_inadmissible);
  }

  /// Sends the result of the step of this team to all others.
  template <class Member>
  KOKKOS_FUNCTION void end_step(const Member& member, TeamControl& team, std::uint64_t epoch) const {
    if (member.team_rank() == 0 && team.reduction.first_inadmissible != no_failure)
      Kokkos::atomic_min(&step.control().reduction.first_inadmissible, team.reduction.first_inadmissible);
    if (member.team_rank() == first_of_last_warp(member)) {
      std::uint64_t& fastest = team.reduction.stage_speed[step.table.stages][2];
      member.send(epoch, team.reduction.first_inadmissible != no_failure ? inadmissible_mark : fastest);
      fastest = 0;
    }
  }

  template <class Member>
  KOKKOS_FUNCTION void operator()(const Member& member) const {
    TeamControl& team = *static_cast<TeamControl*>(
        member.team_scratch(0).get_shmem_aligned(sizeof(TeamControl), alignof(TeamControl)));
    const Tile<ExecutionSpace> tile(member, step.shape, step.boundaries.cells);
    const std::uint64_t first_epoch = member.epoch();
    Control& control = step.control();
    if (member.team_rank() == 0) {
      team.restart = control.restart;
      team.trial = control.trial;
      team.failure = control.failure;
      team.ends_launch = false;
      reset(team.reduction, team.restart);
    }
    member.team_barrier();
    int current = team.restart.current;
    double dt = 0.0;
    std::uint64_t epoch = first_epoch;
    for (std::int64_t done = 0;; ++done, ++epoch) {
      if (!step.run(member, tile, current,
                    PersistentStepHooks<Member>{.self = *this,
                                                .member = member,
                                                .tile = tile,
                                                .team = team,
                                                .epoch = epoch,
                                                .done = done,
                                                .dt = dt},
                    team.reduction))
        break;
      dt = team.trial.dt;
      current = (current + result_buffer()) % 3;
      member.team_barrier();
      end_step(member, team, epoch + 1);
    }
    if (member.team_rank() == 0) member.publish(epoch);
    write_back(member, team, control);
  }

  /// The team at an end of the mesh holds its boundary sums; all teams hold the other values.
  template <class Member>
  KOKKOS_FUNCTION void write_back(const Member& member, TeamControl& team, Control& control) const {
    if (member.team_rank() != first_of_last_warp(member)) return;
    for (int side = 0; side < 2; ++side)
      for (int field = 0; field < 3 && is_at_end(member, side); ++field) {
        control.restart.boundary[side][field] = team.restart.boundary[side][field];
        control.restart.compensation[side][field] = team.restart.compensation[side][field];
      }
    if (member.league_rank() != 0) return;
    stepping::publish_status(team.restart, team.trial, team.restart.limited, status());
    static_cast<Progress&>(control.restart) = team.restart;
    control.trial = team.trial;
    control.failure = team.failure;
    reset(control.reduction, team.restart);
  }

  template <class Member>
  KOKKOS_FUNCTION static bool is_at_end(const Member& member, int side) {
    return member.league_rank() == (side == 0 ? 0 : member.league_size() - 1);
  }
};

}  // namespace drogue::gas
