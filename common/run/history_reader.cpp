#include "common/run/history_reader.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>

#include "common/program/failure.hpp"

namespace drogue::run {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return cells;
}

}  // namespace

History read_history(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) throw Failure(ExitCode::io_error, "cannot read '" + file.string() + "'");
  std::vector<std::string> names = cells_of(line);
  for (std::string& name : names) name = name.substr(0, name.find(" ["));
  History history;
  while (std::getline(stream, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != names.size())
      throw Failure(ExitCode::io_error,
                    "'" + file.string() + "' has a row of another length than its header");
    for (std::size_t k = 0; k < cells.size(); ++k) {
      double value = 0.0;
      const std::string& text = cells[k];
      if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc())
        throw Failure(ExitCode::io_error, "'" + file.string() + "' holds '" + text + "', which is no number");
      history[names[k]].push_back(value);
    }
  }
  return history;
}

}  // namespace drogue::run
