#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace drogue::run {

/// What becomes of a run that is already in the directory.
enum class ExistingRun {
  refuse,     ///< exit 2
  overwrite,  ///< its files are removed by `begin`
  resume,     ///< they stay and are continued; `begin` removes result.json and the pictures, which tell of an
              ///< end
};

/// The directory of one run, locked as long as this object lives. Two runs never share one. A former run
/// stays as it is until `begin`, so that a scene with a slip in it costs nobody a result.
class RunDirectory {
 public:
  /// Creates `path` and its parents where missing. Throws Failure(io_error) if that fails, if the directory
  /// cannot be written or if another process runs in it, Failure(usage) if it holds a run and `existing` is
  /// refuse.
  RunDirectory(std::filesystem::path path, ExistingRun existing);

  /// Makes room for the new run, which from here on will not be refused.
  void begin();

  [[nodiscard]] bool begun() const noexcept { return _begun; }
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return _path; }

  /// Path of one of the files that a run writes, say `result.json`.
  [[nodiscard]] std::filesystem::path file(std::string_view name) const { return _path / name; }

  /// Writes the resolved scene, `scene.toml`.
  void write_scene(std::string_view toml) const;

 private:
  void lock();
  void unlock() noexcept;
  void remove_former_run() const;
  void remove_leftovers() const;

  std::filesystem::path _path;
  ExistingRun _existing;
  bool _begun = false;
  int _lock = -1;
};

/// Names of all files that a run may leave. Only these, their temporary forms and the pictures that
/// drogue-plot makes of them are ever removed.
const std::vector<std::string>& run_file_names();

/// True if `directory` holds a file of a run.
bool holds_run(const std::filesystem::path& directory);

/// The file that `--restart option` means: for `auto` the restart.h5 of `directory`, or an empty path (start
/// anew) if there is none, so that one job script serves the first and every later submission. Throws
/// Failure(usage) if a named file does not exist.
std::filesystem::path restart_source(const std::string& option, const std::filesystem::path& directory);

}  // namespace drogue::run
