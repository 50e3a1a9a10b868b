#include "miniapps/gas/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "common/program/signals.hpp"
#include "common/run/restart_file.hpp"
#include "kernels/device/profiling_counters.hpp"
#include "kernels/device/runtime.hpp"
#include "miniapps/gas/failure_text.hpp"
#include "miniapps/gas/fields.hpp"

namespace drogue::gas_app {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace

void describe_device(run::ResultDocument& result, const gas::Parameters& parameters,
                     device::Backend backend) {
  result.describe_device(std::string(device::name(backend)), device::device_facts());
  result.precision = parameters.precision == gas::Precision::split ? "split" : "double";
}

Simulation::Simulation(const GasScene& scene, const RunSettings& settings)
    : _scene(scene), _settings(settings) {
  const auto begin = Clock::now();
  _solver = settings.seed_mode ? gas::create_baseline_solver(settings.backend, scene.parameters)
                               : gas::create_solver(settings.backend, scene.parameters);
  const auto upload = Clock::now();
  if (settings.restart.empty()) {
    upload_initial_state(*_solver, scene);
    _solver->start();
    _initial = _solver->totals();
  } else {
    const RestartState state = read_restart(settings.restart, scene, *_solver);
    run::require_not_after(settings.restart, state.resume.time, "run.end_time", scene.end_time);
    _solver->restore(state.resume);
    _initial = state.initial;
  }
  _h2d_s = seconds_since(upload);
  if (!scene.output.fields.empty() || scene.output.restart_every > 0) {
    // The first snapshot allocates what all of them use.
    _solver->begin_snapshot();
    _solver->finish_snapshot();
  }
  _setup_s = seconds_since(begin);
}

double Simulation::next_stop(double time) const {
  for (const double output : _scene.output.times)
    if (output > time) return std::min(output, _scene.end_time);
  return _scene.end_time;
}

bool Simulation::is_output_time(double time) const {
  return std::find(_scene.output.times.begin(), _scene.output.times.end(), time) != _scene.output.times.end();
}

ExitCode Simulation::run(const run::RunDirectory* directory, run::ResultDocument& result) {
  const bool resumed = !_settings.restart.empty();
  gas::RestartState now = _solver->restart_state();
  std::optional<RunOutput> output;
  if (directory != nullptr)
    output.emplace(_scene, *_solver, *directory, resumed ? std::optional<double>(now.time) : std::nullopt);
  if (output && !resumed) {
    output->write_row(_initial);
    if (is_output_time(0.0)) output->write_fields(0.0, 0);
  }
  ProgressLine progress(_settings.quiet);
  const auto poll = [&](const gas::Status& status) {
    progress.update(status.step, status.time, _scene.end_time);
    return !interrupted();
  };
  const gas::RowSink rows = [&](const gas::HistoryRow& row) { output->write_row(row); };
  const int row_every = output ? _scene.output.history_every : 0;
  const std::int64_t restart_every = output ? _scene.output.restart_every : 0;

  // However this ends, the result says how far it came.
  const struct Describe {
    Simulation& simulation;
    run::ResultDocument& result;
    ~Describe() { simulation.describe(result); }
  } describe_at_end{*this, result};
  bool warm = false;  // the first step allocates what all of them use
  gas::Stop stop = gas::Stop::target;
  const auto restart_state = [&] { return RestartState{_solver->restart_state(), _initial}; };
  while (now.time < _scene.end_time) {
    const double target = next_stop(now.time);
    std::int64_t pause = restart_every > 0 ? (now.step / restart_every + 1) * restart_every : -1;
    if (!warm) pause = now.step + 1;
    const auto begin = Clock::now();
    stop = _solver->advance(target, pause, row_every, rows, poll);
    _compute_s += seconds_since(begin);
    if (!warm) device::end_warmup();
    warm = true;
    now = _solver->restart_state();
    if (output && now.time == target && is_output_time(target)) output->write_fields(target, now.step);
    if (output && restart_every > 0 && now.step % restart_every == 0 && stop != gas::Stop::failed)
      output->write_restart(restart_state());
    if (stop != gas::Stop::target && stop != gas::Stop::pause) break;
  }
  progress.finish();
  if (output) {
    // An interrupted run goes on later and must then have the rows of one that was not.
    if (stop != gas::Stop::interrupted) output->write_row(_solver->totals());
    if (stop == gas::Stop::failed || stop == gas::Stop::max_steps || stop == gas::Stop::interrupted)
      output->write_restart(restart_state());
    output->finish();
    _io_s = output->waited();
  }
  if (stop == gas::Stop::interrupted) return ExitCode::interrupted;
  if (stop == gas::Stop::failed || stop == gas::Stop::max_steps)
    throw Failure(ExitCode::numerical_failure, failure_text(*_solver, _scene.parameters, stop));
  return ExitCode::ok;
}

void Simulation::write_restart(const run::RunDirectory& directory) {
  _solver->begin_snapshot();
  gas_app::write_restart(directory.file("restart.h5"), _scene, *_solver, _solver->finish_snapshot(),
                         {_solver->restart_state(), _initial});
}

void Simulation::describe(run::ResultDocument& result) {
  const gas::RestartState now = _solver->restart_state();
  const gas::PhaseTimes phase_times = _solver->phase_times();
  result.steps = now.step;
  result.driver = _solver->driver();
  result.time = now.time;
  result.dt_min = now.dt_min;
  result.dt_max = now.dt_max;
  result.limiter = {now.limited_faces, _solver->limited_cells(), now.redone};
  result.timing.setup_s = _setup_s;
  result.timing.compute_s = _settings.seed_mode ? phase_times.compute : _compute_s;
  result.timing.h2d_s = _settings.seed_mode ? phase_times.h2d : _h2d_s;
  result.timing.d2h_s = _settings.seed_mode ? phase_times.d2h : _d2h_s;
  result.timing.io_s = _io_s;
  result.describe_ledger(device::profiling_counters());
}

}  // namespace drogue::gas_app
