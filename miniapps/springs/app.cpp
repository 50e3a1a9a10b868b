#include "miniapps/springs/app.hpp"

#include <chrono>
#include <cstdio>
#include <iostream>
#include <system_error>

#include "common/program/mpi_guard.hpp"
#include "common/program/program.hpp"
#include "common/program/provenance.hpp"
#include "common/program/signals.hpp"
#include "common/scene/library.hpp"
#include "kernels/device/ledger.hpp"
#include "miniapps/springs/mesh_topology.hpp"
#include "miniapps/springs/restart.hpp"
#include "miniapps/springs/scene_folder.hpp"
#include "miniapps/springs/simulation.hpp"
#include "miniapps/springs/study.hpp"
#include "miniapps/springs/verify.hpp"

namespace drogue::springs_app {

device::Backend choose_backend(const std::string& wanted) {
  const device::Backend backend = device::wanted_backend(wanted);
  if (const auto reason = device::why_unavailable(backend)) throw Failure(ExitCode::no_backend, *reason);
  return backend;
}

std::unique_ptr<device::Runtime> start_kokkos(const std::vector<std::string>& arguments) {
  return made_as_asked([&] { return std::make_unique<device::Runtime>(arguments); });
}

namespace {

using Clock = std::chrono::steady_clock;

/// False for an empty directory and for one whose only run never began.
bool holds_results(const std::filesystem::path& directory) {
  for (const std::string& name : run::run_file_names())
    if (std::error_code ignored; name != "result.json" && std::filesystem::exists(directory / name, ignored))
      return true;
  return false;
}

/// In a directory that holds results `--restart auto` without a restart file begins anew, and the restart
/// file of another directory goes on, but only if they are of the same scene.
void require_same_scene(const SpringsScene& scene, const std::filesystem::path& directory,
                        const std::filesystem::path& restart) {
  const std::filesystem::path from = restart.has_parent_path() ? restart.parent_path() : ".";
  if (std::error_code ignored; !restart.empty() && std::filesystem::equivalent(from, directory, ignored))
    return;
  bool same = false;
  try {
    // A copy of the scene in another folder finds no mesh file beside it.
    same = scene_fingerprint(read_springs_scene(directory / "scene.toml")) == scene_fingerprint(scene);
  } catch (const Failure&) {
    // No scene, or none of this program.
  }
  if (!same)
    throw Failure(ExitCode::usage, "'" + directory.string() + "' holds a run of another scene" +
                                       (restart.empty() ? " and no restart file; choose another --out, or "
                                                          "give --overwrite to replace it"
                                                        : "; choose another --out"));
}

run::ExistingRun existing_run(const MiniAppOptions& options, bool is_empty,
                              const std::filesystem::path& restart) {
  if (options.overwrite) return run::ExistingRun::overwrite;
  if (!restart.empty()) return run::ExistingRun::resume;
  if (options.restart == "auto") return run::ExistingRun::overwrite;
  return is_empty ? run::ExistingRun::overwrite : run::ExistingRun::refuse;
}

void print_summary(const run::ResultDocument& result, const std::filesystem::path& directory) {
  std::printf("%s on %s: %lld steps to t = %g s in %.3g s\n", result.scene.c_str(), result.backend.c_str(),
              static_cast<long long>(result.steps), result.time, result.timing.wall_s);
  for (const run::Check& check : result.checks)
    std::printf("  %-16s %.4g  (bar %.4g)  %s\n", check.name.c_str(), check.value, check.bar,
                check.passed ? "passed" : "FAILED");
  std::printf("files in %s\n", directory.string().c_str());
}

/// The run itself, once its directory is there.
void run_in(run::RunDirectory& directory, const SpringsScene& scene, device::Backend backend,
            const MiniAppOptions& options, const std::filesystem::path& restart,
            run::ResultDocument& result) {
  const auto runtime = start_kokkos(options.kokkos);
  device::start_ledger();
  result.describe_device(std::string(device::name(backend)), device::device_facts());
  Simulation simulation(scene, {backend, options.seed_mode, options.quiet, restart, true, {}});
  directory.begin();
  directory.write_scene(print_springs_scene(scene));
  result.exit_code = simulation.run(directory, result);
  if (result.exit_code == ExitCode::interrupted) {
    result.message = "interrupted by a signal; restart.h5 is written";
    return;
  }
  result.energy = simulation.energies();
  verify(scene, simulation.final_state(), directory.file("history.csv"), result);
  if (const std::string failed = result.failed_check(); !failed.empty())
    throw Failure(ExitCode::verification_failed, failed);
}

/// One run of a scene, whose result.json tells how it ended, whatever happened.
ExitCode run_scene(const MiniAppOptions& options, const std::filesystem::path& file) {
  const auto begin = Clock::now();
  const std::string name = file.stem().string();
  const std::filesystem::path out = options.out.empty() ? std::filesystem::path("out") / name : options.out;
  const std::filesystem::path restart =
      options.restart.empty() ? std::filesystem::path() : run::restart_source(options.restart, out);
  const bool is_empty = !holds_results(out);
  run::RunDirectory directory(out, existing_run(options, is_empty, restart));
  run::ResultDocument result = run::new_result("drogue-springs", name);
  const auto stop_clock = [&] {
    result.timing.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  };
  try {
    const SpringsScene scene = read_springs_scene(file, options.set);
    const device::Backend backend = choose_backend(options.backend);
    if (!is_empty && !options.restart.empty() && !options.overwrite) require_same_scene(scene, out, restart);
    run_in(directory, scene, backend, options, restart, result);
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
        run::write_result(directory.file("result.json"), result);
    } catch (const Failure& second) {
      throw Failure(failure.code(), std::string(failure.what()) + "; and " + second.what());
    }
    if (failure.code() == ExitCode::verification_failed && !options.quiet) print_summary(result, out);
    throw failure;
  }
  stop_clock();
  run::write_result(directory.file("result.json"), result);
  if (!options.quiet) print_summary(result, out);
  return result.exit_code;
}

}  // namespace

ExitCode run_app(const MiniAppOptions& options) {
  if (!options.help.empty()) {
    std::cout << options.help;
    return ExitCode::ok;
  }
  if (options.version) {
    std::cout << version_text("drogue-springs");
    return ExitCode::ok;
  }
  if (options.list_scenes) {
    std::cout << scene::list_text(scene::list_scenes(scene_folder()));
    return ExitCode::ok;
  }
  require_one_rank("drogue-springs");
  const std::filesystem::path file = scene::find_scene(options.scene, scene_folder());
  if (options.check || options.print_scene) {
    const SpringsScene scene = read_springs_scene(file, options.set);
    std::cout << (options.print_scene ? print_springs_scene(scene) : quality_report(scene.mesh));
    return ExitCode::ok;
  }
  install_signal_handlers();
  if (!options.study.empty()) return run_study(options, file);
  return run_scene(options, file);
}

}  // namespace drogue::springs_app
