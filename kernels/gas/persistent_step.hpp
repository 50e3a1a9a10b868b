#pragma once

#include "kernels/device/persistent_kernel.hpp"
#include "kernels/gas/finish.hpp"
#include "kernels/gas/step.hpp"

namespace drogue::gas {

/// Many steps in one launch, for a mesh whose tiles all run at once: what `StepFunctor` and `FinishFunctor`
/// do, but every team decides for itself, from the same numbers. A team that has ended its step reads the
/// cells of its halo from the board of its grid, as soon as its neighbours have posted them, and goes on with
/// the fluxes, which need no dt; meanwhile its last warp hears the fastest signals of all teams and decides.
template <class ExecutionSpace, Reconstruction scheme, Precision precision>
struct PersistentStepFunctor {
  using Step = StepFunctor<ExecutionSpace, scheme, precision, false>;
  static constexpr std::uint64_t bad_state = ~std::uint64_t{0};  ///< told instead of a speed

  Step step;
  Kokkos::View<Status, device::HostPinnedSpace<ExecutionSpace>> status;
  StepConstants constants;
  std::int64_t most_steps;

  /// What `StepFunctor::run` asks for: whether the step before stands, the next dt, and the cells of others.
  template <class Member>
  struct Decision {
    const PersistentStepFunctor& self;
    const Member& member;
    const Tile<ExecutionSpace>& tile;
    Judgement& own;
    std::uint64_t epoch;  ///< of the step before
    std::int64_t done;    ///< steps of this launch
    double dt;            ///< of the step before

    KOKKOS_FUNCTION void decide() const {
      const int lane = member.team_rank() - first_of_last_warp(member);
      if (lane >= 0) self.decide(member, own, lane, *this);
    }
    KOKKOS_FUNCTION StepInput input() const {
      const Attempt& attempt = own.attempt;
      return {own.ends ? Stop::pause : attempt.stop, false, own.resume.current, attempt.dt};
    }
    /// All cells lie in memory when a launch begins, and always those that this team updates.
    KOKKOS_FUNCTION Triple<double> load(const double* in, const Ends& ends, std::int64_t cell) const {
      const Source from = source_cell(ends, cell);
      const std::int64_t in_tile = from.cell - tile.first;
      if (done == 0 || (in_tile >= 0 && in_tile < tile.cells)) return load_state<double>(in, ends, cell);
      const device::HaloValue u = member.get(epoch, static_cast<std::size_t>(from.cell));
      return {u.value[0], from.sign * u.value[1], u.value[2]};
    }
    /// Cells that a neighbour's halo holds.
    KOKKOS_FUNCTION void stored(std::int64_t cell, const Triple<double>& u) const {
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
  KOKKOS_FUNCTION void decide(const Member& member, Judgement& own, int lane,
                              const Decision<Member>& last) const {
    if (last.done > 0) {
      // Before the others are heard: all that does not hang on them. Copies, because the compiler loads from
      // scratch again after every wait.
      const int side = lane / 3, field = lane % 3;
      const bool at_end = side < 2 && is_at_end(member, side);
      const double flux = at_end ? boundary_flux(own.outcome, step.table, side, field) : 0.0;
      Progress now = own.resume;
      Attempt attempt = own.attempt;
      const std::uint64_t fastest = member.await_largest(last.epoch);
      const bool stands = fastest != bad_state;
      if (lane == 0) {
        if (stands)
          accept(now, attempt, own.failed, {no_cell, 0, {0, 0, fastest}}, constants, result_buffer(), false);
        else
          reject(now, attempt, own.failed, worst_cell(member, last.epoch), constants, false);
        static_cast<Progress&>(own.resume) = now;
        own.attempt = attempt;
      }
      if (stands && at_end)
        add_compensated(own.resume.boundary[side][field], own.resume.compensation[side][field],
                        last.dt * flux);
    }
    if (lane == 0)
      own.ends = last.done == most_steps || own.attempt.stop != Stop::running || own.resume.limited != 0;
  }

  [[nodiscard]] KOKKOS_FUNCTION int result_buffer() const {
    return step.table.stage[step.table.stages - 1].out;
  }

  /// The slow path: what the teams have agreed on in global memory.
  template <class Member>
  KOKKOS_FUNCTION std::uint64_t worst_cell(const Member& member, std::uint64_t epoch) const {
    member.publish(epoch);
    for (int team = 0; team < member.league_size(); ++team) member.await(team, epoch);
    return Kokkos::atomic_load(&step.control().outcome.bad);
  }

  /// Tells the others how the step has ended here.
  template <class Member>
  KOKKOS_FUNCTION void end_step(const Member& member, Judgement& own, std::uint64_t epoch) const {
    if (member.team_rank() == 0 && own.outcome.bad != no_cell)
      Kokkos::atomic_min(&step.control().outcome.bad, own.outcome.bad);
    if (member.team_rank() == first_of_last_warp(member)) {
      std::uint64_t& fastest = own.outcome.stage_speed[step.table.stages][2];
      member.send(epoch, own.outcome.bad != no_cell ? bad_state : fastest);
      fastest = 0;
    }
  }

  template <class Member>
  KOKKOS_FUNCTION void operator()(const Member& member) const {
    Judgement& own = *static_cast<Judgement*>(
        member.team_scratch(0).get_shmem_aligned(sizeof(Judgement), alignof(Judgement)));
    const Tile<ExecutionSpace> tile(member, step.shape, step.ends.cells);
    const std::uint64_t begun = member.epoch();
    Control& control = step.control();
    if (member.team_rank() == 0) {
      own.resume = control.resume;
      own.attempt = control.attempt;
      own.failed = control.failed;
      own.ends = false;
      empty(own.outcome, own.resume);
    }
    member.team_barrier();
    int current = own.resume.current;
    double dt = 0.0;
    std::uint64_t epoch = begun;
    for (std::int64_t done = 0;; ++done, ++epoch) {
      if (!step.run(member, tile, current, Decision<Member>{*this, member, tile, own, epoch, done, dt},
                    own.outcome))
        break;
      dt = own.attempt.dt;
      current = (current + result_buffer()) % 3;
      member.team_barrier();
      end_step(member, own, epoch + 1);
    }
    if (member.team_rank() == 0) member.publish(epoch);
    write_back(member, own, control);
  }

  /// The sums at an end of the mesh are with the team there, all else with every team.
  template <class Member>
  KOKKOS_FUNCTION void write_back(const Member& member, Judgement& own, Control& control) const {
    if (member.team_rank() != first_of_last_warp(member)) return;
    for (int side = 0; side < 2; ++side)
      for (int field = 0; field < 3 && is_at_end(member, side); ++field) {
        control.resume.boundary[side][field] = own.resume.boundary[side][field];
        control.resume.compensation[side][field] = own.resume.compensation[side][field];
      }
    if (member.league_rank() != 0) return;
    report(own.resume, own.attempt, status());
    static_cast<Progress&>(control.resume) = own.resume;
    control.attempt = own.attempt;
    control.failed = own.failed;
    empty(control.outcome, own.resume);
  }

  template <class Member>
  KOKKOS_FUNCTION static bool is_at_end(const Member& member, int side) {
    return member.league_rank() == (side == 0 ? 0 : member.league_size() - 1);
  }
};

}  // namespace drogue::gas
