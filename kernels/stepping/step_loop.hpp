#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <concepts>
#include <thread>

#include "kernels/device/captured_graph.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/stepping/step_control.hpp"
#include "kernels/stepping/step_monitor.hpp"

// Host side of time stepping. Kernels decide on dt, acceptance and stops (step_control.hpp) or record
// failures (step_monitor.hpp); the host keeps a bounded number of launches in flight and reads a pinned
// status.
//
// A new solver with a variable dt:
//
//   struct Steps {                                     // adaptor that StepLoop::advance calls
//     MySolver& s;
//     void begin(const AdvanceRequest& r, std::int64_t output_step) {      // kernel of one thread:
//       s.launch_one_thread(BeginFunctor{s._control, s._loop.status_view(), r, output_step});
//     }                                                // begin_advance, set_dt, publish_status
//     bool holds_many_steps(int) { return s._launcher.is_persistent(); }
//     void enqueue(int variant, std::int64_t max_steps) {                  // asynchronous
//       if (s._launcher.is_persistent()) return s.launch_persistent(max_steps);
//       s._launcher.launch(variant, [this](const auto& space) { s.enqueue_step(space); });
//     }                                                // last kernel: advance_time, continues, set_dt,
//   };                                                 // publish_status
//
//   Stop MySolver::advance(double target, const Poll& poll) {
//     return _loop.advance({target}, Steps{*this}, poll);
//   }
//
// Members: device::Instance, StepLoop<ExecutionSpace> _loop{_instance}, StepLauncher<ExecutionSpace>
// _launcher. A kernel that finds a bad cell calls StepMonitor::record_failure; the last kernel then sets
// StepTrial::stop = Stop::failed, and the solver returns to its Checkpoint.
//
// A new solver with a constant dt, which takes no decisions on the device:
//
//   struct Steps {                                     // adaptor that StepLoop::enqueue_steps calls
//     MySolver& s;
//     void enqueue(std::int64_t count) {                                   // asynchronous
//       if (s._launcher.is_persistent()) return s.launch_persistent(count);
//       // The kernels of a step count it in StepMonitor::steps.
//       for (std::int64_t k = 0; k < count; ++k)
//         s._launcher.launch(0, [this](const auto& space) { s.enqueue_step(space); });
//     }
//     void checkpoint(std::int64_t launches) {
//       const CopyFunctor copy{s._u, s._saved};
//       s._checkpoint.save(s.space(), "save", s._monitor, 0, s.cells(), copy, launches);
//     }
//   };
//
//   bool MySolver::enqueue_steps(std::int64_t count) {                   // false after a failure
//     return _loop.enqueue_steps(_time.step, count, checkpoint_interval, Steps{*this});
//   }
//   void MySolver::synchronize() {                                       // blocks
//     const auto failure = _checkpoint.roll_back_after_failure(space(), _monitor, [&] { copy(_u, _saved); });
//     if (failure) _time.step = failure->checkpoint_step;
//   }
//
// Members: as above, StepMonitor<ExecutionSpace> _monitor = make_monitor(_loop.status_view()), Checkpoint
// _checkpoint and TimeState _time. A kernel that finds a bad cell calls StepMonitor::record_failure.

namespace drogue::stepping {

/// Work in flight, s: bounds the delay of progress, interrupts and failures.
inline constexpr double seconds_in_flight = 0.1;

/// Solver as `StepLoop::advance` uses it. `begin` and `enqueue` enqueue one launch each that publishes one
/// status. A launch takes one step, or up to `max_steps` if `holds_many_steps(variant)`.
template <class T>
concept AdaptiveSteps = requires(T steps, const AdvanceRequest& request, int variant, std::int64_t count) {
  steps.begin(request, count);
  steps.enqueue(variant, count);
  { steps.holds_many_steps(variant) } -> std::convertible_to<bool>;
};

/// Solver with outputs on the device. `enqueue_output` enqueues one launch that writes the output that is due
/// and publishes one status. `read_outputs` reads the outputs written so far, `last_output` the step of the
/// last one (-1: none), and `write_output` writes the present state and blocks.
template <class T>
concept StepsWithOutputs = AdaptiveSteps<T> && requires(T steps) {
  steps.enqueue_output();
  steps.read_outputs();
  steps.write_output();
  { steps.last_output() } -> std::convertible_to<std::int64_t>;
};

/// Solver on several ranks. `complete_launches` enqueues launches until all ranks have enqueued equally many.
template <class T>
concept SharedSteps = AdaptiveSteps<T> && requires(T steps) {
  steps.complete_launches();
};

/// Solver as `StepLoop::enqueue_steps` uses it. `enqueue` enqueues that many steps. `checkpoint` enqueues
/// `Checkpoint::save` and publishes `launches`.
template <class T>
concept UniformSteps = requires(T steps, std::int64_t count) {
  steps.enqueue(count);
  steps.checkpoint(count);
};

/// Kernel of one thread that publishes the number of launches, for batches without a checkpoint.
template <class StatusView>
struct PublishLaunchesFunctor {
  StatusView status;
  std::int64_t launches;

  KOKKOS_FUNCTION void operator()(int /*i*/) const { status().launches = launches; }
};

/// Host loop over the steps of one solver on its execution-space instance.
template <class ExecutionSpace>
class StepLoop {
 public:
  using StatusView = typename StepMonitor<ExecutionSpace>::StatusView;
  static constexpr bool on_host = device::is_host<ExecutionSpace>;

  /// `instance` must outlive the loop. Throws `std::runtime_error` if pinned memory runs out.
  explicit StepLoop(const device::Instance<ExecutionSpace>& instance)
      : _instance(&instance), _status("drogue::stepping::status") {}

  /// Status in pinned host memory, for kernels. Does not throw.
  [[nodiscard]] const StatusView& status_view() const { return _status; }

  /// Status as last published. Does not wait and does not throw.
  [[nodiscard]] Status status() const {
    // The device writes this memory asynchronously, hence volatile.
    const volatile Status& s = _status();
    Status seen;
    seen.launches = s.launches;
    seen.step = s.step;
    seen.time = s.time;
    seen.dt = s.dt;
    seen.variant = s.variant;
    seen.stop = s.stop;
    seen.outputs = s.outputs;
    seen.failed = s.failed;
    return seen;
  }

  /// Launches enqueued that publish a status. A solver that rewrites its control block stores this number in
  /// `StepTrial::launches`. Does not throw.
  [[nodiscard]] std::int64_t launches() const { return _launches; }

  /// True in calls of `enqueue_steps` whose launches the caller captures. Does not throw.
  [[nodiscard]] bool is_capturing() const { return _capturing; }

  /// True once the caller has captured steps, so that only the device counts them. Does not throw.
  [[nodiscard]] bool has_captured_steps() const { return _captured; }

  /// Declares that no captured steps will be launched again, and that the caller has set its number of steps
  /// to that of the device. Does not throw.
  void forget_captures() {
    _captured = false;
    _steps_since_capture = 0;
  }

  /// Counts a status-publishing launch outside of the loop. Does not throw.
  void count_launch() { ++_launches; }

  /// Steps until the device stops or `poll` returns false, then blocks until the last launch has ended.
  /// Throws only what `steps`, `poll` or a failed kernel throw.
  template <AdaptiveSteps Steps>
  Stop advance(const AdvanceRequest& request, Steps&& steps, const Poll& poll) {
    const ExecutionSpace& space = _instance->space();
    const int every = StepsWithOutputs<Steps> ? request.output_every : 0;
    const auto read_outputs = [&] {
      if constexpr (StepsWithOutputs<Steps>) steps.read_outputs();
    };
    const auto lacks_output = [&](const Status& now) {
      if constexpr (StepsWithOutputs<Steps>)
        return every > 0 && now.step % every == 0 && steps.last_output() != now.step;
      return false;
    };
    // The first poll precedes the loop because a short advance may end before the next time-based poll.
    if (poll && !poll(status())) return Stop::interrupted;
    const std::int64_t first_step = status().step;
    steps.begin(request, every > 0 ? (first_step / every + 1) * every : -1);
    count_launch();
    space.fence("drogue::stepping::advance: begun");

    std::int64_t since_output = every > 0 ? first_step % every : 0;
    std::int64_t window = on_host ? 1 : 8;
    std::int64_t steps_per_launch = 1024;  // of a launch that holds many steps
    const auto begin = SteadyTime::now();
    auto last_poll = begin;
    bool interrupted = false;
    while (true) {
      const Status now = status();
      read_outputs();
      const bool output_due = now.stop == Stop::pause && lacks_output(now);
      if (now.stop != Stop::running && !output_due) {
        if (now.stop != Stop::pause || now.step == request.pause_step) break;
      }
      const auto clock = SteadyTime::now();
      if (seconds(clock - last_poll) > 0.02 || on_host) {
        last_poll = clock;
        if (poll && !poll(now)) {
          interrupted = true;
          break;
        }
        const double rate = per_second(now.step - first_step, clock - begin);
        if (!on_host) window = launches_in_flight(rate);
        steps_per_launch =
            std::max<std::int64_t>(static_cast<std::int64_t>(0.5 * seconds_in_flight * rate), 64);
      }
      const std::int64_t in_flight = _launches - now.launches;
      const bool many_steps = steps.holds_many_steps(now.variant);
      const std::int64_t left = estimated_steps_left(now, request);
      // An output step ends a launch with many steps; another launch must follow.
      const std::int64_t useful = !many_steps ? std::min(window, left + (every > 0 ? left / every + 1 : 0))
                                  : every > 0 ? 2
                                              : std::min<std::int64_t>(2, (left - 1) / steps_per_launch + 1);
      if (in_flight >= useful) {
        std::this_thread::yield();
        continue;
      }
      bool is_output = false;
      if constexpr (StepsWithOutputs<Steps>) {
        is_output = every > 0 && (since_output >= every || (in_flight == 0 && output_due));
        if (is_output) steps.enqueue_output();
      }
      if (is_output) {
        since_output = 0;
      } else {
        steps.enqueue(now.variant, steps_per_launch);
        since_output += many_steps ? steps_per_launch : 1;
      }
      count_launch();
    }
    if constexpr (SharedSteps<Steps>) steps.complete_launches();
    space.fence("drogue::stepping::advance: stopped");
    const Status last = status();
    read_outputs();
    if constexpr (StepsWithOutputs<Steps>)
      if (last.step > first_step && lacks_output(last)) steps.write_output();
    const bool between_stops =
        last.stop == Stop::running || (last.stop == Stop::pause && last.step != request.pause_step);
    return interrupted && between_stops ? Stop::interrupted : last.stop;
  }

  /// Enqueues `count` steps from step `step` on in batches that end at multiples of `checkpoint_every`, each
  /// with a checkpoint. Asynchronous but for the bound on the batches in flight. Returns false after a
  /// recorded failure; sets `step` to the number of steps enqueued. Throws only what `steps` or a failed
  /// launch throw.
  ///
  /// It may be called while the caller captures the instance's stream into a graph. From then on only the
  /// device counts steps (`completed_steps`), which `step` leaves out, and the loop takes no checkpoints; see
  /// `forget_captures`. Batches that are not captured stay bounded. Launches of the graph are not.
  template <UniformSteps Steps>
  bool enqueue_steps(std::int64_t& step, std::int64_t count, std::int64_t checkpoint_every, Steps&& steps) {
    _capturing = device::is_capturing(_instance->space());
    _captured = _captured || _capturing;
    if (_capturing) {
      for (std::int64_t left = count; left > 0; left -= checkpoint_every)
        steps.enqueue(std::min(left, checkpoint_every));
      return true;
    }
    std::int64_t& enqueued = _captured ? _steps_since_capture : step;
    const std::int64_t first_launch = status().launches, end = enqueued + count;
    const auto begin = SteadyTime::now();
    while (enqueued < end) {
      const Status now = status();
      if (now.failed != 0) return false;
      // Each batch publishes one launch. Steps of a captured graph do not count.
      const double rate = per_second(now.launches - first_launch, SteadyTime::now() - begin);
      if (_launches - now.launches >= launches_in_flight(rate)) {
        std::this_thread::yield();
        continue;
      }
      const std::int64_t batch = std::min(end - enqueued, checkpoint_every - enqueued % checkpoint_every);
      steps.enqueue(batch);
      enqueued += batch;
      if (enqueued % checkpoint_every != 0) continue;
      count_launch();
      if (_captured)
        device::launch_each(_instance->space(), "drogue::stepping::publish_launches", 1,
                            PublishLaunchesFunctor<StatusView>{_status, _launches});
      else
        steps.checkpoint(_launches);
    }
    return status().failed == 0;
  }

 private:
  using SteadyTime = std::chrono::steady_clock;
  static double seconds(SteadyTime::duration span) { return std::chrono::duration<double>(span).count(); }
  static double per_second(std::int64_t count, SteadyTime::duration span) {
    return span.count() > 0 ? static_cast<double>(count) / seconds(span) : 0.0;
  }

  /// Bound on the launches in flight where a device completes `rate` of them per second.
  static std::int64_t launches_in_flight(double rate) {
    return static_cast<std::int64_t>(
        std::clamp(seconds_in_flight * rate, 8.0, static_cast<double>(max_launches_in_flight)));
  }

  /// Estimated number of steps, at least one, to the end of the request. Launches beyond it would find no
  /// work.
  static std::int64_t estimated_steps_left(const Status& now, const AdvanceRequest& request) {
    double steps = std::ceil((request.target - now.time) / now.dt);
    if (request.pause_step > now.step)
      steps = std::min(steps, static_cast<double>(request.pause_step - now.step));
    if (!(steps < 1e12)) return 1'000'000'000'000;
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(steps));
  }

  const device::Instance<ExecutionSpace>* _instance;
  StatusView _status;
  std::int64_t _launches = 0;
  bool _capturing = false, _captured = false;
  std::int64_t _steps_since_capture = 0;  ///< enqueued outside of captures
};

}  // namespace drogue::stepping
