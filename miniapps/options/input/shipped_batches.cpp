#include "miniapps/options/input/shipped_batches.hpp"

#include <algorithm>
#include <vector>

#include "common/csv/line_reader.hpp"
#include "common/program/failure.hpp"
#include "common/program/shipped_folder.hpp"
#include "common/scene/nearest.hpp"

namespace drogue::options_app {
namespace {

std::vector<std::filesystem::path> shipped_batches() {
  const std::filesystem::path folder = find_shipped_folder("batches", DROGUE_OPTIONS_BATCHES);
  std::vector<std::filesystem::path> files;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder, missing))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::filesystem::path find_batch(const std::string& argument) {
  std::error_code unreadable;
  // The reader rejects a path that is no regular file, and states why.
  if (std::filesystem::exists(argument, unreadable)) return argument;
  if (argument == "-")
    throw Failure(
        ExitCode::usage,
        "a batch is read twice, so that it cannot come from standard input; give the name of a file");
  std::vector<std::string> names;
  for (const std::filesystem::path& file : shipped_batches()) {
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
  for (const std::filesystem::path& file : shipped_batches()) {
    csv::LineReader reader(file);
    csv::Line line;
    int rows = -1;  // does not count the header
    while (reader.next(line)) ++rows;
    text += file.stem().string() + "  " + std::to_string(rows) + " rows\n";
  }
  return text;
}

}  // namespace drogue::options_app
