#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/scene/nearest.hpp"
#include "common/scene/node.hpp"

namespace drogue::scene {

/// The numbers a key allows, such as `positive` or `at_least(1.0).below(2.0)`.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_excluded = false;
  bool high_excluded = false;

  [[nodiscard]] constexpr Limits at_most(double most) const { return {low, most, low_excluded, false}; }
  [[nodiscard]] constexpr Limits below(double most) const { return {low, most, low_excluded, true}; }

  [[nodiscard]] bool allow(double value) const;
  [[nodiscard]] std::string text() const;  ///< `> 0 and <= 2`, `8 .. 268435456`; empty where all is allowed
};

constexpr Limits above(double low) { return {.low = low, .low_excluded = true}; }
constexpr Limits at_least(double low) { return {.low = low}; }
constexpr Limits between(double low, double high) { return at_least(low).at_most(high); }
inline constexpr Limits positive = above(0.0), not_negative = at_least(0.0);

/// Reads a value from a node into the variable that it is bound to, and prints it.
struct Codec {
  std::string type;  ///< for documentation and errors
  /// Returns the fault as the rest of a sentence that starts with the key; empty if there is none.
  std::function<std::string(const Node&, const Limits&)> read;
  std::function<std::optional<std::string>()> print;  ///< as TOML; nothing where no value is set
  std::function<void()> reset;                        ///< back to what was there at the declaration
};

/// `reset` function of a codec bound to `value`.
template <class T>
std::function<void()> back_to_default(T& value) {
  return [&value, standard = value] { value = standard; };
}

/// Text of a value that reads back as the same value.
std::string toml_text(double value);
std::string toml_text(bool value);
template <std::integral T>
std::string toml_text(T value) {
  return std::to_string(value);
}

/// Texts with `between` between them.
std::string joined(const std::vector<std::string>& texts, const std::string& between);

/// TOML array of elements that are TOML. `text`: of each element.
template <class List, class Text>
std::string array_text(const List& list, const Text& text) {
  std::string joined;
  for (const auto& element : list) joined += (joined.empty() ? "" : ", ") + text(element);
  return "[" + joined + "]";
}
template <class T, std::size_t size>
std::string toml_text(const std::array<T, size>& values) {
  return array_text(values, [](const T& value) { return toml_text(value); });
}

/// Each returns the fault or an empty text, and changes `value` only if there is no fault.
std::string read_real(const Node& node, const Limits& limits, double& value);
std::string read_integer(const Node& node, const Limits& limits, std::int64_t& value);
std::string read_name(const Node& node, const std::vector<std::string>& valid, std::string& value);
std::string read_expression(const Node& node, const std::vector<std::string>& variables, std::string& value);
/// A number is kept as its text.
std::string read_real_or_expression(const Node& node, const Limits& limits,
                                    const std::vector<std::string>& variables, std::string& value);

/// Reads an array of `size` elements (0: any number), named by their plural. `read(element, index)` returns
/// the fault of an element.
std::string read_elements(const Node& node, std::size_t size, const std::string& elements,
                          const std::function<std::string(const Node&, std::size_t)>& read);

/// How scenes write a value of type T: its name in documentation, that of several values in sentences, and
/// how it is read. An integer must be in the range of T.
template <class T>
struct Form;
template <>
struct Form<double> {
  static std::string type() { return "real"; }
  static constexpr const char* several = "numbers";
  static std::string read(const Node& node, const Limits& limits, double& value) {
    return read_real(node, limits, value);
  }
};
template <>
struct Form<bool> {
  static std::string type() { return "boolean"; }
  static std::string read(const Node& node, const Limits& limits, bool& value);
};
template <std::integral T>
struct Form<T> {
  static std::string type() { return "integer"; }
  static constexpr const char* several = "integers";
  static std::string read(const Node& node, Limits limits, T& value) {
    limits.low = std::max(limits.low, static_cast<double>(std::numeric_limits<T>::min()));
    limits.high = std::min(limits.high, static_cast<double>(std::numeric_limits<T>::max()));
    std::int64_t number = 0;
    std::string fault = read_integer(node, limits, number);
    if (fault.empty()) value = static_cast<T>(number);
    return fault;
  }
};
template <class T, std::size_t size>
struct Form<std::array<T, size>> {
  static std::string type() { return "array of " + std::to_string(size) + " " + Form<T>::type() + "s"; }
  static std::string read(const Node& node, const Limits& limits, std::array<T, size>& values) {
    return read_elements(node, size, Form<T>::several, [&](const Node& element, std::size_t i) {
      return Form<T>::read(element, limits, values[i]);
    });
  }
};

/// Codec of a value that `read(node, limits, value)` fills in unless it returns a fault, and `print(value)`
/// prints.
template <class T, class Read, class Print>
Codec make_codec(std::string type, T& place, Read read, Print print) {
  return {std::move(type),
          [&place, read](const Node& node, const Limits& limits) {
            T value = place;
            std::string fault = read(node, limits, value);
            if (fault.empty()) place = std::move(value);
            return fault;
          },
          [&place, print]() -> std::optional<std::string> { return print(place); }, back_to_default(place)};
}

template <class T>
Codec codec_of(T& value) {
  return make_codec(Form<T>::type(), value, Form<T>::read, [](const T& v) { return toml_text(v); });
}

/// The value is absent unless given.
template <class T>
Codec codec_of(std::optional<T>& value) {
  const auto read = [](const Node& node, const Limits& limits, std::optional<T>& v) {
    return Form<T>::read(node, limits, v.emplace());
  };
  return make_codec(Form<T>::type(), value, read,
                    [](const auto& v) { return v ? std::optional(toml_text(*v)) : std::nullopt; });
}

/// Real number under `name` in a map; absent if not set.
Codec real_codec(std::map<std::string, double>& values, const std::string& name);
Codec text_codec(std::string& value);
/// String that must equal `value`, say the name of the program.
Codec fixed_codec(std::string value);
Codec expression_codec(std::string& value, std::vector<std::string> variables);
/// A number or an expression of `variables`; kept as the text of the expression.
Codec real_or_expression_codec(std::string& value, std::vector<std::string> variables);
/// Two reals, the first the smaller.
Codec interval_codec(double& low, double& high);
/// Reals in increasing order where `increasing`; of `size` elements where that is not 0.
Codec reals_codec(std::vector<double>& values, std::size_t size, bool increasing);
/// Distinct names out of `valid`.
Codec names_codec(std::vector<std::string>& values, std::vector<std::string> valid);

/// Treats 0, or the first choice, as an absent value.
template <class T>
Codec zero_is_unset(Codec codec, const T& value) {
  codec.print = [print = codec.print, &value] { return value != T{} ? print() : std::nullopt; };
  return codec;
}
template <class T>
Codec zero_is_unset(T& value) {
  return zero_is_unset(codec_of(value), value);
}

/// Number of threads of a team, a multiple of 32 within the declared limits; 0 is an absent value.
Codec block_codec(int& threads);

template <class T>
using Choices = std::vector<std::pair<std::string, T>>;

/// Name of a value in scenes; empty for a value without one.
template <class T>
std::string choice_name(const Choices<T>& choices, T value) {
  for (const auto& [name, meaning] : choices)
    if (meaning == value) return name;
  return {};
}

template <class T>
std::vector<std::string> names_of(const Choices<T>& choices) {
  std::vector<std::string> names;
  for (const auto& [name, meaning] : choices) names.push_back(name);
  return names;
}

/// Type of a value that is one of several names: `"a" | "b"`.
std::string name_type(const std::vector<std::string>& names);
template <class T>
std::string choice_type(const Choices<T>& choices) {
  return name_type(names_of(choices));
}

/// One of several names, each standing for a value. `Variable` is T or std::optional<T>.
template <class T, class Variable>
Codec choice_codec(Variable& value, const Choices<T>& choices) {
  return make_codec(
      choice_type(choices), value,
      [choices](const Node& node, const Limits&, Variable& place) {
        std::string chosen;
        std::string fault = read_name(node, names_of(choices), chosen);
        for (const auto& [name, meaning] : choices)
          if (fault.empty() && name == chosen) place = meaning;
        return fault;
      },
      [choices](const Variable& place) -> std::optional<std::string> {
        for (const auto& [name, meaning] : choices)
          if (place == meaning) return toml_string(name);
        return std::nullopt;
      });
}

}  // namespace drogue::scene
