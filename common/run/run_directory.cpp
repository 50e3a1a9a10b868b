#include "common/run/run_directory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "common/run/files/atomic_file.hpp"
#include "common/run/files/io_error.hpp"

namespace drogue::run {
namespace {

constexpr const char* lock_name = ".lock";

/// True if `descriptor` locks the file that is still under `path`: a run that just ended may have removed it.
bool still_there(int descriptor, const std::filesystem::path& path) {
  struct stat locked = {}, present = {};
  return fstat(descriptor, &locked) == 0 && stat(path.c_str(), &present) == 0 &&
         locked.st_ino == present.st_ino;
}

/// True for `.result.json.1234.tmp`, left by a run that was killed while it wrote result.json.
bool is_leftover(const std::string& name) {
  if (!name.starts_with('.') || !name.ends_with(".tmp")) return false;
  const auto& names = run_file_names();
  return std::any_of(names.begin(), names.end(),
                     [&name](const std::string& file) { return name.starts_with("." + file + "."); });
}

/// Name of a picture without its format and, in `.fields.1234.png` of a drogue-plot that was killed, without
/// the process.
std::string picture_name(const std::filesystem::path& file) {
  std::filesystem::path name = file.stem();
  if (!name.string().starts_with('.')) return name.string();
  const std::string process = name.extension().string();
  if (process.size() < 2 || process.find_first_not_of("0123456789", 1) != std::string::npos) return {};
  return name.stem().string().substr(1);
}

/// True for a picture that drogue-plot made of a former run.
bool is_picture(const std::filesystem::path& file) {
  constexpr std::array formats = {".png", ".pdf", ".svg", ".gif", ".mp4"};
  const std::string name = picture_name(file);
  return std::ranges::count(formats, file.extension().string()) != 0 &&
         (std::ranges::count(picture_names(), name) != 0 || name.starts_with("space_time_"));
}

/// Succeeds if there is no such file.
void remove_file(const std::filesystem::path& file) {
  if (unlink(file.c_str()) != 0 && errno != ENOENT) throw io_failure("remove", file, errno);
}

}  // namespace

const std::vector<std::string>& run_file_names() {
  static const std::vector<std::string> names = {"scene.toml", "result.json", "history.csv",
                                                 "fields.h5",  "fields.xdmf", "restart.h5",
                                                 "study.csv",  "study.json",  "runs.csv"};
  return names;
}

const std::vector<std::string>& picture_names() {
  static const std::vector<std::string> names = {"fields",   "history",  "study", "profiles",
                                                 "spectrum", "canopies", "forces"};
  return names;
}

bool holds_run(const std::filesystem::path& directory) {
  const auto& names = run_file_names();
  return std::any_of(names.begin(), names.end(), [&directory](const std::string& name) {
    std::error_code ignored;
    return std::filesystem::exists(directory / name, ignored);
  });
}

RunDirectory::RunDirectory(std::filesystem::path path, ExistingRun existing)
    : _path(std::move(path)), _existing(existing) {
  std::error_code error;
  std::filesystem::create_directories(_path, error);
  if (error) throw io_failure("create the run directory", _path, error.value());
  lock();
  const bool is_study = existing == ExistingRun::refuse_study;
  if ((existing == ExistingRun::refuse || is_study) && holds_run(_path)) {
    unlock();
    throw Failure(ExitCode::usage, "'" + _path.string() +
                                       "' already holds a run; choose another --out, or give --overwrite to "
                                       "replace it" +
                                       (is_study ? "" : " or --restart to continue it"));
  }
}

std::vector<std::string> RunDirectory::begin() {
  _begun = true;
  if (_existing == ExistingRun::resume)
    remove_file(_path / "result.json");
  else if (_existing == ExistingRun::overwrite)
    for (const std::string& name : run_file_names()) remove_file(_path / name);
  else
    return {};
  return remove_leftovers();
}

RunDirectory::~RunDirectory() { unlock(); }

void RunDirectory::lock() {
  const std::filesystem::path file = _path / lock_name;
  while (true) {
    _lock = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (_lock < 0) throw io_failure("write to the run directory", _path, errno);
    if (flock(_lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(_lock);
      throw Failure(ExitCode::io_error,
                    "the run directory '" + _path.string() + "' is in use by another process");
    }
    // File systems without locks (some Lustre mounts) are used without one.
    if (still_there(_lock, file)) return;
    close(_lock);
  }
}

void RunDirectory::unlock() noexcept {
  // Remove the file while it is locked: lock() detects the removal.
  unlink((_path / lock_name).c_str());
  close(_lock);
}

/// Returns the names of pictures.
std::vector<std::string> RunDirectory::remove_leftovers() const {
  std::vector<std::filesystem::path> leftovers;
  for (const auto& entry : std::filesystem::directory_iterator(_path)) {
    const std::filesystem::path& file = entry.path();
    if (is_leftover(file.filename().string()) || is_picture(file)) leftovers.push_back(file);
  }
  std::vector<std::string> pictures;
  for (const auto& file : leftovers) {
    remove_file(file);
    if (is_picture(file)) pictures.push_back(file.filename().string());
  }
  std::ranges::sort(pictures);
  return pictures;
}

void RunDirectory::write_scene(std::string_view toml) const {
  write_file_atomically(file("scene.toml"), toml);
}

std::filesystem::path restart_source(const std::string& option, const std::filesystem::path& directory) {
  const std::filesystem::path file =
      option == "auto" ? directory / "restart.h5" : std::filesystem::path(option);
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) return file;
  if (option == "auto") return {};
  throw Failure(ExitCode::usage, "the restart file '" + option + "' does not exist");
}

}  // namespace drogue::run
