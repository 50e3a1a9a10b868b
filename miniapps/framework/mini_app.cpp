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

/// Ends the work of the other ranks with rank 0, however that ends.
class EndOfRanks {
 public:
  explicit EndOfRanks(Communicator& communicator) : _communicator(communicator) {}
  ~EndOfRanks() { static_cast<void>(_communicator.broadcast({})); }
  EndOfRanks(const EndOfRanks&) = delete;
  EndOfRanks& operator=(const EndOfRanks&) = delete;

 private:
  Communicator& _communicator;
};

ExitCode run_on_ranks(const MiniApp& app, const MiniAppOptions& options,
                      const std::filesystem::path& folder) {
  Communicator communicator;
  install_signal_handlers();
  if (!communicator.is_root()) {
    try {
      app.serve(communicator, options);
    } catch (...) {
      communicator.abort();
    }
    return ExitCode::ok;  // rank 0 has the code of the run
  }
  const EndOfRanks end(communicator);
  return run_scene(app, options, scene::find_scene(options.scene, folder), &communicator);
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
  const bool on_ranks = launched_rank().ranks > 1;
  if (!app.serve) require_one_rank();
  if (on_ranks && !options.study.empty())
    throw Failure(ExitCode::usage, "--study runs on one rank, not " + std::to_string(launched_rank().ranks));
  run::h5::open_library();
  if (on_ranks && !options.check && !options.print_scene) return run_on_ranks(app, options, folder);
  const std::filesystem::path file = scene::find_scene(options.scene, folder);
  if (options.check || options.print_scene) {
    const std::unique_ptr<Scene> scene = app.read(file, options.set, options.baseline);
    if (options.print_scene) std::cout << scene->print();
    if (options.check && !options.quiet) {
      for (const std::string& notice : scene->notices()) print_notice(app.program(), notice);
      std::cout << scene->check_report();
    }
    return ExitCode::ok;
  }
  install_signal_handlers();
  if (options.study.empty()) return run_scene(app, options, file, nullptr);
  if (!app.study) throw Failure(ExitCode::usage, "this program has no --study");
  const ExitCode code = app.study(options, file);
  if (code == ExitCode::interrupted)
    print_notice(app.program(), "interrupted by a signal; the tables hold the finished points");
  return code;
}

int run_mini_app(const MiniApp& app, int argc, char** argv) {
  return run_program(app.program(), [&] {
    return run_command(app,
                       parse_mini_app_options(app.program(), app.description, argc, argv, app.has_baseline));
  });
}

}  // namespace drogue::framework
