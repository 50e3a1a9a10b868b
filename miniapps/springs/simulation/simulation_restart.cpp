#include <algorithm>
#include <iterator>
#include <span>

#include "miniapps/springs/simulation/simulation.hpp"

namespace drogue::springs_app {
namespace {

/// Step lengths that a scene requests; they may change between a run and its continuation.
struct RequestedSteps {
  double dt = 0.0;  ///< s; 0: from stability
  double safety = 0.0;
  bool operator==(const RequestedSteps&) const = default;
};

/// Steps in progress when a restart file is written.
struct PlanState {
  fabric::TimeState clock;
  std::int64_t stop_step = 0;         ///< step at which the run reaches `stop_time`
  double stop_time = 0.0;             ///< s
  double dt_min = 0.0, dt_max = 0.0;  ///< s, of the steps so far
  RequestedSteps requested;           ///< by the scene that took them
};

/// Visits every scalar entry of a restart file. `number` and `integer` write or read one entry.
template <class State, class Number, class Integer>
void visit(State& state, const Number& number, const Integer& integer) {
  integer("step", state.clock.step);
  number("dt", state.clock.dt);
  integer("since", state.clock.since);
  number("start", state.clock.start);
  integer("stop_step", state.stop_step);
  number("stop_time", state.stop_time);
  number("dt_min", state.dt_min);
  number("dt_max", state.dt_max);
  number("asked_dt", state.requested.dt);
  number("asked_safety", state.requested.safety);
}

RequestedSteps requested_steps(const SpringsScene& scene) {
  return {scene.time.dt.value_or(0.0), scene.time.safety};
}

}  // namespace

void Simulation::write_restart(run::RestartWriter& writer) {
  PlanState plan{.clock = _solver->time_state(),
                 .stop_step = _stop_step,
                 .stop_time = _stop_time,
                 .dt_min = _dt_min,
                 .dt_max = _dt_max,
                 .requested = requested_steps(_scene)};
  visit(
      plan, [&](const std::string& name, double value) { writer.number(name, value); },
      [&](const std::string& name, std::int64_t value) { writer.integer(name, value); });
  const std::vector<double> state = _solver->download_state();
  std::span<const double> left = state;
  for (const stepping::StateArray& array : _solver->state_arrays()) {
    writer.array(array.name, array.size());
    writer.write(array.name, 0, _problem.to_scene(left.first(array.size())));
    left = left.subspan(array.size());
  }
}

void Simulation::restore(const run::RestartReader& reader) {
  PlanState plan;
  visit(
      plan, [&](const std::string& name, double& value) { value = reader.number(name); },
      [&](const std::string& name, std::int64_t& value) { value = reader.integer(name); });
  std::vector<double> state;
  for (const stepping::StateArray& array : _solver->state_arrays()) {
    std::vector<double> values(array.size());
    reader.read(array.name, 0, values);
    std::ranges::copy(_problem.to_solver(std::span<const double>(values)), std::back_inserter(state));
  }
  _solver->set_time_state(plan.clock);
  _solver->upload_state(state);
  _stop_step = plan.stop_step;
  _stop_time = plan.stop_time;
  _dt_min = plan.dt_min;
  _dt_max = plan.dt_max;
  if (time() >= _scene.time.end_time) return;
  // New output times, another end or other steps take effect from here on.
  const double next = framework::next_stop(_scene.output, plan.clock.time(), _scene.time.end_time);
  if (plan.clock.step >= _stop_step || _stop_time != next || plan.requested != requested_steps(_scene))
    this->plan();
}

}  // namespace drogue::springs_app
