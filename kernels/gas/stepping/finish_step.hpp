#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/device/pack.hpp"
#include "kernels/gas/stepping/control.hpp"

namespace drogue::gas {

// These functions take copies of their inputs: the loads of a copy overlap, whereas decisions on global
// memory would load one after another.

/// Admissible dt of the next step, s: the CFL condition for the maximum wave speed of U^n with its start-up
/// ramp, or the fixed step.
KOKKOS_INLINE_FUNCTION double admissible_dt(const Progress& now, const StepConstants& k) {
  if (k.fixed_dt > 0.0) return k.fixed_dt;
  const double ramp = now.step < k.ramp_steps
                          ? 0.1 + 0.9 * static_cast<double>(now.step) / static_cast<double>(k.ramp_steps)
                          : 1.0;
  return ramp * (now.limited ? k.limited_cfl : k.cfl) * k.dx * device::reciprocal(max_speed(now.speed));
}

KOKKOS_INLINE_FUNCTION void fail(const Progress& now, StepTrial& trial, StepFailure& failure,
                                 FailureReason reason, std::int64_t cell) {
  trial.stop = Stop::failed;
  failure = {.reason = reason, .index = cell, .step = now.step + 1, .time = now.time, .dt = trial.dt};
}

/// Prepares the next trial, or records a failure if dt is too small.
KOKKOS_INLINE_FUNCTION void prepare_trial(const Progress& now, StepTrial& next, StepFailure& failure,
                                          const StepConstants& k) {
  if (!stepping::set_dt(now, next, admissible_dt(now, k), now.dt_scale))
    fail(now, next, failure, FailureReason::time_step, -1);
}

/// Resets the reductions of the stages.
KOKKOS_INLINE_FUNCTION void reset(StageReduction& reduction, const Progress& now) {
  for (int field = 0; field < 3; ++field) reduction.stage_speed[0][field] = now.speed[field];
  for (int stage = 1; stage <= max_stages; ++stage)
    for (int field = 0; field < 3; ++field) reduction.stage_speed[stage][field] = 0;
  reduction.first_inadmissible = no_failure;
  reduction.limited_faces = 0;
}

/// Compensated addition (Kahan 1965). Without it the conservation check would lose its digits over 10^6
/// steps.
KOKKOS_INLINE_FUNCTION void add_compensated(double& sum, double& compensation, double value) {
  const double corrected = value - compensation;
  const double next = sum + corrected;
  compensation = (next - sum) - corrected;
  sum = next;
}

/// Reductions of a whole step that decide on its acceptance.
struct StepResult {
  std::uint64_t first_inadmissible;
  std::int64_t limited_faces;
  std::uint64_t speed[3];
};

KOKKOS_INLINE_FUNCTION StepResult step_result(const StageReduction& reduction, int stages) {
  const std::uint64_t(&speed)[3] = reduction.stage_speed[stages];
  return {reduction.first_inadmissible, reduction.limited_faces, {speed[0], speed[1], speed[2]}};
}

KOKKOS_INLINE_FUNCTION void reject(Progress& now, StepTrial& trial, StepFailure& failure,
                                   std::uint64_t first_inadmissible, const StepConstants& k, bool limited) {
  const bool can_limit = k.positivity == static_cast<int>(Positivity::automatic);
  if (!limited && can_limit) {
    now.limited = 1;
    now.limited_left = automatic_limited_steps;
  } else if (limited && now.halvings < max_halvings && !(k.fixed_dt > 0.0)) {
    ++now.halvings;
    now.dt_scale *= 0.5;
  } else {
    fail(now, trial, failure, inadmissible_reason(first_inadmissible), inadmissible_cell(first_inadmissible));
    return;
  }
  ++now.redone;
  prepare_trial(now, trial, failure, k);
}

KOKKOS_INLINE_FUNCTION void accept(Progress& now, StepTrial& trial, StepFailure& failure,
                                   const StepResult& result, const StepConstants& k, int result_buffer,
                                   bool limited) {
  stepping::advance_time(now, trial);
  now.current = (now.current + result_buffer) % 3;
  now.limited_faces += result.limited_faces;
  now.halvings = 0;
  now.dt_scale = 1.0;
  for (int field = 0; field < 3; ++field) now.speed[field] = result.speed[field];
  if (limited && k.positivity == static_cast<int>(Positivity::automatic) && --now.limited_left <= 0)
    now.limited = 0;
  if (stepping::continues(now, trial, k.max_steps)) prepare_trial(now, trial, failure, k);
}

/// Flux of one field through one end of the mesh, averaged over the stages of a step.
KOKKOS_INLINE_FUNCTION double boundary_flux(const StageReduction& reduction, const StageTable& table,
                                            int side, int field) {
  double flux = 0.0;
  for (int stage = 0; stage < table.stages; ++stage)
    flux += table.stage[stage].boundary * reduction.boundary_flux[stage][side][field];
  return flux;
}

/// Threads of the last kernel of a step on a device: at least one per boundary flux, at most one warp.
inline constexpr int finish_team = 32;

/// Last kernel of a step: one team accepts or rejects the trial.
template <class ExecutionSpace>
struct FinishFunctor {
  using Member = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;

  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  Kokkos::View<Status, device::HostPinnedSpace<ExecutionSpace>> status;
  StepConstants constants;
  StageTable table;
  bool limited;  ///< true if the stages of this step used the limiter

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    Control& c = control();
    Progress now = c.restart;
    StepTrial trial = c.trial;
    const StepResult result = step_result(c.reduction, table.stages);
    const bool finishes_trial = trial.stop == Stop::running && (now.limited != 0) == limited;
    const bool accepted =
        finishes_trial && result.first_inadmissible == no_failure && !violates_cfl(c.reduction, trial.dt);
    if (accepted)
      for (int k = member.team_rank(); k < 6; k += member.team_size())
        add_compensated(c.restart.boundary[k / 3][k % 3], c.restart.compensation[k / 3][k % 3],
                        trial.dt * boundary_flux(c.reduction, table, k / 3, k % 3));
    member.team_barrier();  // all threads have read the values that thread 0 changes next
    if (member.team_rank() != 0) return;
    if (accepted)
      accept(now, trial, c.failure, result, constants, table.stage[table.stages - 1].out, limited);
    else if (finishes_trial)
      reject(now, trial, c.failure, result.first_inadmissible, constants, limited);
    if (finishes_trial) reset(c.reduction, now);
    stepping::publish_status(now, trial, now.limited, status());
    static_cast<Progress&>(c.restart) = now;
    c.trial = trial;
  }

  /// True if a stage violates lambda alpha <= 1/2 with its own alpha, which the guarantee of the limiter
  /// requires. The alpha of a stage may exceed the one that determined dt.
  KOKKOS_FUNCTION bool violates_cfl(const StageReduction& reduction, double dt) const {
    if (!limited) return false;
    for (int stage = 0; stage < table.stages; ++stage)
      if (table.stage[stage].dt_factor * dt * max_speed(reduction.stage_speed[stage]) > 0.5 * constants.dx)
        return true;
    return false;
  }
};

/// Starts an advance. Idempotent.
template <class ExecutionSpace>
struct BeginAdvanceFunctor {
  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  Kokkos::View<Status, device::HostPinnedSpace<ExecutionSpace>> status;
  StepConstants constants;
  stepping::AdvanceRequest request;
  std::int64_t row_step;  ///< step of the first history row

  KOKKOS_FUNCTION void operator()(int) const {
    Control& c = control();
    const Progress now = c.restart;
    StepTrial trial = c.trial;
    if (trial.stop != Stop::failed) {
      if (stepping::begin_advance(now, trial, request, row_step, constants.max_steps))
        prepare_trial(now, trial, c.failure, constants);
      reset(c.reduction, now);
    }
    stepping::publish_status(now, trial, now.limited, status());
    c.trial = trial;
  }
};

}  // namespace drogue::gas
