#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/stepping/status.hpp"

// Device-resident step control for a variable dt. The last kernel of a step calls these functions in one
// thread, so that no step waits for the host. They take copies: the loads of a copy overlap, whereas
// decisions on global memory would load one after another.

namespace drogue::stepping {

/// Step trial under way, and the stopping criteria of the present advance.
struct StepTrial {
  double dt;                 ///< s
  double target;             ///< s, time at which the advance stops
  std::int64_t pause_step;   ///< step at which the advance stops
  std::int64_t output_step;  ///< step of the next output
  int reaches_target;        ///< 1 if this trial ends at `target`
  Stop stop;
  std::int64_t outputs;   ///< outputs written
  std::int64_t launches;  ///< launches that have published a status
};

/// Sets dt of the next trial, s: shortens the admissible `dt` to meet the target, then multiplies it by
/// `scale`, the reduction by rejected trials. Returns false if the step would not change the time, also for a
/// NaN.
KOKKOS_INLINE_FUNCTION bool set_dt(const AdaptiveTime& now, StepTrial& next, double dt, double scale) {
  const double left = next.target - now.time;
  const bool meets = dt >= left * (1.0 - 1e-12);
  next.reaches_target = meets && scale == 1.0;
  next.dt = scale * (meets ? left : dt);
  return now.time + next.dt > now.time;
}

/// Adds an accepted trial to the time and the number of steps.
KOKKOS_INLINE_FUNCTION void advance_time(AdaptiveTime& now, const StepTrial& trial) {
  now.last_dt = trial.dt;
  now.dt_min = now.step == 0 || trial.dt < now.dt_min ? trial.dt : now.dt_min;
  now.dt_max = trial.dt > now.dt_max ? trial.dt : now.dt_max;
  now.time = trial.reaches_target ? trial.target : now.time + trial.dt;
  ++now.step;
}

/// Sets `stop` after an accepted trial. Returns true if another trial must be prepared.
KOKKOS_INLINE_FUNCTION bool continues(const AdaptiveTime& now, StepTrial& trial, std::int64_t max_steps) {
  if (trial.reaches_target)
    trial.stop = Stop::target;
  else if (now.step >= max_steps)
    trial.stop = Stop::max_steps;
  else if (now.step == trial.pause_step || now.step == trial.output_step)
    trial.stop = Stop::pause;
  else
    return true;
  return false;
}

/// Stopping criteria of an advance.
struct AdvanceRequest {
  double target;                 ///< s
  std::int64_t pause_step = -1;  ///< -1: no pause
  int output_every = 0;          ///< steps between outputs; 0: no outputs
};

/// Starts an advance. Idempotent; a failed run stays failed. Returns true if a trial must be prepared.
KOKKOS_INLINE_FUNCTION bool begin_advance(const AdaptiveTime& now, StepTrial& trial,
                                          const AdvanceRequest& request, std::int64_t output_step,
                                          std::int64_t max_steps) {
  if (trial.stop == Stop::failed) return false;
  trial.target = request.target;
  trial.pause_step = request.pause_step;
  trial.output_step = output_step;
  trial.stop = Stop::running;
  if (now.time >= request.target)
    trial.stop = Stop::target;
  else if (now.step >= max_steps)
    trial.stop = Stop::max_steps;
  return trial.stop == Stop::running;
}

/// True if the stepping has stopped for an output.
KOKKOS_INLINE_FUNCTION bool output_is_due(const AdaptiveTime& now, const StepTrial& trial) {
  return trial.stop == Stop::pause && now.step == trial.output_step;
}

/// Schedules the output after the one that was due. Returns true if the stepping goes on and a trial must be
/// prepared.
KOKKOS_INLINE_FUNCTION bool resume_after_output(const AdaptiveTime& now, StepTrial& trial, int output_every) {
  trial.output_step += output_every;
  if (now.step == trial.pause_step) return false;
  trial.stop = Stop::running;
  return true;
}

/// Publishes the progress to the host. Every launch that `StepLoop` counts calls it once.
KOKKOS_INLINE_FUNCTION void publish_status(const AdaptiveTime& now, StepTrial& trial, int variant,
                                           Status& status) {
  status.step = now.step;
  status.time = now.time;
  status.dt = trial.dt;
  status.variant = variant;
  status.stop = trial.stop;
  status.outputs = trial.outputs;
  // Counted on the device: reading pinned host memory would take microseconds.
  status.launches = ++trial.launches;
}

}  // namespace drogue::stepping
