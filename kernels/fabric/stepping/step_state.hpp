#pragma once

#include <utility>

#include "kernels/fabric/launch.hpp"
#include "kernels/fabric/results.hpp"
#include "kernels/fabric/stepping/divergence.hpp"

namespace drogue::fabric {

/// State that steps move, and its clock.
template <class ExecutionSpace>
struct StepState {
  using Points = PointsView<ExecutionSpace>;

  Points x, v;  ///< m and m/s, at the end of the steps enqueued
  Points spare_x,
      spare_v;  ///< with which steps alternate; without content between steps; `spare_v` may be empty
  StepMonitor<ExecutionSpace> monitor;
  TimeState time;
  int parity = 0;  ///< entry of `monitor.steps` that counts the completed steps

  /// Time of a kernel, a fraction of a step after the completed ones. Does not throw.
  [[nodiscard]] stepping::StageTime<ExecutionSpace> at(double fraction) const {
    return {monitor, time, parity, fraction};
  }
};

/// Copies the state after an odd number of steps that alternate between two buffers to the Views that the
/// solver exposes.
template <class ExecutionSpace>
struct RestoreAddressesFunctor {
  StepMonitor<ExecutionSpace> monitor;
  PointsView<ExecutionSpace> from_x, from_v, x, v;  ///< `from_v` may be `v`

  KOKKOS_FUNCTION void operator()(const int i) const {
    store_points(x, i, load_points<double>(from_x, i));
    store_points(v, i, load_points<double>(from_v, i));
    if (i == 0) monitor.steps(0) = monitor.steps(1);
  }
};

/// Moves the state back to its stable addresses after an odd number of steps. Asynchronous.
template <class ExecutionSpace>
void restore_addresses(const ExecutionSpace& space, StepState<ExecutionSpace>& state) {
  if (state.parity == 0) return;
  const PointsView<ExecutionSpace> x = state.x, v = state.v;
  std::swap(state.x, state.spare_x);
  if (state.spare_v.extent(0) > 0) std::swap(state.v, state.spare_v);
  launch_each(space, "drogue::fabric::restore_addresses", static_cast<int>(x.extent(0)),
              RestoreAddressesFunctor<ExecutionSpace>{
                  .monitor = state.monitor, .from_x = x, .from_v = v, .x = state.x, .v = state.v});
  state.parity = 0;
}

}  // namespace drogue::fabric
