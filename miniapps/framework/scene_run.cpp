#include "miniapps/framework/scene_run.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <system_error>

#include "common/program/program.hpp"
#include "common/program/stopwatch.hpp"
#include "common/scene/node.hpp"
#include "miniapps/framework/device_session.hpp"
#include "miniapps/framework/run_loop.hpp"

namespace drogue::framework {
namespace {

/// False for an empty directory and for a directory whose only run never began.
bool holds_results(const std::filesystem::path& directory) {
  for (const std::string& name : run::run_file_names())
    if (std::error_code ignored; name != "result.json" && std::filesystem::exists(directory / name, ignored))
      return true;
  return false;
}

run::ExistingRun existing_run(const MiniAppOptions& options, bool is_empty,
                              const std::filesystem::path& restart) {
  if (options.overwrite) return run::ExistingRun::overwrite;
  if (!restart.empty()) return run::ExistingRun::resume;
  if (options.restart == "auto") return run::ExistingRun::overwrite;
  return is_empty ? run::ExistingRun::overwrite : run::ExistingRun::refuse;
}

/// One run of a scene in its directory.
class SceneRun {
 public:
  SceneRun(const MiniApp& app, const MiniAppOptions& options, const std::filesystem::path& file,
           Communicator& communicator)
      : _app(app),
        _options(options),
        _file(file),
        _communicator(communicator),
        _out(options.out.empty() ? std::filesystem::path("out") / file.stem() : options.out),
        _result(run::new_result(app.program(), file.stem().string())) {
    _result.metrics = app.metrics;
    _result.ranks = communicator.size();
    communicator.run_on_root([&] {
      if (!options.restart.empty()) _restart = run::restart_source(options.restart, _out);
      _is_empty = !holds_results(_out);
      _directory.emplace(_out, existing_run(options, _is_empty, _restart));
    });
    _restart = communicator.broadcast(_restart.string());
  }

  ExitCode run() {
    try {
      _communicator.run_or_abort([&] { execute(); }, [&] { record_abort(); });
    } catch (...) {
      const Failure failure = current_failure();
      if (_communicator.is_root()) record(failure);
      throw failure;
    }
    const bool is_interrupted = _result.exit_code == ExitCode::interrupted;
    if (is_interrupted)
      _result.message = "interrupted by a signal; restart.h5 is written, continue with --restart auto";
    if (_communicator.is_root()) write_result();
    if (!_options.quiet) print_summary();
    if (is_interrupted) print_notice(_app.program(), _result.message);
    return _result.exit_code;
  }

 private:
  /// The run itself. Sets the exit code, `ok` or `interrupted`.
  void execute() {
    std::unique_ptr<Scene> scene;
    device::Backend backend{};
    _communicator.run_collectively([&] {
      scene = _app.read(_file, _options.set, _options.baseline);
      backend = choose_backend(_options.backend, scene->useful_threads(_result.ranks));
    });
    backend = _communicator.broadcast(backend);  // bits may differ between backends
    const SceneIdentity identity = scene->identity();
    const RunFiles files{
        .communicator = _communicator,
        .directory = _out,
        .title = _result.scene,
        .fingerprint = fingerprint(identity),
        .restart = _restart,
        .describe_difference = [&](const std::string& restarted) { return difference(restarted, identity); }};
    _result.fingerprint = files.fingerprint;
    const std::string printed = scene->print();
    require_scene_of_root(printed + files.fingerprint);
    _communicator.run_on_root([&] {
      if (!_is_empty && !_options.restart.empty() && !_options.overwrite)
        require_same_scene(files.fingerprint);
    });
    std::optional<DeviceSession> session;
    _communicator.run_collectively([&] {
      require_backend(backend);
      session.emplace(backend, _options.kokkos);
    });
    session->describe(_result);
    _result.warnings = scene->notices();
    const auto noticed = static_cast<std::ptrdiff_t>(_result.warnings.size());
    if (!_options.quiet) {
      for (const std::string& notice : _result.warnings) print_notice(_app.program(), notice);
      session->print_shared_cores(_app.program());
    }
    _result.precision = scene->precision();
    // Ranks communicate in it: not collectively, where one that has failed would wait for the others.
    const std::unique_ptr<Simulation> simulation =
        scene->create({backend, _options.baseline, _options.quiet, _communicator});
    set_up(*simulation, files);
    _communicator.run_on_root([&] {
      require_not_finished_later(simulation->end_time());
      begin_directory();
      _directory->write_scene(printed);
    });
    _result.timing.setup_s = _stopwatch.seconds() - simulation->phases().phases();
    const RunRequest request{files, _options.quiet, true, {}, [&] { record_abort(); }};
    _result.exit_code = run_to_end(*simulation, request, _result);
    if (_result.exit_code != ExitCode::ok) return;
    {
      const ScopedStopwatch stopwatch(_result.timing.verify_s);
      _communicator.run_on_root([&] {
        if (const std::vector<HistoryCheck> checks = scene->history_checks(); !checks.empty())
          add_history_checks(checks, run::read_history(_directory->file("history.csv")), _result);
      });
      _result.exit_code = simulation->verify(_directory ? &*_directory : nullptr, _result);
      if (_result.exit_code == ExitCode::interrupted) _result.checks.clear();  // it lacks others
    }
    if (!_options.quiet)
      std::for_each(_result.warnings.begin() + noticed, _result.warnings.end(),
                    [&](const std::string& warning) { print_notice(_app.program(), warning); });
    if (_result.exit_code == ExitCode::interrupted) write_restart_file(*simulation, files);
    _communicator.run_on_root([&] {
      if (const std::string failed = _result.failed_check(); !failed.empty())
        throw Failure(ExitCode::verification_failed, failed);
    });
  }

  /// Ranks that read different scenes, say from disks of their own, would wait for each other.
  void require_scene_of_root(const std::string& mine) {
    const std::string roots = _communicator.broadcast(mine);
    _communicator.run_collectively([&] {
      if (mine != roots)
        throw Failure(ExitCode::io_error, "the scene '" + _file.string() + "' is not the one of rank 0");
    });
  }

  void begin_directory() {
    std::string names;
    for (const std::string& name : _directory->begin()) names += (names.empty() ? "" : ", ") + name;
    if (!names.empty() && !_options.restart.empty())
      print_notice(_app.program(), "the run continues, and its former pictures are removed: " + names +
                                       "; drogue-plot draws them again");
  }

  /// How the scene beside the restart file differs from that of this run; empty if its fingerprint is not
  /// `restarted`, that of the restart file.
  [[nodiscard]] std::string difference(const std::string& restarted, const SceneIdentity& identity) const {
    try {
      const SceneIdentity other = _app.read(_restart.parent_path() / "scene.toml", {}, false)->identity();
      return fingerprint(other) == restarted ? first_difference(other, identity) : "";
    } catch (const Failure&) {
      return {};  // no scene, or none of this program
    }
  }

  /// In a directory that holds results, `--restart auto` without a restart file starts anew and the restart
  /// file of another directory is continued, but only if both belong to the same scene.
  void require_same_scene(const std::string& present) const {
    const std::filesystem::path from = _restart.has_parent_path() ? _restart.parent_path() : ".";
    if (std::error_code ignored; !_restart.empty() && std::filesystem::equivalent(from, _out, ignored))
      return;
    bool same = false;
    try {
      same = fingerprint(_app.read(_out / "scene.toml", {}, false)->identity()) == present;
    } catch (const Failure&) {
      // No scene, or none of this program; or it lacks a file that lies beside the original.
    }
    if (same && _restart.empty() && run::time_of_finished_run(_out / "result.json"))
      throw Failure(ExitCode::usage,
                    "'" + _out.string() +
                        "' holds a finished run and no restart file, so that it cannot be continued; choose "
                        "another --out, or give --overwrite to replace it");
    if (!same)
      throw Failure(ExitCode::usage, "'" + _out.string() + "' holds a run of another scene" +
                                         (_restart.empty() ? " and no restart file; choose another --out, or "
                                                             "give --overwrite to replace it"
                                                           : "; choose another --out"));
  }

  /// A restart file from before the end of a finished run must not replace it by a shorter one.
  void require_not_finished_later(const EndTime& end) const {
    if (_restart.empty() || _options.overwrite) return;
    const std::optional<double> finished = run::time_of_finished_run(_out / "result.json");
    if (finished && *finished > end.time)
      throw Failure(ExitCode::usage, "'" + _out.string() +
                                         "' holds a run finished at t = " + scene::real_text(*finished) +
                                         " s, later than " + end.key + " = " + scene::real_text(end.time) +
                                         "; choose another --out, or give --overwrite to replace it");
  }

  /// Writes how the run failed. An error in the scene or the command line leaves the files of a former run
  /// untouched, and so does a restart file that is refused; result.json states the refusal where none is.
  void record(const Failure& failure) {
    const bool refused_restart = !_restart.empty() && failure.code() == ExitCode::io_error &&
                                 !std::filesystem::exists(_directory->file("result.json"));
    run::record_failure(_result, failure, [&] {
      if (_is_empty || _directory->begun() || refused_restart) write_result();
    });
    if (failure.code() == ExitCode::verification_failed && !_options.quiet) print_summary();
  }

  /// Describes the end of all ranks by an exception of this one, which is being handled.
  void record_abort() { record(current_failure()); }

  void write_result() {
    _result.timing.wall_s = _stopwatch.seconds();
    run::write_result(_directory->file("result.json"), _result);
  }

  void print_summary() const {
    std::size_t width = 16;
    for (const run::Check& check : _result.checks) width = std::max(width, check.name.size());
    std::printf("%s on %s: %lld steps to t = %g s in %.3g s%s\n", _result.scene.c_str(),
                _result.backend.c_str(), static_cast<long long>(_result.steps), _result.time,
                _result.timing.wall_s, _app.summary ? _app.summary(_result).c_str() : "");
    for (const char* unit : {"cell", "vertex"})
      if (const auto rate = _result.metrics.real("figure_of_merit", std::string(unit) + "_steps_per_s"))
        std::printf("  %.3g million %s-steps per second of %.3g s of steps\n", 1e-6 * *rate, unit,
                    _result.timing.compute_s);
    for (const run::Check& check : _result.checks)
      std::printf("  %-*s %.4g  (tolerance %.4g)  %s%s\n", static_cast<int>(width), check.name.c_str(),
                  check.value, check.tolerance, check.passed ? "passed" : "FAILED",
                  check.measurement ? (": " + check.measured()).c_str() : "");
    if (_result.checks.empty() && _result.exit_code == ExitCode::ok) print_unverified();
    if (_app.report) std::printf("%s", _app.report(_result).c_str());
    std::printf("files in %s\n", _out.string().c_str());
  }

  /// Errors that no check bounds.
  void print_unverified() const {
    for (const auto& [name, error] : _result.errors) std::printf("  %-16s %.4g\n", name.c_str(), error);
    std::printf("  nothing verified: the scene has no %s in [verify]\n",
                _result.errors.empty() ? "checks" : "bound of these errors");
  }

  const MiniApp& _app;
  const MiniAppOptions& _options;
  const std::filesystem::path& _file;
  Communicator& _communicator;
  const Stopwatch _stopwatch;
  const std::filesystem::path _out;
  std::filesystem::path _restart;
  bool _is_empty = false;                       ///< on rank 0
  std::optional<run::RunDirectory> _directory;  ///< on rank 0
  run::ResultDocument _result;
};

}  // namespace

ExitCode run_scene(const MiniApp& app, const MiniAppOptions& options, const std::filesystem::path& file,
                   Communicator& communicator) {
  return SceneRun(app, options, file, communicator).run();
}

}  // namespace drogue::framework
