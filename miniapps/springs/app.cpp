#include "miniapps/springs/app.hpp"

#include <cstdio>
#include <iostream>

#include "common/program/mpi_guard.hpp"
#include "common/program/program.hpp"
#include "common/program/provenance.hpp"
#include "common/program/signals.hpp"
#include "common/run/one_run.hpp"
#include "common/scene/library.hpp"
#include "kernels/device/profiling_counters.hpp"
#include "kernels/mesh/quality.hpp"
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

void print_steps(const run::ResultDocument& result) {
  std::printf("%s on %s: %lld steps to t = %g s in %.3g s\n", result.scene.c_str(), result.backend.c_str(),
              static_cast<long long>(result.steps), result.time, result.timing.wall_s);
}

/// The run itself, once its directory is there.
void run_in(run::RunDirectory& directory, const SpringsScene& scene, device::Backend backend,
            const MiniAppOptions& options, const std::filesystem::path& restart,
            run::ResultDocument& result) {
  const auto runtime = start_kokkos(options.kokkos);
  device::start_profiling();
  result.describe_device(std::string(device::name(backend)), device::device_facts());
  Simulation simulation(scene, {backend, options.seed_mode, options.quiet, restart, true, {}});
  directory.begin();
  directory.write_scene(print_springs_scene(scene));
  result.exit_code = simulation.run(directory, result);
  if (result.exit_code == ExitCode::interrupted) return;
  result.energy = simulation.energies();
  verify(scene, simulation.final_state(), directory.file("history.csv"), result);
  if (const std::string failed = result.failed_check(); !failed.empty())
    throw Failure(ExitCode::verification_failed, failed);
}

ExitCode run_scene(const MiniAppOptions& options, const std::filesystem::path& file) {
  SpringsScene scene;
  device::Backend backend{};
  const auto read = [&] {
    scene = read_springs_scene(file, options.set);
    backend = choose_backend(options.backend);
  };
  // A copy of the scene in another folder finds no mesh file beside it: then nothing tells.
  const auto is_same_scene = [&](const std::filesystem::path& other) {
    return scene_fingerprint(read_springs_scene(other)) == scene_fingerprint(scene);
  };
  const auto execute = [&](run::RunDirectory& directory, const std::filesystem::path& restart,
                           run::ResultDocument& result) {
    run_in(directory, scene, backend, options, restart, result);
  };
  return run::carry_out({"drogue-springs", file.stem().string(), read, is_same_scene, execute, print_steps},
                        options);
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
