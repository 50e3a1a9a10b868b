#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/device/pack.hpp"
#include "kernels/gas/control.hpp"

namespace drogue::gas {

// These functions take copies of what they decide from: loads of a copy are in flight together, where a chain
// of decisions in global memory would wait for each.

/// Sets dt of the next attempt from the fastest signal of U^n: the CFL condition with its start-up ramp (or
/// the fixed step), cut to meet the target time, less what failed attempts have taken off: none is tried
/// twice.
KOKKOS_INLINE_FUNCTION void choose_dt(const Progress& now, Attempt& next, const StepConstants& k) {
  double dt = k.fixed_dt;
  if (!(dt > 0.0)) {
    const double ramp = now.step < k.ramp_steps
                            ? 0.1 + 0.9 * static_cast<double>(now.step) / static_cast<double>(k.ramp_steps)
                            : 1.0;
    dt = ramp * (now.limited ? k.limited_cfl : k.cfl) * k.dx * device::reciprocal(max_speed(now.speed));
  }
  const double left = next.target - now.time;
  const bool meets = dt >= left * (1.0 - 1e-12);
  next.reaches_target = meets && now.dt_scale == 1.0;
  next.dt = now.dt_scale * (meets ? left : dt);
}

KOKKOS_INLINE_FUNCTION void fail(const Progress& now, Attempt& attempt, Failed& failed, Quantity quantity,
                                 std::int64_t cell) {
  attempt.stop = Stop::failed;
  failed = {quantity, cell, now.step + 1, now.time, attempt.dt};
}

/// Makes the next attempt ready, or says why there is none.
KOKKOS_INLINE_FUNCTION void prepare_attempt(const Progress& now, Attempt& next, Failed& failed,
                                            const StepConstants& k) {
  choose_dt(now, next, k);
  // Also true for a NaN.
  if (!(now.time + next.dt > now.time)) fail(now, next, failed, Quantity::time_step, -1);
}

/// Empties what the stages of the next attempt will add to.
KOKKOS_INLINE_FUNCTION void empty(Outcome& outcome, const Progress& now) {
  for (int field = 0; field < 3; ++field) outcome.stage_speed[0][field] = now.speed[field];
  for (int stage = 1; stage <= max_stages; ++stage)
    for (int field = 0; field < 3; ++field) outcome.stage_speed[stage][field] = 0;
  outcome.bad = no_cell;
  outcome.touches = 0;
}

/// Tells the host where the device is. The host reads the fields one by one while they change and needs no
/// more than that each of them was true at some moment.
KOKKOS_INLINE_FUNCTION void report(const Progress& now, Attempt& attempt, Status& s) {
  s.step = now.step;
  s.time = now.time;
  s.dt = attempt.dt;
  s.limited = now.limited;
  s.stop = attempt.stop;
  s.rows = attempt.rows;
  // Counted here: the device would wait microseconds to read it from the host's memory.
  s.launches = ++attempt.launches;
}

/// Kahan's compensated addition: 10^6 steps of boundary fluxes must not cost the conservation check its
/// digits.
KOKKOS_INLINE_FUNCTION void add_compensated(double& sum, double& compensation, double value) {
  const double corrected = value - compensation;
  const double next = sum + corrected;
  compensation = (next - sum) - corrected;
  sum = next;
}

/// The part of an outcome that decides.
struct Findings {
  std::uint64_t bad;
  std::int64_t touches;
  std::uint64_t speed[3];
};

KOKKOS_INLINE_FUNCTION Findings findings(const Outcome& outcome, int stages) {
  const std::uint64_t(&speed)[3] = outcome.stage_speed[stages];
  return {outcome.bad, outcome.touches, {speed[0], speed[1], speed[2]}};
}

KOKKOS_INLINE_FUNCTION void reject(Progress& now, Attempt& attempt, Failed& failed, std::uint64_t bad,
                                   const StepConstants& k, bool limited) {
  const bool can_limit = k.positivity == static_cast<int>(Positivity::automatic);
  if (!limited && can_limit) {
    now.limited = 1;
    now.limited_left = limited_steps;
  } else if (limited && now.halvings < max_halvings) {
    ++now.halvings;
    now.dt_scale *= 0.5;
  } else {
    fail(now, attempt, failed, static_cast<Quantity>(bad & 3U), inadmissible_cell(bad));
    return;
  }
  ++now.redone;
  prepare_attempt(now, attempt, failed, k);
}

KOKKOS_INLINE_FUNCTION void accept(Progress& now, Attempt& attempt, Failed& failed, const Findings& found,
                                   const StepConstants& k, int result_buffer, bool limited) {
  const double dt = attempt.dt;
  now.last_dt = dt;
  now.dt_min = now.step == 0 || dt < now.dt_min ? dt : now.dt_min;
  now.dt_max = dt > now.dt_max ? dt : now.dt_max;
  now.time = attempt.reaches_target ? attempt.target : now.time + dt;
  ++now.step;
  now.current = (now.current + result_buffer) % 3;
  now.touches += found.touches;
  now.halvings = 0;
  now.dt_scale = 1.0;
  for (int field = 0; field < 3; ++field) now.speed[field] = found.speed[field];
  if (limited && k.positivity == static_cast<int>(Positivity::automatic) && --now.limited_left <= 0)
    now.limited = 0;
  if (attempt.reaches_target)
    attempt.stop = Stop::target;
  else if (now.step >= k.max_steps)
    attempt.stop = Stop::max_steps;
  else if (now.step == attempt.pause_step || now.step == attempt.row_step)
    attempt.stop = Stop::pause;
  else
    prepare_attempt(now, attempt, failed, k);
}

/// One of the six fluxes that the conservation check needs: what a step lets through an end, in units of dt.
KOKKOS_INLINE_FUNCTION double boundary_flux(const Outcome& outcome, const StageTable& table, int side,
                                            int field) {
  double flux = 0.0;
  for (int stage = 0; stage < table.stages; ++stage)
    flux += table.stage[stage].boundary * outcome.boundary_flux[stage][side][field];
  return flux;
}

/// Threads that end a step on a device: one for each boundary flux, and not more than wait for one another
/// anyway.
inline constexpr int finish_team = 32;

/// The last kernel of a step: one team that accepts or rejects the attempt.
template <class ExecutionSpace>
struct FinishFunctor {
  using Member = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;

  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  Kokkos::View<Status, device::HostPinnedSpace<ExecutionSpace>> status;
  StepConstants constants;
  StageTable table;
  bool limited;  ///< the step this kernel ends was computed with the limiter

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    Control& c = control();
    Progress now = c.resume;
    Attempt attempt = c.attempt;
    const Findings found = findings(c.outcome, table.stages);
    const bool ends = attempt.stop == Stop::running && (now.limited != 0) == limited;
    const bool stands = ends && found.bad == no_cell && !outgrown(c.outcome, attempt.dt);
    if (stands)
      for (int k = member.team_rank(); k < 6; k += member.team_size())
        add_compensated(c.resume.boundary[k / 3][k % 3], c.resume.compensation[k / 3][k % 3],
                        attempt.dt * boundary_flux(c.outcome, table, k / 3, k % 3));
    member.team_barrier();  // all have read what one now changes
    if (member.team_rank() != 0) return;
    if (stands)
      accept(now, attempt, c.failed, found, constants, table.stage[table.stages - 1].out, limited);
    else if (ends)
      reject(now, attempt, c.failed, found.bad, constants, limited);
    if (ends) empty(c.outcome, now);
    report(now, attempt, status());
    static_cast<Progress&>(c.resume) = now;
    c.attempt = attempt;
  }

  /// The limiter's guarantee needs lambda alpha <= 1/2 with every stage's own alpha, which may exceed the one
  /// dt is from.
  KOKKOS_FUNCTION bool outgrown(const Outcome& outcome, double dt) const {
    if (!limited) return false;
    for (int stage = 0; stage < table.stages; ++stage)
      if (table.stage[stage].dt_factor * dt * max_speed(outcome.stage_speed[stage]) > 0.5 * constants.dx)
        return true;
    return false;
  }
};

/// Takes up stepping towards a new target or pause. Calling it twice changes nothing.
template <class ExecutionSpace>
struct ResumeFunctor {
  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  Kokkos::View<Status, device::HostPinnedSpace<ExecutionSpace>> status;
  StepConstants constants;
  double target;
  std::int64_t pause_step, row_step;

  KOKKOS_FUNCTION void operator()(int) const {
    Control& c = control();
    const Progress now = c.resume;
    Attempt attempt = c.attempt;
    if (attempt.stop != Stop::failed) {
      attempt.target = target;
      attempt.pause_step = pause_step;
      attempt.row_step = row_step;
      attempt.stop = Stop::running;
      if (now.time >= target)
        attempt.stop = Stop::target;
      else if (now.step >= constants.max_steps)
        attempt.stop = Stop::max_steps;
      else
        prepare_attempt(now, attempt, c.failed, constants);
      empty(c.outcome, now);
    }
    report(now, attempt, status());
    c.attempt = attempt;
  }
};

}  // namespace drogue::gas
