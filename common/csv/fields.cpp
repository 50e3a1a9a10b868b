#include "common/csv/fields.hpp"

#include <algorithm>

namespace drogue::csv {
namespace {

bool is_gap(char c) { return c == ' ' || c == '\t'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_gap(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_gap(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

std::string_view Fields::split(std::string_view line) {
  _values.clear();
  // Fields are short: one pass is faster than a search for each comma.
  std::size_t begin = 0;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (line[at] == ',') {
      _values.push_back(trimmed(line.substr(begin, at - begin)));
      begin = at + 1;
    } else if (line[at] == '"') {
      _values.clear();
      return split_quoted(line);
    }
  }
  _values.push_back(trimmed(line.substr(begin)));
  return {};
}

std::string_view Fields::split_quoted(std::string_view line) {
  _unquoted.clear();
  std::size_t at = 0;
  for (;;) {
    while (at < line.size() && is_gap(line[at])) ++at;
    if (at == line.size() || line[at] != '"') {
      const std::size_t comma = std::min(line.find(',', at), line.size());
      const std::string_view field = trimmed(line.substr(at, comma - at));
      if (field.find('"') != std::string_view::npos)
        return "a quote stands inside a field that is not quoted";
      _values.push_back(field);
      at = comma;
    } else {
      const std::size_t begin = ++at;
      bool doubled = false;
      for (; at < line.size(); ++at) {
        if (line[at] != '"') continue;
        if (at + 1 == line.size() || line[at + 1] != '"') break;
        doubled = true;
        ++at;
      }
      if (at == line.size()) return "a quoted field does not end on its line";
      std::string_view field = line.substr(begin, at - begin);
      if (doubled) {
        std::string& text = _unquoted.emplace_back();
        for (std::size_t i = 0; i < field.size(); ++i) {
          text += field[i];
          if (field[i] == '"') ++i;
        }
        field = text;
      }
      _values.push_back(field);
      ++at;
      while (at < line.size() && is_gap(line[at])) ++at;
      if (at < line.size() && line[at] != ',') return "text follows the quote that ends a field";
    }
    if (at == line.size()) return {};
    ++at;
  }
}

void append_field(std::string& out, std::string_view text) {
  const bool plain = text.find_first_of(",\"\r\n") == std::string_view::npos && trimmed(text) == text;
  if (plain) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

}  // namespace drogue::csv
