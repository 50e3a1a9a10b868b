#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/gas/control.hpp"

namespace drogue::gas {

/// Sets dt of the next attempt from the fastest signal of U^n: the CFL condition with its start-up ramp (or
/// the fixed step), less what failed attempts have taken off, cut to meet the target time.
KOKKOS_INLINE_FUNCTION void choose_dt(Control& c, const StepConstants& k) {
  const Resume& r = c.resume;
  double dt = k.fixed_dt;
  if (!(dt > 0.0)) {
    const double ramp = r.step < k.ramp_steps
                            ? 0.1 + 0.9 * static_cast<double>(r.step) / static_cast<double>(k.ramp_steps)
                            : 1.0;
    dt = ramp * (r.limited ? k.limited_cfl : k.cfl) * k.dx / max_speed(r.speed);
  }
  dt *= r.dt_scale;
  const double left = c.target - r.time;
  c.reaches_target = dt >= left * (1.0 - 1e-12);
  c.dt = c.reaches_target ? left : dt;
}

/// Empties what the stages of the next attempt will add to.
KOKKOS_INLINE_FUNCTION void clear_attempt(Control& c) {
  for (int field = 0; field < 3; ++field) c.stage_speed[0][field] = c.resume.speed[field];
  for (int stage = 1; stage <= max_stages; ++stage)
    for (int field = 0; field < 3; ++field) c.stage_speed[stage][field] = 0;
  c.bad = no_cell;
  c.touches = 0;
}

KOKKOS_INLINE_FUNCTION void fail(Control& c, Quantity quantity, std::int64_t cell) {
  c.stop = Stop::failed;
  c.failed = {quantity, cell, c.resume.step + 1, c.resume.time, c.dt};
}

/// Makes the next attempt ready, or says why there is none.
KOKKOS_INLINE_FUNCTION void prepare_attempt(Control& c, const StepConstants& k) {
  clear_attempt(c);
  choose_dt(c, k);
  // Also true for a NaN.
  if (!(c.resume.time + c.dt > c.resume.time)) fail(c, Quantity::time_step, -1);
}

/// Tells the host where the device is. The host reads the fields one by one while they change and needs no
/// more than that each of them was true at some moment.
KOKKOS_INLINE_FUNCTION void report(Control& c, Status& s) {
  s.step = c.resume.step;
  s.time = c.resume.time;
  s.dt = c.dt;
  s.limited = c.resume.limited;
  s.stop = c.stop;
  s.rows = c.rows;
  // Counted here: the device would wait microseconds to read it from the host's memory.
  s.launches = ++c.launches;
}

/// Kahan's compensated addition: 10^6 steps of boundary fluxes must not cost the conservation check its
/// digits.
KOKKOS_INLINE_FUNCTION void add_compensated(double& sum, double& compensation, double value) {
  const double corrected = value - compensation;
  const double next = sum + corrected;
  compensation = (next - sum) - corrected;
  sum = next;
}

/// The last kernel of a step: one thread that accepts or rejects the attempt.
template <class ExecutionSpace>
struct FinishFunctor {
  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  Kokkos::View<Status, device::ReportSpace<ExecutionSpace>> status;
  StepConstants constants;
  StageTable table;
  bool limited;  ///< the step this kernel ends was computed with the limiter

  KOKKOS_FUNCTION void operator()(int) const {
    // A copy: its loads are in flight together, where a chain of decisions in global memory would wait for
    // each.
    Control c = control();
    if (c.stop == Stop::running && (c.resume.limited != 0) == limited) {
      if (c.bad != no_cell || outgrown(c))
        reject(c);
      else
        accept(c);
    }
    report(c, status());
    control() = c;
  }

  /// The limiter's guarantee needs lambda alpha <= 1/2 with every stage's own alpha, which may exceed the one
  /// dt is from.
  KOKKOS_FUNCTION bool outgrown(const Control& c) const {
    if (!limited) return false;
    for (int stage = 0; stage < constants.stages; ++stage)
      if (table.stage[stage].dt_factor * c.dt * max_speed(c.stage_speed[stage]) > 0.5 * constants.dx)
        return true;
    return false;
  }

  KOKKOS_FUNCTION void reject(Control& c) const {
    Resume& r = c.resume;
    const bool can_limit = constants.positivity == static_cast<int>(Positivity::automatic);
    if (!limited && can_limit) {
      r.limited = 1;
      r.limited_left = limited_steps;
    } else if (limited && r.halvings < max_halvings) {
      ++r.halvings;
      r.dt_scale *= 0.5;
    } else {
      fail(c, static_cast<Quantity>(c.bad & 3U), inadmissible_cell(c.bad));
      return;
    }
    ++r.redone;
    prepare_attempt(c, constants);
  }

  KOKKOS_FUNCTION void accept(Control& c) const {
    Resume& r = c.resume;
    for (int side = 0; side < 2; ++side)
      for (int field = 0; field < 3; ++field) {
        double flux = 0.0;
        for (int stage = 0; stage < constants.stages; ++stage)
          flux += table.stage[stage].boundary * c.boundary_flux[stage][side][field];
        add_compensated(r.boundary[side][field], r.compensation[side][field], c.dt * flux);
      }
    r.last_dt = c.dt;
    r.dt_min = r.step == 0 || c.dt < r.dt_min ? c.dt : r.dt_min;
    r.dt_max = c.dt > r.dt_max ? c.dt : r.dt_max;
    r.time = c.reaches_target ? c.target : r.time + c.dt;
    ++r.step;
    r.current = (r.current + table.stage[constants.stages - 1].out) % 3;
    r.touches += c.touches;
    r.halvings = 0;
    r.dt_scale = 1.0;
    for (int field = 0; field < 3; ++field) r.speed[field] = c.stage_speed[constants.stages][field];
    if (limited && constants.positivity == static_cast<int>(Positivity::automatic) && --r.limited_left <= 0)
      r.limited = 0;
    if (c.reaches_target)
      c.stop = Stop::target;
    else if (r.step >= constants.max_steps)
      c.stop = Stop::max_steps;
    else if (r.step == c.pause_step || r.step == c.row_step)
      c.stop = Stop::pause;
    else
      prepare_attempt(c, constants);
  }
};

/// Takes up stepping towards a new target or pause. Calling it twice changes nothing.
template <class ExecutionSpace>
struct ResumeFunctor {
  Kokkos::View<Control, typename ExecutionSpace::memory_space> control;
  Kokkos::View<Status, device::ReportSpace<ExecutionSpace>> status;
  StepConstants constants;
  double target;
  std::int64_t pause_step, row_step;

  KOKKOS_FUNCTION void operator()(int) const {
    Control& c = control();
    if (c.stop != Stop::failed) {
      c.target = target;
      c.pause_step = pause_step;
      c.row_step = row_step;
      c.stop = Stop::running;
      if (c.resume.time >= target)
        c.stop = Stop::target;
      else if (c.resume.step >= constants.max_steps)
        c.stop = Stop::max_steps;
      else
        prepare_attempt(c, constants);
    }
    report(c, status());
  }
};

}  // namespace drogue::gas
