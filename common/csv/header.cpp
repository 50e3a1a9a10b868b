#include "common/csv/header.hpp"

#include <algorithm>
#include <utility>

#include "common/csv/fields.hpp"
#include "common/scene/nearest.hpp"

namespace drogue::csv {

Failure invalid_at(const std::filesystem::path& file, std::int64_t line, const std::string& sentence) {
  return {ExitCode::invalid_scene, file.string() + ":" + std::to_string(line) + ": " + sentence};
}

namespace {

constexpr std::string_view cr_alone = "the lines end in CR alone; LF or CRLF must end them";

/// Name of the separator of a column that is not split, or nullptr.
const char* separator_in(std::string_view text) {
  if (text.find(';') != std::string_view::npos) return "a semicolon";
  if (text.find('\t') != std::string_view::npos) return "a tab";
  return text.find('|') != std::string_view::npos ? "a vertical line" : nullptr;
}

/// True for the beginning of UTF-32, with a byte-order mark or with three bytes of 0 beside a character.
bool is_utf32(std::string_view text) {
  constexpr std::string_view zeros("\0\0\0", 3);
  if (text.starts_with(std::string_view("\xFF\xFE\0\0", 4)) ||
      text.starts_with(std::string_view("\0\0\xFE\xFF", 4)))
    return true;
  return text.size() > 3 && (text.starts_with(zeros) || text.substr(1).starts_with(zeros));
}

/// True for the beginning of UTF-16, with a byte-order mark or with every other byte 0.
bool is_utf16(std::string_view text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return true;
  return text.size() > 2 &&
         ((text[0] == '\0' && !is_control(text[1])) || (text[1] == '\0' && !is_control(text[0])));
}

/// Fault that makes a file unreadable, as a sentence; empty if it can be read.
std::string fault_of(const Line& line) {
  if (line.too_long)
    return line.holds_cr ? std::string(cr_alone)
                         : "the header is longer than " + std::to_string(LineReader::longest) + " bytes";
  if (is_utf32(line.text)) return "the encoding is UTF-32; save the file as UTF-8";
  if (is_utf16(line.text)) return "the encoding is UTF-16; save the file as UTF-8";
  return line.text.find('\r') != std::string_view::npos ? std::string(cr_alone) : std::string();
}

std::string unknown_column(std::string_view name, const std::vector<std::string>& names) {
  const std::string sentence = "unknown column " + shown(name);
  if (const char* separator = separator_in(name))
    return sentence + ": the separator is " + separator +
           "; separate columns by commas, and write decimals with points";
  if (name.empty())
    return sentence + ": a separator, the comma, has no name beside it; remove the empty columns";
  return sentence + "; " + scene::suggestion(std::string(name), names);
}

/// The line without the quotes around all of it.
std::string_view unquoted(std::string_view text) {
  return text.size() > 1 && text.front() == '"' && text.back() == '"' ? text.substr(1, text.size() - 2)
                                                                      : text;
}

/// True for the line by which spreadsheets name the separator.
bool names_separator(std::string_view text) { return text.starts_with("sep=") || text.starts_with("SEP="); }

}  // namespace

Header read_header(LineReader& reader, const std::vector<std::string>& names) {
  Line line;
  bool is_present = reader.next(line);
  if (const std::string_view text = unquoted(line.text); is_present && names_separator(text)) {
    const std::string_view separator = text.substr(4);
    if (const char* other = separator_in(separator))
      throw invalid_at(reader.file(), line.number,
                       std::string("the separator is ") + other + "; separate columns by commas");
    is_present = reader.next(line);
  }
  if (!is_present) throw invalid_at(reader.file(), 1, "the file is empty; its first line names the columns");
  if (const std::string fault = fault_of(line); !fault.empty())
    throw invalid_at(reader.file(), line.number, fault);
  Fields fields;
  if (const std::string_view wrong = fields.split(line.text); !wrong.empty())
    throw invalid_at(reader.file(), line.number, "the header cannot be read: " + std::string(wrong));
  std::vector<int> places(names.size(), -1);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto name = std::find(names.begin(), names.end(), fields[i]);
    if (name == names.end()) throw invalid_at(reader.file(), line.number, unknown_column(fields[i], names));
    int& place = places[static_cast<std::size_t>(name - names.begin())];
    if (place >= 0) throw invalid_at(reader.file(), line.number, "column \"" + *name + "\" is named twice");
    place = static_cast<int>(i);
  }
  if (fields.size() > 1) reader.skip_empty_rows();
  return {line.number, std::move(places)};
}

}  // namespace drogue::csv
