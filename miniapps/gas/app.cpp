#include "miniapps/gas/app.hpp"

#include <cstdio>
#include <iostream>

#include "common/program/mpi_guard.hpp"
#include "common/program/program.hpp"
#include "common/program/provenance.hpp"
#include "common/program/signals.hpp"
#include "common/run/one_run.hpp"
#include "common/scene/library.hpp"
#include "kernels/device/profiling_counters.hpp"
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

void print_steps(const run::ResultDocument& result) {
  std::printf("%s on %s: %lld steps to t = %g s in %.3g s, limiter touches %lld, redone steps %lld\n",
              result.scene.c_str(), result.backend.c_str(), static_cast<long long>(result.steps), result.time,
              result.timing.wall_s, static_cast<long long>(result.limiter.touches),
              static_cast<long long>(result.limiter.redone_steps));
}

/// The run itself, once its directory is there.
void run_in(run::RunDirectory& directory, const GasScene& scene, device::Backend backend,
            const MiniAppOptions& options, const std::filesystem::path& restart,
            run::ResultDocument& result) {
  const auto runtime = start_kokkos(options.kokkos);
  device::start_profiling();
  describe_device(result, scene.parameters, backend);
  Simulation simulation(scene, {backend, options.seed_mode, options.quiet, restart});
  directory.begin();
  directory.write_scene(print_gas_scene(scene));
  result.exit_code = simulation.run(&directory, result);
  if (result.exit_code != ExitCode::ok) return;
  result.exit_code = simulation.verify(&directory, result);
  if (result.exit_code == ExitCode::interrupted) simulation.write_restart(directory);
  if (const std::string failed = result.failed_check(); !failed.empty())
    throw Failure(ExitCode::verification_failed, failed);
}

ExitCode run_scene(const MiniAppOptions& options, const std::filesystem::path& file) {
  GasScene scene;
  device::Backend backend{};
  const auto read = [&] {
    scene = read_gas_scene(file, options.set,
                           options.seed_mode ? SchemeSource::dissertation : SchemeSource::scene);
    backend = choose_backend(options.backend);
  };
  const auto is_same_scene = [&](const std::filesystem::path& other) {
    return scene_fingerprint(read_gas_scene(other)) == scene_fingerprint(scene);
  };
  const auto execute = [&](run::RunDirectory& directory, const std::filesystem::path& restart,
                           run::ResultDocument& result) {
    run_in(directory, scene, backend, options, restart, result);
  };
  return run::carry_out({"drogue-gas", file.stem().string(), read, is_same_scene, execute, print_steps},
                        options);
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
