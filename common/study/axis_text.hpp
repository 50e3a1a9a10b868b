#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace drogue::study {

/// Throws `Failure` (usage) with a sentence on the text of `--study`.
[[noreturn]] void refuse(const std::string& what);

/// Parts of a text between separators, empty ones too. Throws only std::bad_alloc.
[[nodiscard]] std::vector<std::string> split(const std::string& text, char separator);

/// Number that a whole text is; none if it is not one. Does not throw.
template <class Number>
[[nodiscard]] std::optional<Number> number_of(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Throws `Failure` (usage), which names the nearest one, unless a value is one of some names.
void require_one_of(const std::string& value, const std::vector<std::string>& names);

/// An axis of `--study`: `name=values`.
struct AxisText {
  std::string name, values;
};

/// The axes of a text, separated by commas. Throws `Failure` (usage) for one that is not among `names`, has
/// no values or comes twice.
[[nodiscard]] std::vector<AxisText> axis_texts(const std::string& text,
                                               const std::vector<std::string>& names);

}  // namespace drogue::study
