#include "common/csv/fields.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace drogue::csv {
namespace {

constexpr std::string_view no_utf8 = "the line is not UTF-8; save the file as UTF-8";

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

/// True if bytes from 0x80 on are well-formed UTF-8 (RFC 3629).
bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) {
      return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U;
    };
    const unsigned first = byte(i), second = byte(i + 1);
    const std::size_t length = first < 0x80 ? 1 : first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    if (length == 0 || first > 0xf4) return false;
    for (std::size_t k = 1; k < length; ++k)
      if ((byte(i + k) & 0xc0U) != 0x80) return false;
    // Overlong forms, surrogates, and what lies beyond Unicode.
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
        (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f))
      return false;
    i += length;
  }
  return true;
}

bool needs_quotes(char c) { return c == ',' || c == '"' || c == '\r' || c == '\n'; }

}  // namespace

std::string_view Fields::split(std::string_view line) {
  _values.clear();
  std::size_t begin = 0;
  constexpr Word high_bits = 0x8080808080808080;
  Word high = 0;
  for (std::size_t at = 0; at < line.size(); at += sizeof(Word)) {
    const Word word = word_at(line, at);
    high |= word & high_bits;
    if (places_of('"', word) != 0) {
      _values.clear();
      return is_utf8(line) ? split_quoted(line) : no_utf8;
    }
    for (Word commas = places_of(',', word); commas != 0; commas &= commas - 1) {
      const std::size_t comma = at + static_cast<std::size_t>(std::countr_zero(commas)) / 8;
      _values.push_back(trimmed(line.substr(begin, comma - begin)));
      begin = comma + 1;
    }
  }
  _values.push_back(trimmed(line.substr(begin)));
  if (high == 0 || is_utf8(line)) return {};
  _values.clear();
  return no_utf8;
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
  std::size_t cut = std::min(text.size(), most);
  while (cut > 0 && cut < text.size() && (static_cast<unsigned char>(text[cut]) & 0xc0U) == 0x80)
    --cut;  // whole UTF-8 characters
  std::string start(text.substr(0, cut));
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
