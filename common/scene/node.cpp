#include "common/scene/node.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace drogue::scene {

const Node* Node::find(std::string_view name) const {
  if (const auto* table = as<Table>()) {
    for (const Member& member : *table) {
      if (member.name == name) return &member.node;
    }
  }
  return nullptr;
}

std::string toml_string(std::string_view text) {
  static constexpr std::string_view hex = "0123456789ABCDEF";
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (c == '\n') {
      result += "\\n";
    } else if (c == '\t') {
      result += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      result += "\\u00";
      result += hex[byte >> 4U];
      result += hex[byte & 15U];
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string real_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  std::string text(buffer.data(), end);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string rounded_text(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.12g", value);
  return real_text(std::strtod(buffer.data(), nullptr));
}

std::string rough_text(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.3g", value);
  return buffer.data();
}

std::string element(const std::string& array, std::size_t index) {
  return array + "[" + std::to_string(index) + "]";
}

std::string shortened(const std::string& text, std::size_t longest) {
  if (text.size() <= longest) return text;
  std::size_t cut = longest;
  while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xC0U) == 0x80U)
    --cut;  // whole UTF-8 characters
  return text.substr(0, cut) + "...";
}

std::string short_toml_string(const std::string& text) {
  const std::string begin = shortened(text);
  if (begin == text) return toml_string(text);
  return toml_string(begin.substr(0, begin.size() - 3)) + "...";
}

std::string describe(const Node& node) {
  struct Visitor {
    std::string operator()(const Node::Table&) const { return "a table"; }
    std::string operator()(const Node::Array&) const { return "an array"; }
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return std::to_string(value); }
    std::string operator()(double value) const { return real_text(value); }
    std::string operator()(const std::string& value) const {
      return "the string " + short_toml_string(value);
    }
    std::string operator()(Date) const { return "a date or time"; }
  };
  return std::visit(Visitor{}, node.value);
}

}  // namespace drogue::scene
