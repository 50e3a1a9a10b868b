#include <span>

#include "miniapps/springs/simulation/simulation.hpp"
#include "miniapps/springs/vectors.hpp"

namespace drogue::springs_app {
namespace {

using fabric::Vector;

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

/// Contact work and displacement kicks of every vertex. The work has the names of its columns in history.csv.
constexpr std::pair<const char*, double fabric::ContactWork::*> work_parts[] = {
    {"contact_work", &fabric::ContactWork::normal},
    {"friction_work", &fabric::ContactWork::friction},
    {"contact_kick_x", &fabric::ContactWork::kick_x},
    {"contact_kick_y", &fabric::ContactWork::kick_y},
    {"contact_kick_z", &fabric::ContactWork::kick_z}};

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
  std::vector<Vector> x(_problem.x.size()), v(x.size());
  _solver->download(x, v);
  for (const auto& [name, vectors] : {std::pair{"position", &x}, std::pair{"velocity", &v}}) {
    writer.array(name, 3 * vectors->size());
    writer.write(name, 0, numbers(_problem.to_scene(*vectors)));
  }
  if (!_scene.contact.is_enabled()) return;
  std::vector<fabric::ContactWork> work(x.size());
  _solver->contact_work(work);
  work = _problem.to_scene(std::span<const fabric::ContactWork>(work));
  for (const auto& [name, part] : work_parts) {
    std::vector<double> values;
    for (const fabric::ContactWork& each : work) values.push_back(each.*part);
    writer.array(name, values.size());
    writer.write(name, 0, values);
  }
}

void Simulation::restore(const run::RestartReader& reader) {
  PlanState plan;
  visit(
      plan, [&](const std::string& name, double& value) { value = reader.number(name); },
      [&](const std::string& name, std::int64_t& value) { value = reader.integer(name); });
  std::vector<Vector> x(_scene.mesh.rest.size()), v(x.size());
  reader.read("position", 0, numbers(x));
  reader.read("velocity", 0, numbers(v));
  _solver->set_time_state(plan.clock);
  _solver->upload(_problem.to_solver(x), _problem.to_solver(v));
  if (_scene.contact.is_enabled()) {
    std::vector<fabric::ContactWork> work(x.size());
    for (const auto& [name, part] : work_parts) {
      std::vector<double> values(work.size());
      reader.read(name, 0, values);
      for (std::size_t i = 0; i < values.size(); ++i) work[i].*part = values[i];
    }
    _solver->set_contact_work(_problem.to_solver(std::span<const fabric::ContactWork>(work)));
  }
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
