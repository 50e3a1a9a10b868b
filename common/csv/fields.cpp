#include "common/csv/fields.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace drogue::csv {
namespace {

bool is_gap(char c) { return c == ' ' || c == '\t'; }

inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_gap(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_gap(text.back())) text.remove_suffix(1);
  return text;
}

/// Loads eight characters, the first into the lowest byte. A loop over single characters takes three times as
/// long.
using Word = std::uint64_t;
static_assert(std::endian::native == std::endian::little);

Word word_at(std::string_view line, std::size_t at) {
  Word word = 0;
  if (at + sizeof word <= line.size()) {
    std::memcpy(&word, line.data() + at, sizeof word);
  } else {
    std::memcpy(&word, line.data() + at, line.size() - at);
  }
  return word;
}

/// Sets the highest bit of each byte of `word` that equals `c`.
Word places_of(char c, Word word) {
  constexpr Word ones = 0x0101010101010101, low = 0x7f7f7f7f7f7f7f7f;
  const Word zero_there = word ^ (ones * static_cast<unsigned char>(c));
  return ~(((zero_there & low) + low) | zero_there | low);
}

bool needs_quotes(char c) { return c == ',' || c == '"' || c == '\r' || c == '\n'; }

}  // namespace

std::string_view Fields::split(std::string_view line) {
  _values.clear();
  std::size_t begin = 0;
  for (std::size_t at = 0; at < line.size(); at += sizeof(Word)) {
    const Word word = word_at(line, at);
    if (places_of('"', word) != 0) {
      _values.clear();
      return split_quoted(line);
    }
    for (Word commas = places_of(',', word); commas != 0; commas &= commas - 1) {
      const std::size_t comma = at + static_cast<std::size_t>(std::countr_zero(commas)) / 8;
      _values.push_back(trimmed(line.substr(begin, comma - begin)));
      begin = comma + 1;
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
      ++at;
      while (at < line.size() && is_gap(line[at])) ++at;
      if (at < line.size() && line[at] != ',') return "text follows the quote that ends a field";
      _values.push_back(field);
    }
    if (at == line.size()) return {};
    ++at;
  }
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

std::string shown(std::string_view text) {
  constexpr std::size_t most = 40;
  std::string start(text.substr(0, most));
  std::replace_if(start.begin(), start.end(), is_control, '?');
  return '"' + start + (text.size() > most ? "..." : "") + '"';
}

void append_field(std::string& out, std::string_view text) {
  const bool plain = std::none_of(text.begin(), text.end(), needs_quotes) && trimmed(text) == text;
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
