#pragma once

#include "kernels/fabric/state.hpp"
#include "kernels/fabric/stepping/step_monitor.hpp"

namespace drogue::fabric {

/// Time, s, `part` of a step after `steps` steps; `clock.step` is not used.
KOKKOS_INLINE_FUNCTION double stage_time(const TimeState& clock, std::int64_t steps, double part) {
  return clock.start + (static_cast<double>(steps - clock.since) + part) * clock.dt;
}

/// Time of a stage from the step count on the device: no launch depends on the host's count, so that a
/// captured step remains valid when it is replayed.
template <class ExecutionSpace>
struct StageTime {
  StepMonitor<ExecutionSpace> monitor;
  TimeState clock;  ///< `step` is not used
  int parity;       ///< entry of `monitor.steps` that counts the steps taken
  double part;      ///< fraction of a step since then

  KOKKOS_FUNCTION double time() const { return stage_time(clock, monitor.steps(parity), part); }
};

}  // namespace drogue::fabric
