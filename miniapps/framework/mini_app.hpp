#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/program/mini_app_options.hpp"
#include "miniapps/framework/simulation.hpp"

namespace drogue::framework {

/// A scene-driven program.
struct MiniApp {
  std::string name;                    ///< `gas`; the program is drogue-gas
  std::string description;             ///< the sentence of --help
  std::filesystem::path scene_folder;  ///< shipped scenes in the source tree; empty: none
  bool has_baseline = false;           ///< offers --seed-mode, the scheme of [Shi]

  /// Reads and checks a scene with its `--set` assignments. `baseline` requests the scheme of [Shi]. Throws
  /// `Failure`: usage, invalid_scene.
  std::function<std::unique_ptr<Scene>(const std::filesystem::path& file,
                                       const std::vector<std::string>& assignments, bool baseline)>
      read = {};

  /// Runs `--study` on a scene file; empty: the program has no studies.
  std::function<ExitCode(const MiniAppOptions& options, const std::filesystem::path& file)> study = {};

  /// Refuses what `study` does before its first run, and returns what `--check` prints on it.
  std::function<std::string(const MiniAppOptions& options, const std::filesystem::path& file)> check_study =
      {};

  bool runs_on_ranks = false;  ///< scenes run on several ranks of MPI, without studies

  /// Groups of result.json that exist however the run ends.
  run::Metrics metrics = {};

  /// Text behind the printed line on the steps; may be empty.
  std::function<std::string(const run::ResultDocument&)> summary = {};

  /// Lines behind those of the checks; may be empty.
  std::function<std::string(const run::ResultDocument&)> report = {};

  [[nodiscard]] std::string program() const { return "drogue-" + name; }
};

/// Folder of the shipped scenes of mini-app `name`: beside the installed or bundled program, else
/// `source_folder`. Does not throw.
[[nodiscard]] std::filesystem::path find_scene_folder(const std::string& name,
                                                      const std::filesystem::path& source_folder);

/// Does what the command line of a mini-app requests. Throws `Failure`; returns the exit code otherwise, also
/// of an interrupted run.
ExitCode run_command(const MiniApp& app, const MiniAppOptions& options);

/// The whole main program: parses the command line, runs it, and prints errors. Returns the exit code of the
/// process. Does not throw.
int run_mini_app(const MiniApp& app, int argc, char** argv);

}  // namespace drogue::framework
