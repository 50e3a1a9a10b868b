#include "miniapps/springs/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "common/program/signals.hpp"
#include "common/run/restart_file.hpp"
#include "common/scene/node.hpp"
#include "kernels/device/profiling_counters.hpp"
#include "kernels/device/runtime.hpp"
#include "kernels/fabric/contact/features.hpp"

namespace drogue::springs_app {
namespace {

using fabric::Vector;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Absolute damping times dt, z, beyond which half a kick of Verlet's method turns a velocity round, of which
/// it leaves (1 - z/4)/(1 + z/4).
constexpr double turning_damping = 4.0;

/// Device time after which the host looks whether a signal came.
constexpr double look_every_s = 0.1;

/// Steps from one look at the fastest frequency to the next: stiffness grows with strain, mostly at the
/// start, where a step that loads overwhelm lasts for few.
std::int64_t bound_every(std::int64_t step) {
  if (step < 16) return 1;
  if (step < 64) return 4;
  return step < 1024 ? 64 : 512;
}

const char* lost_text(fabric::FailureReason reason) {
  switch (reason) {
    case fabric::FailureReason::crossing:
      return "parts of cloth, or cloth and a body, cross whatever contact does; a shorter time.dt or a finer "
             "mesh may help,";
    case fabric::FailureReason::too_fast:
      return "a step moves cloth farther than contact looks; take a shorter time.dt,";
    case fabric::FailureReason::too_dense:
      return "more parts of cloth are near one another than contact has room for; take a shorter time.dt, a "
             "smaller contact.thickness or a coarser mesh,";
    case fabric::FailureReason::no_number:
      return "the expression of a level-set of contact.objects, or its slope, is not a number";
    default:
      return "the state is not finite";
  }
}

}  // namespace

Simulation::Simulation(const SpringsScene& scene, const RunSettings& settings)
    : _scene(scene), _settings(settings), _problem(make_problem(scene)) {
  const auto begin = Clock::now();
  _solver = fabric::create_solver(settings.backend, _problem.parameters);
  if (settings.restart.empty()) {
    const auto upload = Clock::now();
    _solver->upload(_problem.to_solver(_problem.x), _problem.to_solver(_problem.v));
    _h2d_s = seconds_since(upload);
    plan();
  } else {
    resume();
  }
  _setup_s = seconds_since(begin);
}

void Simulation::resume() {
  const RestartState state = read_restart(_settings.restart, _scene);
  _solver->set_time_state(state.clock);
  _solver->upload(_problem.to_solver(state.x), _problem.to_solver(state.v));
  if (_scene.contact.asked_for())
    _solver->set_contact_work(_problem.to_solver(std::span<const fabric::ContactWork>(state.contact_work)));
  _stop_step = state.stop_step;
  _stop_time = state.stop_time;
  run::require_not_after(_settings.restart, time(), "time.end_time", _scene.time.end_time);
  _dt_min = state.dt_min;
  _dt_max = state.dt_max;
  // Other outputs than before, another end or other steps: from here on they are met.
  if (state.clock.step >= _stop_step || _stop_time != next_stop(state.clock.time()) ||
      state.asked != asked_steps(_scene))
    plan();
}

double Simulation::next_stop(double time) const {
  for (const double output : _scene.output.times)
    if (output > time) return std::min(output, _scene.time.end_time);
  return _scene.time.end_time;
}

bool Simulation::is_output_time(double time) const {
  return std::ranges::count(_scene.output.times, time) > 0;
}

/// Where nothing in the fabric is faster than `frequency`, rad/s.
double Simulation::longest_stable_step(double frequency) {
  return fabric::stable_dt(_scene.time.integrator, frequency, _solver->fastest_decay());
}

/// What automatic steps are a share of.
double Simulation::stable_dt() {
  double stable = longest_stable_step(_solver->fastest_frequency());
  // Verlet's method is stable at any absolute damping, but what damping slows it follows in steps below 1/K.
  const double damping = _scene.damping.absolute;
  if (_scene.time.integrator == fabric::Integrator::verlet && damping * stable > 1.0) stable = 1.0 / damping;
  if (!_scene.contact.self) return stable;
  // Contact looks about as far as it moves: a tenth of an edge a step keeps its lists short.
  std::vector<Vector> x(_problem.x.size()), v(x.size());
  _solver->download(x, v);
  double fastest = 0.0;
  for (const Vector& velocity : v)
    fastest = std::max(fastest, std::hypot(velocity[0], velocity[1], velocity[2]));
  return std::min(stable, 0.1 * fabric::collision_edges(_problem.parameters.mesh).mean_length / fastest);
}

/// Equal steps from now to the next stop, none longer than is stable or asked for.
void Simulation::plan() {
  const std::int64_t step = _solver->time_state().step;
  const double begin = time();
  _stop_time = next_stop(begin);
  _stop_step = step;
  if (_stop_time <= begin) return;
  const double longest = _scene.time.dt ? *_scene.time.dt : _scene.time.safety * stable_dt();
  // Round-off of a quotient that should be whole must not add a step.
  const double steps = std::max(1.0, std::ceil((_stop_time - begin) / longest * (1.0 - 1e-12)));
  if (!(steps <= most_steps))
    throw Failure(ExitCode::numerical_failure,
                  "the fastest frequency of the mesh allows no step that ends: more than 1e15 to t = " +
                      scene::real_text(_stop_time) + " s");
  const double dt = (_stop_time - begin) / steps;
  _stop_step += static_cast<std::int64_t>(steps);
  _solver->set_time_state({step, dt, step, begin});
  _dt_min = _dt_min > 0.0 ? std::min(_dt_min, dt) : dt;
  _dt_max = std::max(_dt_max, dt);
}

/// The bound of the step is asked for again now and then; where it has shrunk, so do the steps.
void Simulation::replan_if_stiffer() {
  if (_scene.time.dt) return;
  if (_solver->time_state().dt > 1.02 * _scene.time.safety * stable_dt()) plan();
}

/// Why the step that a scene asks for is too long, if it is. Steps beyond the stable ones double the motion
/// again and again, and a run may end before a number overflows. The bound of the frequencies lies above the
/// largest: where it would forbid the step the largest itself is looked for, and again where the bound has
/// grown. Of dashpots no more than a bound is known: there cloth that moves farther in a step than the whole
/// mesh reaches tells. What flies freely may do so too, but there is no step too long for it.
std::string Simulation::too_long_step() {
  const Time& asked = _scene.time;
  const double dt = _solver->time_state().dt, bound = _solver->fastest_frequency();
  if (!asked.dt) return {};
  std::ostringstream text;
  text << "a step of " << dt << " s is too long: ";
  if (asked.integrator == fabric::Integrator::verlet && _scene.damping.absolute * dt > turning_damping) {
    text << "damping.absolute = " << _scene.damping.absolute << " 1/s turns velocities round in it";
    return text.str();
  }
  if (dt <= longest_stable_step(bound)) return {};
  if (bound > 1.01 * _asked_at) {
    _asked_at = bound;
    const double frequency = _solver->frequency_at_least();
    // Forces whose differences tell it have round-off.
    if (fabric::grows(asked.integrator, dt, (1.0 - 1e-5) * frequency, _scene.damping.absolute,
                      _solver->fastest_decay())) {
      text << "oscillations of the cloth at " << frequency << " rad/s grow in it at step "
           << _solver->time_state().step << ", t = " << time() << " s";
      return text.str();
    }
  }
  const double way = std::sqrt(2.0 * _solver->totals().kinetic / _problem.mass) * dt;
  const auto extent = [&](std::size_t axis) {
    const auto [low, high] =
        std::ranges::minmax(_scene.mesh.rest, {}, [axis](const Vector& x) { return x[axis]; });
    return high[axis] - low[axis];
  };
  if (!(way > std::hypot(extent(0), extent(1), extent(2)))) return {};
  text << "cloth moves " << way << " m in it on average, farther than the whole mesh reaches";
  return text.str();
}

std::int64_t Simulation::steps_to_event() const {
  const std::int64_t step = _solver->time_state().step;
  std::int64_t next = _stop_step;
  for (const std::int64_t every : {std::int64_t{_scene.output.history_every},
                                   std::int64_t{_scene.output.restart_every}, bound_every(step)})
    if (every > 0) next = std::min(next, (step / every + 1) * every);
  return next - step;
}

void Simulation::round_trip() {
  std::vector<Vector> x(_problem.x.size()), v(x.size());
  const auto begin = Clock::now();
  std::vector<fabric::ContactWork> work(_scene.contact.asked_for() ? x.size() : 0);
  _solver->download(x, v);
  if (!work.empty()) _solver->contact_work(work);
  const auto middle = Clock::now();
  _solver->upload(x, v);
  if (!work.empty()) _solver->set_contact_work(work);
  _d2h_s += std::chrono::duration<double>(middle - begin).count();
  _h2d_s += seconds_since(middle);
}

/// False if a state was lost or a signal came before all steps were taken.
bool Simulation::advance(std::int64_t steps, ProgressLine& progress) {
  while (steps > 0) {
    const std::int64_t part = std::min(steps, _settings.seed_mode || !_warm ? 1 : _piece);
    const auto begin = Clock::now();
    const bool goes_on = _solver->advance(part) && !_solver->failure();
    const double seconds = seconds_since(begin);
    _compute_s += seconds;
    if (!goes_on) return false;
    if (_settings.seed_mode) round_trip();
    if (!_warm) device::end_warmup();
    if (_warm && seconds < 0.5 * look_every_s && part == _piece) _piece *= 2;
    if (seconds > look_every_s) _piece = std::max<std::int64_t>(1, _piece / 2);
    _warm = true;
    steps -= part;
    progress.update(_solver->time_state().step, time(), _scene.time.end_time);
    if (steps > 0 && interrupted()) return false;
  }
  return true;
}

/// From the state that the solver went back to on through the steps before `lost`, which were good.
void Simulation::return_to_last_good(std::int64_t lost) {
  round_trip();  // what is uploaded has not failed
  _solver->advance(lost - 1 - _solver->time_state().step);
  _solver->failure();  // waits
}

/// What falls on the step now.
void Simulation::reach_event(RunOutput& output) {
  const Output& wanted = _scene.output;
  const std::int64_t step = _solver->time_state().step;
  const bool at_stop = step == _stop_step, at_end = at_stop && _stop_time == _scene.time.end_time;
  if (wanted.history_every > 0 && (at_end || step % wanted.history_every == 0)) output.write_row(row());
  if (at_stop && is_output_time(_stop_time)) reach_output(output);
  if (at_stop)
    plan();
  else if (step % bound_every(step) == 0)
    replan_if_stiffer();
  if (wanted.restart_every > 0 && step % wanted.restart_every == 0) output.write_restart(restart_state());
}

ExitCode Simulation::run(const run::RunDirectory& directory, run::ResultDocument& result) {
  const bool resumed = !_settings.restart.empty();
  RunOutput output(_scene, directory, resumed ? std::optional<double>(time()) : std::nullopt,
                   _settings.restart);
  if (_scene.output.history_every > 0 && !output.continues_rows()) output.write_row(row());
  if (!resumed && is_output_time(0.0)) reach_output(output);
  ProgressLine progress(_settings.quiet);
  // However this ends, the result says how far it came.
  const struct Describe {
    const Simulation& simulation;
    run::ResultDocument& result;
    ~Describe() { simulation.describe(result); }
  } describe_at_end{*this, result};
  std::string too_long = too_long_step();
  while (too_long.empty() && _solver->time_state().step < _stop_step && !interrupted()) {
    if (!advance(steps_to_event(), progress)) break;
    reach_event(output);
    const std::int64_t step = _solver->time_state().step;
    if (step == _stop_step || step % bound_every(step) == 0) too_long = too_long_step();
  }
  progress.finish();
  const auto failure = _solver->failure();
  if (failure && _settings.can_be_continued) return_to_last_good(failure->step);
  const bool done = !failure && _solver->time_state().step == _stop_step;
  if (!done && _settings.can_be_continued) output.write_restart(restart_state());
  output.finish();
  _io_s = output.waited();
  if (failure) throw Failure(ExitCode::numerical_failure, failure_text(*failure));
  if (!too_long.empty()) {
    too_long += "; take a shorter time.dt, or \"auto\"";
    if (!done && _settings.can_be_continued)
      too_long += "; restart.h5 holds the state of step " + std::to_string(_solver->time_state().step);
    throw Failure(ExitCode::numerical_failure, too_long);
  }
  return done ? ExitCode::ok : ExitCode::interrupted;
}

std::string Simulation::failure_text(const fabric::Failure& failure) const {
  std::ostringstream text;
  text.precision(9);
  const auto vertex = static_cast<std::size_t>(_problem.order.at(static_cast<std::size_t>(failure.vertex)));
  const Vector& rest = _scene.mesh.rest[vertex];
  text << lost_text(failure.reason) << " at vertex " << vertex << " (at rest at " << rest[0] << ", "
       << rest[1] << ", " << rest[2] << " m) at step " << failure.step << ", t = " << failure.time << " s";
  if (_settings.can_be_continued)
    text << "; restart.h5 holds the last good state, of step " << _solver->time_state().step;
  if (failure.reason == fabric::FailureReason::not_finite)
    text << (_scene.time.dt
                 ? "; if no expression gives such a number, time.dt = \"auto\" takes a step that is stable"
                 : "; if no expression gives such a number, a smaller time.safety takes shorter steps");
  return text.str();
}

void Simulation::describe(run::ResultDocument& result) const {
  result.driver = _settings.seed_mode ? "seed" : _solver->driver();
  result.steps = _solver->time_state().step;
  result.time = time();
  result.dt_min = _dt_min;
  result.dt_max = _dt_max;
  result.timing.setup_s = _setup_s;
  result.timing.compute_s = _compute_s;
  result.timing.h2d_s = _h2d_s;
  result.timing.d2h_s = _d2h_s;
  result.timing.io_s = _io_s;
  result.describe_ledger(device::profiling_counters());
}

}  // namespace drogue::springs_app
