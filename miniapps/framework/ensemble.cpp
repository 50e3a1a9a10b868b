#include "miniapps/framework/ensemble.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>

#include "common/program/child_processes.hpp"
#include "common/program/program.hpp"
#include "common/program/stopwatch.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/run/result_document.hpp"
#include "common/run/run_directory.hpp"
#include "kernels/device/host_cores.hpp"
#include "miniapps/framework/device_session.hpp"

namespace drogue::framework {
namespace {

/// The end of a file of text, of which the last line counts.
std::string last_line(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string last;
  for (std::string line; std::getline(stream, line);)
    if (!line.empty()) last = line;
  return last;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A directory with a study of this kind, which has runs.csv from its first moment on, is continued.
run::ExistingRun existing_study(const MiniAppOptions& options, const std::filesystem::path& directory) {
  if (options.overwrite) return run::ExistingRun::overwrite;
  std::error_code ignored;
  return std::filesystem::exists(directory / "runs.csv", ignored) ? run::ExistingRun::resume
                                                                  : run::ExistingRun::refuse_study;
}

class EnsembleStudy {
 public:
  EnsembleStudy(const MiniAppOptions& options, const std::filesystem::path& file, Ensemble& ensemble)
      : _options(options),
        _file(file),
        _ensemble(ensemble),
        _jobs(jobs_of(options, ensemble)),
        _out(options.out.empty() ? std::filesystem::path("out") / (ensemble.scene + "-study") : options.out),
        _directory(_out, existing_study(options, _out)),
        _result(run::new_result(ensemble.program, ensemble.scene)) {
    if (!options.overwrite) take_over_finished();
    _directory.begin();
    write_rows();
    _directory.write_scene(ensemble.printed);
    _result.warnings = ensemble.notices;
    if (!options.quiet)
      for (const std::string& notice : ensemble.notices) print_notice(ensemble.program, notice);
  }

  void run() {
    std::vector<ChildProcess> processes;
    std::vector<study::Member*> members;
    for (EnsembleRun& run : _ensemble.runs) {
      if (run.member.is_finished()) continue;
      processes.push_back(process_of(run));
      members.push_back(&run.member);
    }
    if (_taken_over > 0 && !_options.quiet)
      std::printf("%zu of %zu runs were there already; --overwrite runs them anew\n", _taken_over,
                  _ensemble.runs.size());
    const bool all_started =
        run_processes(processes, _jobs, [&](std::size_t i, int code) { finish(*members[i], code); });
    const bool is_interrupted =
        !all_started || std::ranges::any_of(_ensemble.runs, [](const EnsembleRun& run) {
          return run.member.code == ExitCode::interrupted;
        });
    if (is_interrupted) {
      _result.exit_code = ExitCode::interrupted;
      _result.message =
          "interrupted by a signal; the tables hold the finished runs, and the same command runs the others";
    } else if (const EnsembleRun* const failed = first_failure()) {
      _result.exit_code = failed->member.code;
      _result.message = failure_text(*failed);
    }
    report();
    if (_result.exit_code != ExitCode::ok) throw Failure(_result.exit_code, _result.message);
  }

 private:
  /// Takes over the runs that an earlier study has finished. Throws `Failure` (usage) for one of another
  /// scene or program: their results would be mixed.
  void take_over_finished() {
    for (EnsembleRun& run : _ensemble.runs) {
      const std::filesystem::path folder = folder_of(run.member);
      const auto origin = study::read_finished(folder / "result.json", run.member);
      if (!origin) continue;
      if (const std::string difference = difference_from(*origin, run); !difference.empty())
        throw Failure(ExitCode::usage, "'" + folder.string() + "' holds a run of " + difference +
                                           "; choose another --out, or give --overwrite to run all anew");
      _finished.push_back(run.member);
    }
    _taken_over = _finished.size();
  }

  /// What a finished run is of instead; empty if it is the one that is wanted.
  [[nodiscard]] std::string difference_from(const study::Origin& origin, const EnsembleRun& run) const {
    if (origin.version != _result.version || origin.git != _result.git)
      return "another program: version " + origin.version + " of commit " + origin.git + ", not " +
             _result.version + " of " + _result.git;
    const ResolvedScene wanted = _ensemble.resolve(run);
    const std::string printed = text_of(folder_of(run.member) / "scene.toml");
    if (printed == wanted.printed && origin.fingerprint == fingerprint(wanted.identity)) return {};
    // With the same keys, the meshes differ.
    return "another scene: " + first_difference({printed, "earlier"}, {wanted.printed, "present"});
  }

  void write_rows() const {
    run::write_file_atomically(_directory.file("runs.csv"),
                               study::members_csv(_finished, _ensemble.axes.factors));
  }

  [[nodiscard]] std::filesystem::path folder_of(const study::Member& member) const {
    return _directory.path() / member.folder;
  }
  [[nodiscard]] std::filesystem::path log_of(const study::Member& member) const {
    return _directory.path() / (member.folder + ".log");
  }

  [[nodiscard]] ChildProcess process_of(const EnsembleRun& run) const {
    ChildProcess process;
    process.program = this_program();
    process.command = {_ensemble.program, _file.string(), "--backend",
                       _options.backend,  "--out",        folder_of(run.member).string(),
                       "--overwrite",     "--quiet"};
    for (const std::string& assignment : run.sets) {
      process.command.emplace_back("--set");
      process.command.push_back(assignment);
    }
    process.command.insert(process.command.end(), _options.kokkos.begin(), _options.kokkos.end());
    process.log = log_of(run.member);
    // That of an earlier study would stand for a run that fails before it begins.
    std::filesystem::remove(folder_of(run.member) / "result.json");
    std::filesystem::create_directories(process.log.parent_path());
    // Runs at once share the cores; threads that are bound to them would all take the same ones.
    if (_jobs > 1) process.environment["OMP_PROC_BIND"] = "false";
    if (_jobs > 1 && std::getenv("OMP_NUM_THREADS") == nullptr)
      process.environment["OMP_NUM_THREADS"] =
          std::to_string(std::max(1, device::host_cores().allowed / _jobs));
    return process;
  }

  void finish(study::Member& member, int code) {
    study::read_member(folder_of(member) / "result.json", code, last_line(log_of(member)), member);
    // That of the run speaks of --restart, which continues no run of a study.
    if (member.code == ExitCode::interrupted) member.message.clear();
    std::error_code ignored;
    if (member.message.empty() || std::filesystem::file_size(log_of(member), ignored) == 0)
      std::filesystem::remove(log_of(member), ignored);
    _finished.push_back(member);
    write_rows();
    if (_options.quiet) return;
    std::printf("%-24s %3zu of %zu  %s, %lld steps in %.3g s%s\n", member.folder.c_str(), _finished.size(),
                _ensemble.runs.size(), run::status_name(member.code).c_str(),
                static_cast<long long>(member.steps), member.wall_s,
                member.message.empty() ? "" : (": " + member.message).c_str());
    std::fflush(stdout);
  }

  [[nodiscard]] static bool has_failed(const study::Member& member) {
    return !member.is_finished() && member.code != ExitCode::interrupted;
  }

  /// Null without one.
  [[nodiscard]] const EnsembleRun* first_failure() const {
    const auto failed =
        std::ranges::find_if(_ensemble.runs, [](const EnsembleRun& run) { return has_failed(run.member); });
    return failed == _ensemble.runs.end() ? nullptr : &*failed;
  }

  [[nodiscard]] std::string failure_text(const EnsembleRun& first) const {
    const auto count = std::ranges::count_if(_finished, has_failed);
    return std::to_string(count) + " of " + std::to_string(_ensemble.runs.size()) +
           " runs failed, and the error bars lack them; '" + folder_of(first.member).string() +
           "': " + first.member.message;
  }

  /// Writes result.json and prints the error bars.
  void report() {
    std::vector<study::Member> members;
    for (const EnsembleRun& run : _ensemble.runs) members.push_back(run.member);
    const std::vector<study::StudyQuantity> quantities = study::summarize(members, _ensemble.axes.factors);
    study::describe(_ensemble.axes, members, quantities, _result.metrics);
    _result.time = _ensemble.end_time;
    for (const study::Member& member : members) {
      _result.steps += member.steps;
      if (!member.is_finished()) continue;
      _result.backend = member.backend;
      _result.device = member.device;
      _result.threads = member.threads;
    }
    _result.timing.wall_s = _result.timing.compute_s = _stopwatch.seconds();
    run::write_result(_directory.file("result.json"), _result);
    if (_options.quiet) return;
    std::printf("%s: %lld of %zu runs in %.3g s, %d at once; +- is 95 %%\n", _ensemble.scene.c_str(),
                static_cast<long long>(std::ranges::count_if(members, &study::Member::is_finished)),
                members.size(), _stopwatch.seconds(), _jobs);
    for (const study::StudyQuantity& quantity : quantities)
      std::printf("  %s = %s\n", _ensemble.title(quantity.name).c_str(), study::text_of(quantity).c_str());
    std::printf("files in %s\n", _directory.path().string().c_str());
  }

  const MiniAppOptions& _options;
  const std::filesystem::path& _file;
  Ensemble& _ensemble;
  const int _jobs;
  const Stopwatch _stopwatch;
  const std::filesystem::path _out;
  run::RunDirectory _directory;
  run::ResultDocument _result;
  std::vector<study::Member> _finished;  ///< in the order in which they ended
  std::size_t _taken_over = 0;           ///< of them, from an earlier study
};

}  // namespace

int jobs_of(const MiniAppOptions& options, const Ensemble& ensemble) {
  const device::Backend backend = choose_backend(options.backend, ensemble.useful_threads);
  if (ensemble.axes.jobs > 0) return ensemble.axes.jobs;
  return device::needs_device(backend)
             ? 1
             : std::clamp(device::host_cores().allowed, 1, static_cast<int>(ensemble.runs.size()));
}

void run_ensemble(const MiniAppOptions& options, const std::filesystem::path& file, Ensemble ensemble) {
  const device::UnboundThread unbound;
  EnsembleStudy(options, file, ensemble).run();
}

}  // namespace drogue::framework
