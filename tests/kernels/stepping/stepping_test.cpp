#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/device/profiling_counters.hpp"
#include "kernels/stepping/step_launcher.hpp"
#include "kernels/stepping/step_loop.hpp"

// The stepping mechanism with two small solvers: exponential decay with a dt chosen on the device, and growth
// with a constant dt, failure detection and rollback.

namespace drogue::stepping {
namespace {

using Space = DROGUE_TEST_SPACE;
using Memory = Space::memory_space;
using Values = Kokkos::View<double*, Memory>;
using device::HostPinnedSpace;

constexpr int cells = 100;
constexpr double never = std::numeric_limits<double>::max();
constexpr bool on_host = device::is_host<Space>;

std::int64_t launches() {
  static const bool once = (device::start_profiling(), true);
  static_cast<void>(once);
  return device::profiling_counters().kernel_launches;
}

// ---- variable dt ----

/// Control block of the decay solver.
struct DecayControl {
  AdaptiveTime now;
  StepTrial trial;
};
using ControlView = Kokkos::View<DecayControl, Memory>;
using StatusView = StepLoop<Space>::StatusView;
using Outputs = Kokkos::View<AdaptiveTime*, HostPinnedSpace<Space>>;

constexpr std::int64_t max_steps = 1000;
constexpr int output_capacity = 2 * max_launches_in_flight;

KOKKOS_INLINE_FUNCTION void prepare_trial(DecayControl& c) {
  // The steps of this problem grow with time.
  if (!set_dt(c.now, c.trial, 0.01 * (1.0 + c.now.time), 1.0)) c.trial.stop = Stop::failed;
}

struct BeginFunctor {
  ControlView control;
  StatusView status;
  AdvanceRequest request;
  std::int64_t output_step;

  KOKKOS_FUNCTION void operator()(int) const {
    DecayControl& c = control();
    if (begin_advance(c.now, c.trial, request, output_step, max_steps)) prepare_trial(c);
    publish_status(c.now, c.trial, 0, status());
  }
};

struct DecayFunctor {
  Values y;
  ControlView control;

  KOKKOS_FUNCTION void operator()(int i) const {
    if (control().trial.stop == Stop::running) y(i) -= control().trial.dt * y(i);
  }
};

struct FinishFunctor {
  ControlView control;
  StatusView status;

  KOKKOS_FUNCTION void operator()(int) const {
    DecayControl& c = control();
    if (c.trial.stop == Stop::running) {
      advance_time(c.now, c.trial);
      if (continues(c.now, c.trial, max_steps)) prepare_trial(c);
    }
    publish_status(c.now, c.trial, 0, status());
  }
};

struct OutputFunctor {
  ControlView control;
  StatusView status;
  Outputs outputs;
  int every;

  KOKKOS_FUNCTION void operator()(int) const {
    DecayControl& c = control();
    if (every == 0 || output_is_due(c.now, c.trial)) {
      outputs(c.trial.outputs++ % output_capacity) = c.now;
      if (every > 0 && resume_after_output(c.now, c.trial, every)) prepare_trial(c);
    }
    publish_status(c.now, c.trial, 0, status());
  }
};

class Decay {
 public:
  explicit Decay(Driver driver = Driver::automatic) : _loop(_instance), _launcher(_instance, driver) {
    Kokkos::deep_copy(_instance.space(), _y, 1.0);
    DecayControl control{};
    control.trial.stop = Stop::pause;
    Kokkos::deep_copy(_instance.space(), _control, control);
    _instance.space().fence();
  }

  Stop advance(const AdvanceRequest& request, const Poll& poll = {}) {
    return _loop.advance(request, Steps{*this, request.output_every}, poll);
  }
  [[nodiscard]] AdaptiveTime now() const {
    DecayControl control{};
    Kokkos::deep_copy(_instance.space(), control, _control);
    _instance.space().fence();
    return control.now;
  }
  [[nodiscard]] double value() const {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, _y);
    return host(cells - 1);
  }
  [[nodiscard]] Driver driver() const { return _launcher.driver(); }

  std::vector<AdaptiveTime> outputs;
  std::int64_t most_in_flight = 0;

 private:
  struct Steps {
    Decay& s;
    int every;

    void run_one(const char* label, const auto& functor) const {
      Kokkos::parallel_for(label, Kokkos::RangePolicy<Space>(s._instance.space(), 0, 1), functor);
    }
    void begin(const AdvanceRequest& request, std::int64_t output_step) {
      run_one("begin", BeginFunctor{s._control, s._loop.status_view(), request, output_step});
    }
    static bool holds_many_steps(int) { return false; }
    void enqueue(int variant, std::int64_t) {
      s._launcher.launch(variant, [&solver = s](const Space& space) {
        Kokkos::parallel_for("decay", Kokkos::RangePolicy<Space>(space, 0, cells),
                             DecayFunctor{solver._y, solver._control});
        Kokkos::parallel_for("finish", Kokkos::RangePolicy<Space>(space, 0, 1),
                             FinishFunctor{solver._control, solver._loop.status_view()});
      });
      const std::int64_t in_flight = s._loop.launches() + 1 - s._loop.status().launches;
      s.most_in_flight = std::max(s.most_in_flight, in_flight);
    }
    void enqueue_output() {
      run_one("output", OutputFunctor{s._control, s._loop.status_view(), s._ring, every});
    }
    void read_outputs() {
      const std::int64_t written = s._loop.status().outputs;
      while (static_cast<std::int64_t>(s.outputs.size()) < written)
        s.outputs.push_back(s._ring(s.outputs.size() % output_capacity));
    }
    [[nodiscard]] std::int64_t last_output() const { return s.outputs.empty() ? -1 : s.outputs.back().step; }
    void write_output() {
      run_one("output", OutputFunctor{s._control, s._loop.status_view(), s._ring, 0});
      s._loop.count_launch();
      s._instance.space().fence();
      read_outputs();
    }
  };

  device::Instance<Space> _instance{1};
  StepLoop<Space> _loop;
  StepLauncher<Space> _launcher;
  Values _y{"y", cells};
  ControlView _control{"control"};
  Outputs _ring{"outputs", output_capacity};
};

// ctest-label: smoke
TEST(StepLoop, MeetsTargetsExactly) {
  Decay decay;
  for (const double target : {0.1, 0.137, 1.0}) {
    EXPECT_EQ(decay.advance({target}), Stop::target);
    EXPECT_EQ(decay.now().time, target);
  }
  const std::int64_t step = decay.now().step;
  EXPECT_EQ(decay.advance({1.0}), Stop::target);
  EXPECT_EQ(decay.now().step, step);
  EXPECT_NEAR(decay.value(), std::exp(-1.0), 0.01);
}

TEST(StepLoop, StopsAtPauseSteps) {
  Decay decay;
  for (const std::int64_t pause : {1, 2, 50}) {
    EXPECT_EQ(decay.advance({never, pause}), Stop::pause);
    EXPECT_EQ(decay.now().step, pause);
  }
}

TEST(StepLoop, StopsAtTheMaximumNumberOfSteps) {
  Decay decay;
  EXPECT_EQ(decay.advance({never}), Stop::max_steps);
  EXPECT_EQ(decay.now().step, max_steps);
}

TEST(StepLoop, PausesDoNotChangeTheResult) {
  Decay whole, parts;
  EXPECT_EQ(whole.advance({never, 300}), Stop::pause);
  for (const std::int64_t pause : {7, 100, 300}) EXPECT_EQ(parts.advance({never, pause, 9}), Stop::pause);
  EXPECT_EQ(parts.now().time, whole.now().time);
  EXPECT_EQ(parts.value(), whole.value());
}

TEST(StepLoop, WritesOutputsAtMultiplesOfTheInterval) {
  for (const int every : {1, 3, 10}) {
    Decay decay;
    EXPECT_EQ(decay.advance({never, 25, every}), Stop::pause);
    EXPECT_EQ(decay.advance({never, 60, every}), Stop::pause);
    ASSERT_EQ(decay.outputs.size(), static_cast<std::size_t>(60 / every));
    for (std::size_t k = 0; k < decay.outputs.size(); ++k)
      EXPECT_EQ(decay.outputs[k].step, static_cast<std::int64_t>(k + 1) * every);
  }
}

TEST(StepLoop, PollInterruptsBetweenSteps) {
  Decay decay;
  EXPECT_EQ(decay.advance({never, 900}, [](const Status&) { return false; }), Stop::interrupted);
  EXPECT_EQ(decay.now().step, 0);
  if (on_host) {
    EXPECT_EQ(decay.advance({never, 900}, [](const Status& status) { return status.step < 30; }),
              Stop::interrupted);
    EXPECT_EQ(decay.now().step, 30);
  }
}

TEST(StepLoop, BoundsTheLaunchesInFlight) {
  Decay decay;
  decay.advance({never, 1000});
  EXPECT_LE(decay.most_in_flight, on_host ? 1 : max_launches_in_flight);
}

TEST(StepLoop, LaunchesEachStepOnce) {
  Decay decay;
  decay.advance({never, 10});
  const std::int64_t before = launches();
  decay.advance({never, 510});
  const std::int64_t per_step = decay.driver() == Driver::graph ? 1 : 2;
  const std::int64_t expected = 500 * per_step + 1;
  EXPECT_GE(launches() - before, expected);
  EXPECT_LE(launches() - before, expected + (on_host ? 0 : max_launches_in_flight));
}

// ---- constant dt ----

constexpr std::int64_t checkpoint_every = 16;

struct GrowthFunctor {
  Values y;
  StepMonitor<Space> monitor;
  int parity;

  KOKKOS_FUNCTION void operator()(int i) const {
    const std::int64_t step = monitor.steps(parity) + 1;
    y(i) *= i % 10 == 7 ? 2.0 : 1.5;
    if (!(y(i) < 1e30)) monitor.record_failure(step, i);
    if (i == 0) monitor.steps(1 - parity) = step;
  }
};

struct CopyFunctor {
  Values from, to;
  KOKKOS_FUNCTION void operator()(int i) const { to(i) = from(i); }
};

/// Growth by a constant factor per step, which exceeds its limit at step 100.
class Growth {
 public:
  Growth() : _loop(_instance), _monitor(make_monitor<Space>(_loop.status_view())) {
    Kokkos::deep_copy(_instance.space(), _y, 1.0);
    reset_monitor(_instance.space(), _monitor, 0);
    Steps{*this}.checkpoint(0);
  }

  bool enqueue_steps(std::int64_t count) {
    return _loop.enqueue_steps(_step, count, checkpoint_every, Steps{*this});
  }
  std::optional<FirstFailure> synchronize() {
    const auto failure = _checkpoint.roll_back_after_failure(
        _instance.space(), _monitor, [this] { Kokkos::deep_copy(_instance.space(), _y, _saved); });
    if (failure) {
      _parity = 0;
      _step = failure->checkpoint_step;
    }
    return failure;
  }
  /// Captures two steps into a graph that is not launched.
  void capture() {
    const device::CapturedGraph<Space> unused(_instance, [this](const Space&) { enqueue_steps(2); });
  }
  /// Ends the effect of captures on the loop.
  void forget_captures() {
    _loop.forget_captures();
    _step = device_step();
  }
  [[nodiscard]] std::int64_t enqueued_launches() const { return _loop.launches(); }
  [[nodiscard]] std::int64_t published_launches() const { return _loop.status().launches; }
  [[nodiscard]] std::vector<double> values() const {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, _y);
    return {host.data(), host.data() + cells};
  }
  [[nodiscard]] std::int64_t step() const { return _step; }
  [[nodiscard]] std::int64_t device_step() const {
    return completed_steps(_instance.space(), _monitor, _parity);
  }

 private:
  struct Steps {
    Growth& s;
    void enqueue(std::int64_t count) const {
      for (std::int64_t k = 0; k < count; ++k, s._parity = 1 - s._parity)
        Kokkos::parallel_for("growth", Kokkos::RangePolicy<Space>(s._instance.space(), 0, cells),
                             GrowthFunctor{s._y, s._monitor, s._parity});
    }
    void checkpoint(std::int64_t launches_so_far) const {
      s._checkpoint.save(s._instance.space(), "checkpoint", s._monitor, s._parity, cells,
                         CopyFunctor{s._y, s._saved}, launches_so_far);
    }
  };

  device::Instance<Space> _instance{1};
  StepLoop<Space> _loop;
  StepMonitor<Space> _monitor;
  Checkpoint<Space> _checkpoint;
  Values _y{"y", cells}, _saved{"saved", cells};
  std::int64_t _step = 0;
  int _parity = 0;
};

TEST(StepMonitor, CountsStepsWithoutFailure) {
  Growth growth;
  EXPECT_TRUE(growth.enqueue_steps(7));
  EXPECT_TRUE(growth.enqueue_steps(60));
  EXPECT_FALSE(growth.synchronize().has_value());
  EXPECT_EQ(growth.step(), 67);
  EXPECT_EQ(growth.device_step(), 67);
  EXPECT_EQ(growth.values()[7], std::ldexp(1.0, 67));
}

TEST(StepMonitor, ReportsTheFirstFailureAndReturnsToTheLastCheckpoint) {
  Growth growth, whole;
  growth.enqueue_steps(90);
  growth.enqueue_steps(200);
  const auto failure = growth.synchronize();
  ASSERT_TRUE(failure.has_value());
  EXPECT_EQ(failure->step, 100);
  EXPECT_EQ(failure->index, 7);
  EXPECT_EQ(failure->checkpoint_step, 96);
  EXPECT_EQ(growth.step(), 96);
  whole.enqueue_steps(96);
  EXPECT_EQ(growth.values(), whole.values());
  EXPECT_FALSE(growth.synchronize().has_value());
  // The steps before the failed one can be repeated.
  EXPECT_EQ(growth.device_step(), 96);
  EXPECT_TRUE(growth.enqueue_steps(3));
  EXPECT_FALSE(growth.synchronize().has_value());
  whole.enqueue_steps(3);
  EXPECT_EQ(growth.values(), whole.values());
}

TEST(StepMonitor, EnqueuesNothingAfterAFailure) {
  Growth growth;
  growth.enqueue_steps(110);
  Kokkos::fence();
  const std::int64_t step = growth.step();
  EXPECT_FALSE(growth.enqueue_steps(50));
  EXPECT_EQ(growth.step(), step);
}

TEST(StepMonitor, PublishesBatchesAfterACapture) {
  Growth growth;
  growth.capture();
  EXPECT_TRUE(growth.enqueue_steps(50));
  EXPECT_TRUE(growth.enqueue_steps(14));
  EXPECT_FALSE(growth.synchronize());
  EXPECT_EQ(growth.device_step(), 64);
  EXPECT_EQ(growth.enqueued_launches(), 64 / checkpoint_every);
  EXPECT_EQ(growth.published_launches(), growth.enqueued_launches());
}

TEST(StepMonitor, TakesCheckpointsAgainAfterCapturesAreForgotten) {
  Growth growth;
  growth.capture();
  growth.enqueue_steps(20);
  growth.forget_captures();
  EXPECT_EQ(growth.step(), 20);
  growth.enqueue_steps(100);
  const auto failure = growth.synchronize();
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->step, 100);
  EXPECT_EQ(failure->checkpoint_step, 96);
}

TEST(StepMonitor, FailuresAreOrderedByStepThenIndex) {
  EXPECT_LT(encode_failure(3, 500), encode_failure(4, 0));
  EXPECT_LT(encode_failure(4, 0), encode_failure(4, 1));
  const std::uint64_t failure = encode_failure(123'456'789, 987'654);
  EXPECT_EQ(failure_order(failure), 123'456'789);
  EXPECT_EQ(failure_index(failure), 987'654);
  EXPECT_LT(failure, no_failure);
}

TEST(TimeState, IsReproducedByARestart) {
  const TimeState time{1000, 0.1, 990, 7.5};
  EXPECT_EQ(time.time(), 7.5 + 10 * 0.1);
}

// ---- drivers ----

TEST(Driver, FallsBackFromPersistentToGraphToPlain) {
  EXPECT_EQ(select_driver(Driver::automatic, true, true), Driver::persistent);
  EXPECT_EQ(select_driver(Driver::automatic, false, true), Driver::graph);
  EXPECT_EQ(select_driver(Driver::automatic, false, false), Driver::plain);
  EXPECT_EQ(select_driver(Driver::persistent, false, true), Driver::graph);
  EXPECT_EQ(select_driver(Driver::graph, true, true), Driver::graph);
  EXPECT_EQ(select_driver(Driver::graph, true, false), Driver::plain);
  EXPECT_EQ(select_driver(Driver::plain, true, true), Driver::plain);
  EXPECT_EQ(select_driver(Driver::stages, true, true), Driver::stages);
}

struct AddOneFunctor {
  Values y;
  KOKKOS_FUNCTION void operator()(int i) const { y(i) += 1.0; }
};

TEST(CapturedGraph, LeavesItsInstanceUsableAfterAnError) {
  const device::Instance<Space> instance(1);
  const Values y("y", cells);
  const auto add_one = [&](const Space& space) {
    device::launch_each(space, "add one", cells, AddOneFunctor{y});
  };
  const auto launch_throwing = [&] {
    const device::CapturedGraph<Space> graph(instance, [](const Space&) { throw std::logic_error("test"); });
    graph.launch();
  };
  EXPECT_THROW(launch_throwing(), std::logic_error);
  add_one(instance.space());
  const device::CapturedGraph<Space> graph(instance, add_one);
  graph.launch();
  instance.space().fence();
  EXPECT_EQ(Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, y)(cells - 1), 2.0);
}

TEST(Driver, DriversGiveTheSameBits) {
  Decay plain(Driver::plain), graph(Driver::graph);
  plain.advance({0.7});
  graph.advance({0.7});
  EXPECT_EQ(plain.now().step, graph.now().step);
  EXPECT_EQ(plain.value(), graph.value());
  EXPECT_EQ(plain.driver(), Driver::plain);
  EXPECT_EQ(graph.driver(), on_host ? Driver::plain : Driver::graph);
}

}  // namespace
}  // namespace drogue::stepping
