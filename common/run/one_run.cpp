#include "common/run/one_run.hpp"

#include <chrono>
#include <cstdio>
#include <system_error>

#include "common/program/program.hpp"

namespace drogue::run {
namespace {

/// False for an empty directory and for one whose only run never began.
bool holds_results(const std::filesystem::path& directory) {
  for (const std::string& name : run_file_names())
    if (std::error_code ignored; name != "result.json" && std::filesystem::exists(directory / name, ignored))
      return true;
  return false;
}

/// In a directory that holds results `--restart auto` without a restart file begins anew, and the restart
/// file of another directory goes on, but only if they are of the same scene.
void require_same_scene(const OneRun& run, const std::filesystem::path& directory,
                        const std::filesystem::path& restart) {
  const std::filesystem::path from = restart.has_parent_path() ? restart.parent_path() : ".";
  if (std::error_code ignored; !restart.empty() && std::filesystem::equivalent(from, directory, ignored))
    return;
  bool same = false;
  try {
    same = run.is_same_scene(directory / "scene.toml");
  } catch (const Failure&) {
    // No scene, or none of this program; or it lacks a file that lies beside the original.
  }
  if (!same)
    throw Failure(ExitCode::usage, "'" + directory.string() + "' holds a run of another scene" +
                                       (restart.empty() ? " and no restart file; choose another --out, or "
                                                          "give --overwrite to replace it"
                                                        : "; choose another --out"));
}

ExistingRun existing_run(const MiniAppOptions& options, bool is_empty, const std::filesystem::path& restart) {
  if (options.overwrite) return ExistingRun::overwrite;
  if (!restart.empty()) return ExistingRun::resume;
  if (options.restart == "auto") return ExistingRun::overwrite;
  return is_empty ? ExistingRun::overwrite : ExistingRun::refuse;
}

void print_summary(const OneRun& run, const ResultDocument& result, const std::filesystem::path& directory) {
  run.print_steps(result);
  for (const Check& check : result.checks)
    std::printf("  %-16s %.4g  (tolerance %.4g)  %s\n", check.name.c_str(), check.value, check.tolerance,
                check.passed ? "passed" : "FAILED");
  std::printf("files in %s\n", directory.string().c_str());
}

}  // namespace

ExitCode carry_out(const OneRun& run, const MiniAppOptions& options) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("out") / run.scene : options.out;
  const std::filesystem::path restart =
      options.restart.empty() ? std::filesystem::path() : restart_source(options.restart, out);
  const bool is_empty = !holds_results(out);
  RunDirectory directory(out, existing_run(options, is_empty, restart));
  ResultDocument result = new_result(run.program, run.scene);
  const auto stop_clock = [&] {
    result.timing.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  };
  try {
    run.read();
    if (!is_empty && !options.restart.empty() && !options.overwrite) require_same_scene(run, out, restart);
    run.execute(directory, restart, result);
    if (result.exit_code == ExitCode::interrupted)
      result.message = "interrupted by a signal; restart.h5 is written";
  } catch (...) {
    const Failure failure = current_failure();
    result.exit_code = failure.code();
    result.message = failure.what();
    stop_clock();
    try {
      // A slip in the scene or the command line does not touch what a former run has left; that it could not
      // be continued is told.
      const bool refused_restart = !restart.empty() && failure.code() == ExitCode::io_error;
      if (is_empty || directory.begun() || refused_restart)
        write_result(directory.file("result.json"), result);
    } catch (const Failure& second) {
      throw Failure(failure.code(), std::string(failure.what()) + "; and " + second.what());
    }
    if (failure.code() == ExitCode::verification_failed && !options.quiet) print_summary(run, result, out);
    throw failure;
  }
  stop_clock();
  write_result(directory.file("result.json"), result);
  if (!options.quiet) print_summary(run, result, out);
  return result.exit_code;
}

}  // namespace drogue::run
