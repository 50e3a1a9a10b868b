#include "miniapps/framework/run_loop.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "common/program/progress.hpp"
#include "common/program/signals.hpp"
#include "common/program/stopwatch.hpp"
#include "kernels/device/profiling_counters.hpp"

namespace drogue::framework {
namespace {

/// One pass from the current state to the end.
class RunLoop {
 public:
  RunLoop(Simulation& simulation, const RunRequest& request, run::ResultDocument& result)
      : _simulation(simulation),
        _request(request),
        _result(result),
        _wanted(simulation.output()),
        _end(simulation.end_time().time),
        _first(simulation.now()),
        _now(_first),
        _progress(request.quiet),
        _phases_before(simulation.phases().phases()),
        _compute_before(simulation.phases().compute_s) {}

  /// However the run ends, the result shows how far it came.
  ~RunLoop() {
    const SimulationTime now = _simulation.now();
    _result.steps = now.step;
    _result.time = now.time;
    _simulation.describe(_result);
    describe_times();
    describe_speed(now);
    _result.describe_ledger(device::profiling_counters());
  }
  RunLoop(const RunLoop&) = delete;
  RunLoop& operator=(const RunLoop&) = delete;

  ExitCode run() {
    open_files();
    while (_now.time < _end && !ended()) take_interval();
    _progress.finish();
    return close_files();
  }

 private:
  [[nodiscard]] int restart_interval() const { return _wanted.restart_every.value_or(0); }

  /// With an interval, the last file of it continues the run as if it had not ended.
  [[nodiscard]] bool needs_restart_of_end() const {
    if (_wanted.restart_every == 0) return false;
    const int every = restart_interval();
    const bool has_last = every > 0 && _restart_step == _now.step / every * every;
    return !has_last && _restart_step != _now.step;
  }

  void describe_times() {
    const run::ResultDocument::WallTimes phases = _simulation.phases();
    run::ResultDocument::WallTimes& timing = _result.timing;
    timing.compute_s = phases.compute_s, timing.bound_s = phases.bound_s;
    timing.h2d_s = phases.h2d_s, timing.d2h_s = phases.d2h_s;
    timing.io_s = std::max(0.0, _stopwatch.seconds() - (phases.phases() - _phases_before));
  }

  void describe_speed(const SimulationTime& now) {
    const double seconds = _result.timing.compute_s - _compute_before;
    const StepWork work = _simulation.step_work();
    if (now.step == _first.step || !(seconds > 0.0) || work.items == 0.0) return;
    _result.metrics.set("figure_of_merit", work.key,
                        work.items * static_cast<double>(now.step - _first.step) / seconds);
    _result.metrics.set("figure_of_merit", "simulated_s_per_s", (now.time - _first.time) / seconds);
  }

  [[nodiscard]] bool ended() const { return _stop == StopReason::interrupted || _stop == StopReason::failed; }

  void open_files() {
    if (!_request.files.directory.empty()) {
      _output.emplace(_simulation, _request.files);
      if (_output->continues_restart_file()) _restart_step = _now.step;
    }
    if (_output && _output->lacks_row(_now.time)) _output->write_row(_simulation.row());
    if (_request.files.restart.empty() && is_output_time(_wanted, _now.time)) write_output_now();
  }

  void write_output_now() {
    if (_output) _output->write_fields();
    if (_request.at_output) _request.at_output();
  }

  /// The first step allocates memory that all steps use, so the run pauses after it.
  [[nodiscard]] AdvanceLimits next_limits() const {
    AdvanceLimits limits;
    limits.target_time = next_stop(_wanted, _now.time, _end);
    if (const int every = restart_interval(); _output && every > 0)
      limits.pause_step = (_now.step / every + 1) * every;
    if (!_warm) limits.pause_step = _now.step + 1;
    if (_output) limits.row_every = _wanted.history_every;
    return limits;
  }

  void take_interval() {
    const AdvanceLimits limits = next_limits();
    const RowSink rows = [this](const HistoryRow& row) { _output->write_row(row); };
    const Poll poll = [this](const SimulationTime& now) {
      _progress.update(now.step, now.time, _end);
      return !interrupted();
    };
    _stop = _simulation.advance(limits, rows, poll);
    if (!_warm) device::end_warmup();
    _warm = true;
    _now = _simulation.now();
    if (_now.time == limits.target_time && is_output_time(_wanted, _now.time)) write_output_now();
    const bool can_continue = _stop != StopReason::target || _simulation.plan_next_interval();
    const int every = restart_interval();
    if (_output && every > 0 && _now.step % every == 0 && !ended()) {
      _output->write_restart();
      _restart_step = _now.step;
    }
    if (!can_continue) _stop = StopReason::failed;
  }

  ExitCode close_files() {
    const bool complete = !(_now.time < _end);
    // An interrupted run is continued, and must then have the rows of a run without interruption.
    if (complete && _stop != StopReason::interrupted && _output && _output->lacks_row(_now.time))
      _output->write_row(_simulation.row());
    const bool ends_early = (ended() && !complete) || _stop == StopReason::interrupted;
    const bool restart_written =
        _output && _request.keeps_restart && (ends_early || (!ended() && needs_restart_of_end()));
    if (restart_written) _output->write_restart();
    if (_output) _output->finish();
    if (_stop == StopReason::failed)
      throw Failure(ExitCode::numerical_failure, _simulation.failure_text(restart_written));
    return _stop == StopReason::interrupted ? ExitCode::interrupted : ExitCode::ok;
  }

  Simulation& _simulation;
  const RunRequest& _request;
  run::ResultDocument& _result;
  const OutputRequest& _wanted;
  const double _end;
  const SimulationTime _first;
  SimulationTime _now;
  std::optional<std::int64_t> _restart_step;  ///< of the restart.h5 of the directory, if known
  ProgressLine _progress;
  const double _phases_before;   ///< that setup has taken, s
  const double _compute_before;  ///< of it, steps
  const Stopwatch _stopwatch;
  std::optional<RunOutput> _output;
  StopReason _stop = StopReason::target;
  bool _warm = false;
};

}  // namespace

void set_up(Simulation& simulation, const RunFiles& files) {
  if (files.restart.empty()) return simulation.start();
  const run::RestartReader reader(files.restart, files.fingerprint, files.describe_difference,
                                  files.communicator);
  simulation.restore(reader);
  const EndTime end = simulation.end_time();
  run::require_not_after(files.restart, simulation.now().time, end.key, end.time);
  files.communicator.run_on_root([&] { require_continuable(simulation, files); });
}

ExitCode run_to_end(Simulation& simulation, const RunRequest& request, run::ResultDocument& result) {
  RunLoop loop(simulation, request, result);
  ExitCode code = ExitCode::ok;
  // Here, since the end of `loop` is collective.
  request.files.communicator.run_or_abort([&] { code = loop.run(); }, request.before_abort);
  return code;
}

}  // namespace drogue::framework
