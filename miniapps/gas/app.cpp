#include "miniapps/gas/app.hpp"

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
#include "kernels/device/runtime.hpp"
#include "miniapps/gas/restart.hpp"
#include "miniapps/gas/scene_folder.hpp"
#include "miniapps/gas/simulation.hpp"
#include "miniapps/gas/study.hpp"

namespace drogue::gas_app {

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

/// `--restart auto` without a restart file begins anew, but only what was begun before.
void require_same_scene(const GasScene& scene, const std::filesystem::path& directory) {
  bool same = false;
  try {
    same = scene_fingerprint(read_gas_scene(directory / "scene.toml")) == scene_fingerprint(scene);
  } catch (const Failure&) {
    // No scene, or none of this program.
  }
  if (!same)
    throw Failure(ExitCode::usage, "'" + directory.string() +
                                       "' holds a run of another scene and no restart file; choose another "
                                       "--out, or give --overwrite to replace it");
}

run::ExistingRun existing_run(const MiniAppOptions& options, bool is_empty,
                              const std::filesystem::path& restart) {
  if (options.overwrite) return run::ExistingRun::overwrite;
  if (!restart.empty()) return run::ExistingRun::resume;
  if (options.restart == "auto") return run::ExistingRun::overwrite;
  return is_empty ? run::ExistingRun::overwrite : run::ExistingRun::refuse;
}

void print_summary(const run::ResultDocument& result, const std::filesystem::path& directory) {
  std::printf("%s on %s: %lld steps to t = %g s in %.3g s, limiter touches %lld, redone steps %lld\n",
              result.scene.c_str(), result.backend.c_str(), static_cast<long long>(result.steps), result.time,
              result.timing.wall_s, static_cast<long long>(result.limiter.touches),
              static_cast<long long>(result.limiter.redone_steps));
  for (const run::Check& check : result.checks)
    std::printf("  %-16s %.4g  (bar %.4g)  %s\n", check.name.c_str(), check.value, check.bar,
                check.passed ? "passed" : "FAILED");
  std::printf("files in %s\n", directory.string().c_str());
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
  run::ResultDocument result = run::new_result("drogue-gas", name);
  try {
    const GasScene scene = read_gas_scene(
        file, options.set, options.seed_mode ? SchemeSource::dissertation : SchemeSource::scene);
    const device::Backend backend = choose_backend(options.backend);
    if (!is_empty && options.restart == "auto" && restart.empty() && !options.overwrite)
      require_same_scene(scene, out);
    const auto runtime = start_kokkos(options.kokkos);
    device::start_ledger();
    describe_device(result, scene.parameters, backend);
    Simulation simulation(scene, {backend, options.seed_mode, options.quiet, restart});
    directory.begin();
    directory.write_scene(print_gas_scene(scene));
    result.exit_code = simulation.run(&directory, result);
    if (result.exit_code == ExitCode::ok) {
      result.exit_code = simulation.verify(&directory, result);
      if (result.exit_code == ExitCode::interrupted) simulation.write_restart(directory);
      if (const std::string failed = result.failed_check(); !failed.empty())
        throw Failure(ExitCode::verification_failed, failed);
    }
    if (result.exit_code == ExitCode::interrupted)
      result.message = "interrupted by a signal; restart.h5 is written";
  } catch (...) {
    const Failure failure = current_failure();
    result.exit_code = failure.code();
    result.message = failure.what();
    result.timing.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
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
  result.timing.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
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
    std::cout << version_text("drogue-gas");
    return ExitCode::ok;
  }
  if (options.list_scenes) {
    std::cout << scene::list_text(scene::list_scenes(scene_folder()));
    return ExitCode::ok;
  }
  require_one_rank("drogue-gas");
  const std::filesystem::path file = scene::find_scene(options.scene, scene_folder());
  if (options.check || options.print_scene) {
    const GasScene scene = read_gas_scene(
        file, options.set, options.seed_mode ? SchemeSource::dissertation : SchemeSource::scene);
    if (options.print_scene) std::cout << print_gas_scene(scene);
    return ExitCode::ok;
  }
  install_signal_handlers();
  if (!options.study.empty()) return run_study(options, file);
  return run_scene(options, file);
}

}  // namespace drogue::gas_app
