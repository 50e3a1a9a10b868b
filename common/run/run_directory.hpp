#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace drogue::run {

/// Treatment of a run that already is in the directory.
enum class ExistingRun {
  refuse,        ///< exit 2
  refuse_study,  ///< exit 2, for a study, which has no --restart
  overwrite,     ///< its files are removed by `begin`
  resume,        ///< its files are continued; `begin` removes result.json and pictures
};

/// Directory of one run, locked for the life of the object. A former run stays untouched until `begin`, so
/// that an invalid scene costs no result.
class RunDirectory {
 public:
  /// Creates `path` and its parents. Throws `Failure`: io_error if that fails, if the directory is not
  /// writable or if another process uses it; usage if it holds a run and `existing` is refuse.
  RunDirectory(std::filesystem::path path, ExistingRun existing);

  /// Removes or prepares the files of a former run, as `existing` states. Returns the names of the pictures
  /// that it removed.
  std::vector<std::string> begin();

  [[nodiscard]] bool begun() const noexcept { return _begun; }
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return _path; }

  /// Path of a file of the run, say `result.json`.
  [[nodiscard]] std::filesystem::path file(std::string_view name) const { return _path / name; }

  /// Writes the resolved scene, `scene.toml`.
  void write_scene(std::string_view toml) const;

 private:
  void lock();
  void unlock() noexcept;
  [[nodiscard]] std::vector<std::string> remove_leftovers() const;

  std::filesystem::path _path;
  ExistingRun _existing;
  bool _begun = false;
  int _lock = -1;
};

/// Names of all files that a run may leave. Only these, their temporary forms and the pictures of drogue-plot
/// are ever removed.
const std::vector<std::string>& run_file_names();

/// Names of the pictures that drogue-plot makes of a run, without their formats; `space_time_FIELD` is one
/// too. They are those of scripts/plot/picture_names.py.
const std::vector<std::string>& picture_names();

/// True if `directory` holds a file of a run.
bool holds_run(const std::filesystem::path& directory);

/// File for `--restart option`. For `auto` the restart.h5 of `directory`, or an empty path (start anew) if it
/// does not exist, so that one job script serves all submissions. Throws `Failure` (usage) if a named file
/// does not exist.
std::filesystem::path restart_source(const std::string& option, const std::filesystem::path& directory);

}  // namespace drogue::run
