#pragma once

#include <optional>

#include <Kokkos_Core.hpp>

#include "kernels/device/copy.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/device/memory.hpp"
#include "kernels/stepping/failure_code.hpp"
#include "kernels/stepping/status.hpp"

// Asynchronous failure detection and rollback for steps that do not wait for a decision: kernels record the
// first failure and go on; the host reads a flag without a fence, and returns to the last checkpoint.

namespace drogue::stepping {

/// Device-resident step counter and failure record. Kernels hold it by value.
template <class ExecutionSpace>
struct StepMonitor {
  using Memory = typename ExecutionSpace::memory_space;
  using StatusView = Kokkos::View<Status, device::HostPinnedSpace<ExecutionSpace>>;

  /// Double-buffered step counter: while kernels read one entry, a later kernel may set the other.
  Kokkos::View<std::int64_t[2], Memory> steps;
  Kokkos::View<std::uint64_t, Memory> first_failure;  ///< minimum of `encode_failure`
  StatusView status;

  /// Records a failure at `index` in `step`. Asynchronous; any thread may call it.
  KOKKOS_FUNCTION void record_failure(std::int64_t step, std::int64_t index) const {
    Kokkos::atomic_min(&first_failure(), encode_failure(step, index));
    status().failed = 1;
  }
  [[nodiscard]] KOKKOS_FUNCTION bool has_failed() const { return first_failure() != no_failure; }
};

/// Monitor whose status is `status`. Counters and record are unset: call `reset_monitor`. Throws
/// `std::runtime_error` if memory runs out.
template <class ExecutionSpace>
[[nodiscard]] StepMonitor<ExecutionSpace> make_monitor(
    const typename StepMonitor<ExecutionSpace>::StatusView& status) {
  StepMonitor<ExecutionSpace> monitor;
  monitor.steps = decltype(monitor.steps)("drogue::stepping::steps");
  monitor.first_failure = decltype(monitor.first_failure)("drogue::stepping::first_failure");
  monitor.status = status;
  return monitor;
}

/// Sets both step counters to `step` and clears the failure record. Blocks. Throws `std::runtime_error`
/// after a failed kernel.
template <class ExecutionSpace>
void reset_monitor(const ExecutionSpace& space, const StepMonitor<ExecutionSpace>& monitor,
                   std::int64_t step) {
  Kokkos::deep_copy(space, monitor.steps, step);
  Kokkos::deep_copy(space, monitor.first_failure, no_failure);
  space.fence("drogue::stepping::reset_monitor");
  monitor.status().step = step;
  monitor.status().failed = 0;
}

/// Number of completed steps as the device has counted them in entry `parity` of the counter. Blocks. Throws
/// `std::runtime_error` after a failed kernel.
template <class ExecutionSpace>
[[nodiscard]] std::int64_t completed_steps(const ExecutionSpace& space,
                                           const StepMonitor<ExecutionSpace>& monitor, int parity) {
  std::int64_t steps[2] = {};
  device::copy_out(space, steps, monitor.steps, 2);
  space.fence("drogue::stepping::completed_steps");
  return steps[parity];
}

/// Time, s, after `steps` steps and a `fraction` of the next one, in a run with constant dt. `origin.step` is
/// ignored.
KOKKOS_INLINE_FUNCTION double stage_time(const TimeState& origin, std::int64_t steps, double fraction) {
  return origin.start + (static_cast<double>(steps - origin.since) + fraction) * origin.dt;
}

/// Time at which a kernel of a run with constant dt works. It reads the step counter on the device, so that a
/// captured step stays valid.
template <class ExecutionSpace>
struct StageTime {
  StepMonitor<ExecutionSpace> monitor;
  TimeState origin;
  int parity;       ///< entry of the step counter that holds the completed steps
  double fraction;  ///< elapsed fraction of the present step

  /// Time, s.
  KOKKOS_FUNCTION double time() const { return stage_time(origin, monitor.steps(parity), fraction); }
};

/// Kernel that saves a state unless a failure has been recorded. `Copy` saves the entries of index i.
template <class ExecutionSpace, class Copy>
struct CheckpointFunctor {
  StepMonitor<ExecutionSpace> monitor;
  Copy copy;
  Kokkos::View<std::int64_t, typename ExecutionSpace::memory_space> saved_step;
  int parity;             ///< entry of the step counter that holds the completed steps
  std::int64_t launches;  ///< published as `Status::launches`; negative: no publication

  KOKKOS_FUNCTION void operator()(const int i) const {
    const bool failed = monitor.has_failed();
    if (!failed) copy(i);
    if (i != 0) return;
    if (!failed) saved_step() = monitor.steps(parity);
    if (launches < 0) return;
    monitor.status().step = monitor.steps(parity);
    monitor.status().launches = launches;
  }
};

/// First failure of a run, and the step of the last checkpoint before it.
struct FirstFailure {
  std::int64_t step, index;
  std::int64_t checkpoint_step;
};

/// Last saved state of a run: the step that it belongs to. The solver owns the saved arrays.
template <class ExecutionSpace>
class Checkpoint {
 public:
  Checkpoint() : _saved_step("drogue::stepping::checkpoint_step") {}

  /// Enqueues one kernel over `count` indices that calls `copy(i)` for each, unless a failure has been
  /// recorded. It publishes `launches` unless that is negative, for launches that `StepLoop` does not count.
  /// Asynchronous; throws `std::runtime_error` if the launch fails.
  template <class Copy>
  void save(const ExecutionSpace& space, const char* label, const StepMonitor<ExecutionSpace>& monitor,
            int parity, int count, const Copy& copy, std::int64_t launches) const {
    device::launch_each(space, label, count,
                        CheckpointFunctor<ExecutionSpace, Copy>{.monitor = monitor,
                                                                .copy = copy,
                                                                .saved_step = _saved_step,
                                                                .parity = parity,
                                                                .launches = launches});
  }

  /// Waits for all steps. After a failure it calls `restore`, which enqueues the copies of the saved arrays,
  /// and resets `monitor` to the step of the checkpoint. Returns the first failure, if any. Throws
  /// `std::runtime_error` after a failed kernel.
  template <class Restore>
  std::optional<FirstFailure> roll_back_after_failure(const ExecutionSpace& space,
                                                      const StepMonitor<ExecutionSpace>& monitor,
                                                      const Restore& restore) const {
    space.fence("drogue::stepping::roll_back_after_failure");
    if (monitor.status().failed == 0) return std::nullopt;
    std::uint64_t first = no_failure;
    Kokkos::deep_copy(space, first, monitor.first_failure);
    FirstFailure failure{};
    Kokkos::deep_copy(space, failure.checkpoint_step, _saved_step);
    space.fence("drogue::stepping::roll_back_after_failure: copied");
    failure.step = failure_order(first);
    failure.index = failure_index(first);
    restore();
    reset_monitor(space, monitor, failure.checkpoint_step);
    return failure;
  }

 private:
  Kokkos::View<std::int64_t, typename ExecutionSpace::memory_space> _saved_step;
};

}  // namespace drogue::stepping
