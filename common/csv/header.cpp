#include "common/csv/header.hpp"

#include <algorithm>
#include <utility>

#include "common/csv/fields.hpp"
#include "common/scene/nearest.hpp"

namespace drogue::csv {

Failure invalid_at(const std::filesystem::path& file, std::int64_t line, const std::string& sentence) {
  return {ExitCode::invalid_scene, file.string() + ":" + std::to_string(line) + ": " + sentence};
}

Header read_header(LineReader& reader, const std::vector<std::string>& names) {
  Line line;
  if (!reader.next(line))
    throw invalid_at(reader.file(), 1, "the file is empty; its first line names the columns");
  if (line.too_long)
    throw invalid_at(reader.file(), line.number,
                     "the header is longer than " + std::to_string(LineReader::longest) + " bytes");
  Fields fields;
  if (const std::string_view wrong = fields.split(line.text); !wrong.empty())
    throw invalid_at(reader.file(), line.number, "the header cannot be read: " + std::string(wrong));
  std::vector<int> places(names.size(), -1);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto name = std::find(names.begin(), names.end(), fields[i]);
    if (name == names.end())
      throw invalid_at(reader.file(), line.number,
                       "unknown column " + shown(fields[i]) + "; " + scene::suggestion(fields[i], names));
    int& place = places[static_cast<std::size_t>(name - names.begin())];
    if (place >= 0) throw invalid_at(reader.file(), line.number, "column \"" + *name + "\" is named twice");
    place = static_cast<int>(i);
  }
  return {line.number, std::move(places)};
}

}  // namespace drogue::csv
