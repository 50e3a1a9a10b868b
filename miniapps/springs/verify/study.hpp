#pragma once

#include <filesystem>

#include "common/program/mini_app_options.hpp"
#include "common/run/run_directory.hpp"
#include "miniapps/framework/study.hpp"
#include "miniapps/springs/scene/scene.hpp"

namespace drogue::springs_app {

/// A folder for the files that repeated runs are verified by. The destructor removes it.
class ScratchDirectory {
 public:
  /// Throws `Failure` (io_error) if the folder cannot be created.
  explicit ScratchDirectory(const std::filesystem::path& folder);
  ~ScratchDirectory();
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;

  [[nodiscard]] run::RunDirectory& directory() { return _directory; }

 private:
  std::filesystem::path _folder;
  run::RunDirectory _directory;
};

/// Runs `scene` until `repeats` is satisfied. `errors` and `checks` are those of the scene's [verify];
/// `series` holds `time` (s), `kinetic` and `elastic` (J), `length` of strings (m) and `area` of cloth (m^2).
/// A failed run is recorded in `code` and `message`.
framework::RepeatedRun run_repeatedly(const SpringsScene& scene, device::Backend backend,
                                      const study::Repeats& repeats, ScratchDirectory& scratch);

/// Refuses what `run_study` does before its first run; returns what `--check` prints on the study. Throws
/// `Failure`: usage, invalid_scene.
std::string check_study(const MiniAppOptions& options, const std::filesystem::path& file);

/// Runs the scene over the product of the axes of `--study`, and writes study.csv, study.json and their
/// picture. Returns `ok` or `interrupted`. Throws `Failure`: usage for an invalid axis, otherwise like a run.
ExitCode run_study(const MiniAppOptions& options, const std::filesystem::path& file);

}  // namespace drogue::springs_app
