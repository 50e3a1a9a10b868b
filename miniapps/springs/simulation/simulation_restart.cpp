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

RequestedSteps requested_steps(const SpringsScene& scene) {
  return {scene.time.dt.value_or(0.0), scene.time.safety};
}

}  // namespace

void Simulation::write_restart(run::RestartWriter& writer) {
  const auto [dt, safety] = requested_steps(_scene);
  writer.number("asked_dt", dt);
  writer.number("asked_safety", safety);
  framework::write_restart(writer, *_solver, _plan,
                           [&](std::span<const double> values) { return _problem.to_scene(values); });
}

void Simulation::restore(const run::RestartReader& reader) {
  const RequestedSteps requested = {reader.number("asked_dt"), reader.number("asked_safety")};
  framework::read_restart(reader, *_solver, _plan,
                          [&](std::span<const double> values) { return _problem.to_solver(values); });
  if (time() >= _scene.time.end_time) return;
  // New output times, another end or other steps take effect from here on.
  const fabric::TimeState now = _solver->time_state();
  const double next = framework::next_stop(_scene.output, now.time(), _scene.time.end_time);
  if (now.step >= _plan.stop_step || _plan.stop_time != next || requested != requested_steps(_scene)) plan();
}

}  // namespace drogue::springs_app
