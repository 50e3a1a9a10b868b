#include "miniapps/springs/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/program/stopwatch.hpp"
#include "common/scene/node.hpp"
#include "kernels/fabric/contact/features.hpp"
#include "kernels/stepping/expression_steps.hpp"
#include "miniapps/springs/simulation/energy_balance.hpp"

namespace drogue::springs_app {
namespace {

using fabric::Vector;

/// Order of the positions in dt. Impulses of contact, and dashpots in the middle of Verlet's step, are of
/// first order.
std::int64_t order_in_time(const SpringsScene& scene) {
  if (scene.contact.is_enabled()) return 1;
  if (scene.time.integrator == fabric::Integrator::rk4) return 4;
  return scene.damping.relative > 0.0 ? 1 : 2;
}

/// Largest product z of absolute damping and dt. Beyond it, half a kick of Verlet's method, which scales the
/// velocity by (1 - z/4)/(1 + z/4), turns velocities around.
constexpr double turning_damping = 4.0;

/// Steps between two computations of the fastest frequency. Stiffness grows with strain, mostly at the start,
/// and a step that loads overwhelm lasts for a few steps only.
std::int64_t bound_every(std::int64_t step) {
  if (step < 16) return 1;
  if (step < 64) return 4;
  return step < 1024 ? 64 : 512;
}

const char* failure_reason_text(fabric::FailureReason reason) {
  switch (reason) {
    case fabric::FailureReason::crossing:
      return "contact could not prevent an intersection of cloth with itself or a body; a shorter time.dt or "
             "a "
             "finer mesh may help,";
    case fabric::FailureReason::too_fast:
      return "a step moves cloth farther than the search distance of contact; take a shorter time.dt,";
    case fabric::FailureReason::too_dense:
    case fabric::FailureReason::too_many_constraints:
      return "more parts of cloth are in contact at once than its lists can hold; take a shorter time.dt, a "
             "smaller contact.thickness or a coarser mesh,";
    case fabric::FailureReason::no_number:
      return "the expression of a level-set of contact.objects, or its slope, is not a number";
    default:
      return "the state is not finite";
  }
}

}  // namespace

Simulation::Simulation(const SpringsScene& scene, const framework::SimulationSettings& settings)
    : _scene(scene),
      _settings(settings),
      _problem(make_problem(scene)),
      _pressure(pressure_with_potential(scene)) {
  _solver = fabric::create_solver(settings.backend, _problem.parameters);
}

void Simulation::start() {
  {
    const ScopedStopwatch stopwatch(_h2d_s);
    _solver->upload(_problem.to_solver(_problem.x), _problem.to_solver(_problem.v));
  }
  plan();
}

/// Bound of the frequencies, rad/s, as that of the solver, in the time of bounds.
double Simulation::fastest_frequency() {
  const ScopedStopwatch stopwatch(_bound_s);
  return _solver->fastest_frequency();
}

/// Longest stable step, s, for a largest frequency, rad/s.
double Simulation::longest_stable_step(double frequency) {
  return fabric::stable_dt(_scene.time.integrator, frequency, _solver->fastest_decay());
}

/// Reference of automatic steps, s: time.safety is a share of it.
double Simulation::stable_dt() {
  double stable = longest_stable_step(fastest_frequency());
  // Verlet's method is stable at any absolute damping, but resolves damped motion only in steps below
  // 1/damping.
  const double damping = _scene.damping.absolute;
  if (_scene.time.integrator == fabric::Integrator::verlet && damping * stable > 1.0) stable = 1.0 / damping;
  if (!_scene.contact.self) return stable;
  // The search distance of contact grows with the motion per step: a tenth of an edge keeps its lists short.
  std::vector<Vector> x(_problem.x.size()), v(x.size());
  {
    const ScopedStopwatch stopwatch(_d2h_s);
    _solver->download(x, v);
  }
  double fastest = 0.0;
  for (const Vector& velocity : v)
    fastest = std::max(fastest, std::hypot(velocity[0], velocity[1], velocity[2]));
  return std::min(stable, 0.1 * fabric::collision_edges(_problem.parameters.mesh).mean_length / fastest);
}

/// Plans equal steps from now to the next stop, at most as long as is stable or requested.
void Simulation::plan() {
  const auto [step, begin] = now();
  _plan.stop_time = framework::next_stop(_scene.output, begin, _scene.time.end_time);
  _plan.stop_step = step;
  if (_plan.stop_time <= begin) return;
  double longest = _scene.time.dt ? *_scene.time.dt : _scene.time.safety * stable_dt();
  if (!_scene.time.dt)
    for (const std::vector<stepping::MotionInterval>& changes : _scene.changes)
      longest = std::min(longest, stepping::shortest_interval(changes, begin, _plan.stop_time));
  // Round-off of an integer quotient must not add a step.
  const double steps = std::max(1.0, std::ceil((_plan.stop_time - begin) / longest * (1.0 - 1e-12)));
  if (!(steps <= most_steps))
    throw Failure(ExitCode::numerical_failure,
                  "the highest frequency of the mesh requires more than 1e15 steps to t = " +
                      scene::real_text(_plan.stop_time) + " s");
  const double dt = (_plan.stop_time - begin) / steps;
  _plan.stop_step += static_cast<std::int64_t>(steps);
  _solver->set_time_state({step, dt, step, begin});
  _plan.count(dt);
}

/// Shortens the steps where the stable step has shrunk.
void Simulation::replan_if_stiffer() {
  if (_scene.time.dt) return;
  if (_solver->time_state().dt > 1.02 * _scene.time.safety * stable_dt()) plan();
}

/// Explains why the step of the scene is too long; empty if it is not. Beyond the stability limit the motion
/// doubles again and again, and a run may end before a number overflows. The bound of the frequencies lies
/// above the largest frequency: where the bound forbids the step, the largest frequency itself is computed,
/// and again once the bound has grown. Dashpots have a bound only. There the criterion is cloth that moves
/// farther in a step than the extent of the mesh. Cloth in free flight may do so too, but no step is too long
/// for it.
std::string Simulation::too_long_step() {
  const Time& requested = _scene.time;
  if (!requested.dt) return {};
  const double dt = _solver->time_state().dt, bound = fastest_frequency();
  std::ostringstream text;
  if (dt == *requested.dt)
    text << "a step of " << dt << " s is too long: ";
  else
    text << "time.dt = " << *requested.dt << " s, shortened to " << dt
         << " s to meet an output, is too long: ";
  if (requested.integrator == fabric::Integrator::verlet && _scene.damping.absolute * dt > turning_damping) {
    text << "damping.absolute = " << _scene.damping.absolute << " 1/s reverses velocities within a step";
    return text.str();
  }
  if (dt <= longest_stable_step(bound)) return {};
  if (bound > 1.01 * _checked_frequency) {
    _checked_frequency = bound;
    double frequency = 0.0;
    {
      const ScopedStopwatch stopwatch(_bound_s);
      frequency = _solver->frequency_at_least();
    }
    // The computed frequency has the round-off of the differences of forces.
    if (fabric::grows(requested.integrator, dt, (1.0 - 1e-5) * frequency, _scene.damping.absolute,
                      _solver->fastest_decay())) {
      text << "oscillations of the cloth at " << frequency << " rad/s are unstable at step "
           << _solver->time_state().step << ", t = " << time() << " s";
      return text.str();
    }
  }
  const double displacement = std::sqrt(2.0 * _solver->totals().kinetic / _problem.mass) * dt;
  const auto extent = [&](std::size_t axis) {
    const auto [low, high] =
        std::ranges::minmax(_scene.mesh.rest, {}, [axis](const Vector& x) { return x[axis]; });
    return high[axis] - low[axis];
  };
  if (!(displacement > std::hypot(extent(0), extent(1), extent(2)))) return {};
  text << "cloth moves " << displacement
       << " m per step on average, more than the diameter of the mesh at rest";
  return text.str();
}

std::int64_t Simulation::steps_to_event(const framework::AdvanceLimits& limits) const {
  const std::int64_t step = _solver->time_state().step;
  std::int64_t next = _plan.stop_step;
  for (const std::int64_t every : {std::int64_t{limits.row_every}, bound_every(step)})
    if (every > 0) next = std::min(next, (step / every + 1) * every);
  if (limits.pause_step > step) next = std::min(next, limits.pause_step);
  return next - step;
}

/// Copies the state to the host and back.
void Simulation::round_trip() {
  std::vector<double> state;
  {
    const ScopedStopwatch stopwatch(_d2h_s);
    state = _solver->download_state();
  }
  const ScopedStopwatch stopwatch(_h2d_s);
  _solver->upload_state(state);
}

/// Takes steps in batches that adapt to the poll interval. Returns false if the state was lost, or if the
/// poll requested the end before all steps were taken.
bool Simulation::take_steps(std::int64_t steps, const framework::Poll& poll) {
  while (steps > 0) {
    const std::int64_t count = std::min(steps, _settings.baseline ? 1 : _batch.steps());
    const Stopwatch stopwatch;
    const bool advanced = _solver->enqueue_steps(count);
    _failure = _solver->failure();
    const double seconds = stopwatch.seconds();
    _compute_s += seconds;
    if (!advanced || _failure) return false;
    if (_settings.baseline) round_trip();
    _batch.adapt(count, seconds);
    steps -= count;
    const bool go_on = poll(now());
    if (steps > 0 && !go_on) return false;
  }
  return true;
}

framework::StopReason Simulation::advance(const framework::AdvanceLimits& limits,
                                          const framework::RowSink& rows, const framework::Poll& poll) {
  if (!_too_long) _too_long = too_long_step();
  while (_too_long->empty()) {
    if (!poll(now())) return framework::StopReason::interrupted;
    if (!take_steps(steps_to_event(limits), poll)) {
      if (!_failure) return framework::StopReason::interrupted;
      return_to_last_good(_failure->step);
      return framework::StopReason::failed;
    }
    const std::int64_t step = _solver->time_state().step;
    if (limits.row_every > 0 && step % limits.row_every == 0) rows(row());
    if (step == _plan.stop_step) return framework::StopReason::target;
    if (step % bound_every(step) == 0) {
      replan_if_stiffer();
      _too_long = too_long_step();
    }
    if (step == limits.pause_step) return framework::StopReason::pause;
  }
  return framework::StopReason::failed;
}

bool Simulation::plan_next_interval() {
  plan();
  _too_long = too_long_step();
  return _too_long->empty();
}

/// Repeats the valid steps before `lost` from the checkpoint that the solver restored.
void Simulation::return_to_last_good(std::int64_t lost) {
  round_trip();  // an upload clears the failure
  // The start itself may be lost.
  _solver->enqueue_steps(std::max<std::int64_t>(0, lost - 1 - _solver->time_state().step));
  _solver->failure();  // waits
}

std::string Simulation::failure_text(bool restart_written) {
  const std::string step = std::to_string(_solver->time_state().step);
  if (!_failure)
    return *_too_long + "; take a shorter time.dt, or \"auto\"" +
           (restart_written ? "; restart.h5 holds the state of step " + step : "");
  std::ostringstream text;
  text.precision(9);
  const auto vertex = static_cast<std::size_t>(_problem.order.at(static_cast<std::size_t>(_failure->index)));
  const Vector& rest = _scene.mesh.rest[vertex];
  text << failure_reason_text(_failure->reason) << " at vertex " << vertex << " (at rest at " << rest[0]
       << ", " << rest[1] << ", " << rest[2] << " m) at step " << _failure->step
       << ", t = " << _failure->time + _failure->dt << " s";
  if (restart_written) text << "; restart.h5 holds the last good state, of step " << step;
  if (_failure->reason == fabric::FailureReason::not_finite)
    text << (_scene.time.dt
                 ? "; if no expression gives such a number, time.dt = \"auto\" takes a step that is stable"
                 : "; if no expression gives such a number, a smaller time.safety takes shorter steps");
  return text.str();
}

void Simulation::describe(run::ResultDocument& result) {
  result.driver = _settings.baseline ? "seed" : _solver->driver();
  result.metrics.set("order", "time", order_in_time(_scene));
  result.dt_min = _plan.dt_min;
  result.dt_max = _plan.dt_max;
}

run::ResultDocument::WallTimes Simulation::phases() const {
  return {.compute_s = _compute_s, .h2d_s = _h2d_s, .d2h_s = _d2h_s, .bound_s = _bound_s};
}

framework::StepWork Simulation::step_work() const {
  return {"vertex_steps_per_s", static_cast<double>(_scene.mesh.rest.size())};
}

}  // namespace drogue::springs_app
