#include "miniapps/framework/mini_app.hpp"

#include <iostream>

#include "common/program/communicator.hpp"
#include "common/program/mpi_guard.hpp"
#include "common/program/program.hpp"
#include "common/program/provenance.hpp"
#include "common/program/shipped_folder.hpp"
#include "common/program/signals.hpp"
#include "common/run/hdf5/hdf5_call.hpp"
#include "common/scene/library.hpp"
#include "miniapps/framework/scene_run.hpp"

namespace drogue::framework {
namespace {

ExitCode run_on_all_ranks(const MiniApp& app, const MiniAppOptions& options,
                          const std::filesystem::path& folder) {
  Communicator communicator;
  install_signal_handlers();
  try {
    std::filesystem::path file;
    communicator.run_collectively([&] { file = scene::find_scene(options.scene, folder); });
    const ExitCode code = run_scene(app, options, file, communicator);
    return communicator.is_root() ? code : ExitCode::ok;
  } catch (const Failure&) {
    // All ranks throw the same failure; rank 0 reports it.
    if (communicator.is_root()) throw;
    return ExitCode::ok;
  }
}

}  // namespace

std::filesystem::path find_scene_folder(const std::string& name, const std::filesystem::path& source_folder) {
  return find_shipped_folder("scenes/" + name, source_folder);
}

ExitCode run_command(const MiniApp& app, const MiniAppOptions& options) {
  if (!options.help.empty()) {
    std::cout << options.help;
    return ExitCode::ok;
  }
  if (options.version) {
    std::cout << version_text(app.program());
    return ExitCode::ok;
  }
  const std::filesystem::path folder = find_scene_folder(app.name, app.scene_folder);
  if (options.list_scenes) {
    std::cout << scene::list_text(scene::list_scenes(folder));
    return ExitCode::ok;
  }
  if (!app.runs_on_ranks) require_one_rank();
  if (const int ranks = launched_rank().ranks; ranks > 1 && !options.study.empty())
    throw Failure(ExitCode::usage, "--study runs on one rank, not " + std::to_string(ranks));
  run::h5::open_library();
  if (options.study.empty() && !options.check && !options.print_scene)
    return run_on_all_ranks(app, options, folder);
  if (!options.study.empty() && !app.study) throw Failure(ExitCode::usage, "this program has no --study");
  const std::filesystem::path file = scene::find_scene(options.scene, folder);
  if (options.check || options.print_scene) {
    const std::unique_ptr<Scene> scene = app.read(file, options.set, options.baseline);
    const std::string study = options.study.empty() ? "" : app.check_study(options, file);
    if (options.print_scene) std::cout << scene->print();
    if (options.check && !options.quiet) {
      for (const std::string& notice : scene->notices()) print_notice(app.program(), notice);
      std::cout << scene->check_report() << study;
    }
    return ExitCode::ok;
  }
  install_signal_handlers();
  const ExitCode code = app.study(options, file);
  if (code == ExitCode::interrupted)
    print_notice(app.program(),
                 "interrupted by a signal; the tables hold the finished points, and "
                 "--overwrite begins the study anew");
  return code;
}

int run_mini_app(const MiniApp& app, int argc, char** argv) {
  return run_program(app.program(), [&] {
    return run_command(app,
                       parse_mini_app_options(app.program(), app.description, argc, argv, app.has_baseline));
  });
}

}  // namespace drogue::framework
