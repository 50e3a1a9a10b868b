#pragma once

#include <cstdint>
#include <functional>

namespace drogue::stepping {

/// Maximum number of launches in flight. A ring of outputs on the device needs twice as many entries.
inline constexpr std::int64_t max_launches_in_flight = 512;

/// Default number of steps between checkpoints of a run with constant dt.
inline constexpr std::int64_t checkpoint_interval = 256;

/// Reason why an advance ended.
enum class Stop : int { running, target, pause, max_steps, failed, interrupted };

/// Time, step number and steps of a run with variable dt.
struct AdaptiveTime {
  double time = 0.0;  ///< s
  std::int64_t step = 0;
  double last_dt = 0.0;               ///< s, of the last step; 0: the next step has no predecessor
  double dt_min = 0.0, dt_max = 0.0;  ///< s, over all steps
};

/// Time and step number of a run with piecewise constant dt. A restart that restores all members reproduces
/// the times bit for bit.
struct TimeState {
  std::int64_t step = 0;   ///< steps completed
  double dt = 0.0;         ///< s
  std::int64_t since = 0;  ///< first step with this dt
  double start = 0.0;      ///< s, time of step `since`

  /// Time of the present step, s. Does not throw.
  [[nodiscard]] double time() const { return start + static_cast<double>(step - since) * dt; }
};

/// First failed step of a run. `Reason` is an enumeration of the solver.
template <class Reason>
struct StepFailure {
  Reason reason{};
  std::int64_t index = -1;  ///< cell or vertex; -1: the whole step
  std::int64_t step = 0;    ///< number of the failed step, counted from 1
  double time = 0.0;        ///< s, start of the failed step
  double dt = 0.0;          ///< s
};

/// Progress that kernels publish in pinned host memory. The host reads it without a copy or fence, each
/// member by itself, while kernels change it.
struct Status {
  std::int64_t launches = 0;  ///< launches that have published a status, including those without work
  std::int64_t step = 0;
  double time = 0.0;  ///< s
  double dt = 0.0;    ///< s, of the next step
  int variant = 0;    ///< variant of the step that the next launch must run
  Stop stop = Stop::running;
  std::int64_t outputs = 0;  ///< outputs written by kernels
  int failed = 0;            ///< 1 after `StepMonitor::record_failure`
};

/// Callback that a step loop calls a few times per second. Returning false ends the loop after the steps in
/// flight.
using Poll = std::function<bool(const Status&)>;

}  // namespace drogue::stepping
