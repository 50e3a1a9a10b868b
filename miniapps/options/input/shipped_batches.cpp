#include "miniapps/options/batches.hpp"

#include <algorithm>
#include <vector>

#include "common/csv/line_reader.hpp"
#include "common/program/failure.hpp"
#include "common/scene/nearest.hpp"

namespace drogue::options_app {
namespace {

/// Where the shipped batches are: beside the installed or bundled program, else in the source tree it was
/// built from.
std::filesystem::path batch_folder() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  std::filesystem::path installed = program.parent_path().parent_path() / "share/drogue/batches";
  if (!error && std::filesystem::is_directory(installed, error)) return installed;
  return DROGUE_OPTIONS_BATCHES;
}

std::vector<std::filesystem::path> shipped() {
  std::vector<std::filesystem::path> files;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(batch_folder(), missing))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::filesystem::path find_batch(const std::string& argument) {
  std::error_code unreadable;
  // What is there under that name is read, or refused for what it is.
  if (std::filesystem::exists(argument, unreadable)) return argument;
  std::vector<std::string> names;
  for (const std::filesystem::path& file : shipped()) {
    if (file.stem() == argument) return file;
    names.push_back(file.stem().string());
  }
  const std::string hint =
      names.empty() ? "" : "; " + scene::suggestion(std::filesystem::path(argument).stem().string(), names);
  throw Failure(ExitCode::usage,
                "there is no file " + argument + " and no shipped batch of that name" + hint);
}

std::string batch_list() {
  std::string text;
  for (const std::filesystem::path& file : shipped()) {
    csv::LineReader reader(file);
    csv::Line line;
    int rows = -1;  // the header is no row
    while (reader.next(line)) ++rows;
    text += file.stem().string() + "  " + std::to_string(rows) + " rows\n";
  }
  return text;
}

}  // namespace drogue::options_app
