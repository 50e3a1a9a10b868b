#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "common/program/mini_app_options.hpp"
#include "common/run/result_document.hpp"
#include "common/run/run_directory.hpp"

namespace drogue::run {

/// What a mini-app does for one run of a scene. Any of it may throw Failure.
struct OneRun {
  std::string program, scene;  ///< names in result.json
  /// Reads the scene and chooses the backend; a former run in the directory is not touched yet.
  std::function<void()> read;
  /// Whether the scene.toml of a run is of the scene that was read.
  std::function<bool(const std::filesystem::path&)> is_same_scene;
  /// Begins the directory, runs from `restart`, a file or none, and sets the result's exit code, 0 or 130.
  std::function<void(RunDirectory&, const std::filesystem::path& restart, ResultDocument&)> execute;
  /// Prints a line on the steps.
  std::function<void(const ResultDocument&)> print_steps;
};

/// Does the run in the directory that the options ask for. result.json tells how it ended, whatever happened,
/// but for a slip in the scene or the command line, which leaves a former run as it is. Throws Failure.
ExitCode carry_out(const OneRun& run, const MiniAppOptions& options);

}  // namespace drogue::run
