#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <span>
#include <vector>

#include "common/run/restart/restart_file.hpp"
#include "miniapps/framework/simulation.hpp"

// Steps and restart files of programs that advance a solver of cloth with piecewise constant dt, whose
// `time_state` has `step`, `dt`, `since`, `start` and `time()`.

namespace drogue::framework {

/// Steps with the same dt until a stop.
struct StepPlan {
  std::int64_t stop_step = 0;         ///< step at which they end
  double stop_time = 0.0;             ///< s, then: that of an output or an event bit for bit
  double dt_min = 0.0, dt_max = 0.0;  ///< s, of the steps so far

  /// Step and time in a time state. Does not throw.
  template <class TimeState>
  [[nodiscard]] SimulationTime now(const TimeState& of) const {
    return {of.step, of.step == stop_step ? stop_time : of.time()};
  }
  /// Counts steps of dt, s. Does not throw.
  void count(double dt) {
    dt_min = dt_min > 0.0 ? std::min(dt_min, dt) : dt;
    dt_max = std::max(dt_max, dt);
  }
};

/// Writes the time, the plan and all arrays of the state of a solver. `order(values)`: the values of an array
/// in the order of the file. Throws `Failure` (io_error).
template <class Solver, class Order = std::identity>
void write_restart(run::RestartWriter& writer, Solver& solver, const StepPlan& plan,
                   const Order& order = {}) {
  const auto clock = solver.time_state();
  writer.integer("step", clock.step);
  writer.number("dt", clock.dt);
  writer.integer("since", clock.since);
  writer.number("start", clock.start);
  writer.integer("stop_step", plan.stop_step);
  writer.number("stop_time", plan.stop_time);
  writer.number("dt_min", plan.dt_min);
  writer.number("dt_max", plan.dt_max);
  const std::vector<double> state = solver.download_state();
  std::span<const double> left = state;
  for (const auto& array : solver.state_arrays()) {
    writer.array(array.name, array.size());
    writer.write(array.name, 0, order(left.first(array.size())));
    left = left.subspan(array.size());
  }
}

/// Reads what `write_restart` has written. `order(values)`: the values of an array in the order of the
/// solver. Throws `Failure` (io_error), and std::invalid_argument for a state that is not finite.
template <class Solver, class Order = std::identity>
void read_restart(const run::RestartReader& reader, Solver& solver, StepPlan& plan, const Order& order = {}) {
  const decltype(solver.time_state()) clock = {.step = reader.integer("step"),
                                               .dt = reader.number("dt"),
                                               .since = reader.integer("since"),
                                               .start = reader.number("start")};
  plan = {.stop_step = reader.integer("stop_step"),
          .stop_time = reader.number("stop_time"),
          .dt_min = reader.number("dt_min"),
          .dt_max = reader.number("dt_max")};
  std::vector<double> state;
  for (const auto& array : solver.state_arrays()) {
    std::vector<double> values(array.size());
    reader.read(array.name, 0, values);
    std::ranges::copy(order(std::span<const double>(values)), std::back_inserter(state));
  }
  solver.set_time_state(clock);
  solver.upload_state(state);
}

}  // namespace drogue::framework
