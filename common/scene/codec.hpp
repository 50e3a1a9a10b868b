#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/scene/nearest.hpp"
#include "common/scene/node.hpp"

namespace drogue::scene {

/// The numbers a key allows.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_excluded = false;
  bool high_excluded = false;

  [[nodiscard]] bool allow(double value) const;
  [[nodiscard]] std::string text() const;  ///< `> 0 and <= 2`, `8 .. 268435456`; empty where all is allowed
};

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

/// Text of a number that reads back as the same number.
std::string toml_text(double value);
std::string toml_text(std::int64_t value);

/// Each returns the fault or an empty text, and changes `value` only if there is no fault.
std::string read_real(const Node& node, const Limits& limits, double& value);
std::string read_integer(const Node& node, const Limits& limits, std::int64_t& value);
std::string read_name(const Node& node, const std::vector<std::string>& valid, std::string& value);
std::string read_expression(const Node& node, const std::vector<std::string>& variables, std::string& value);

Codec real_codec(double& value);
Codec real_codec(std::optional<double>& value);
/// Real number under `name` in a map; absent if not set.
Codec real_codec(std::map<std::string, double>& values, const std::string& name);
Codec boolean_codec(bool& value);
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

/// Integer within the range of T and the declared limits.
template <class T>
Codec integer_codec(T& value) {
  return {"integer",
          [&value](const Node& node, Limits limits) {
            limits.low = std::max(limits.low, static_cast<double>(std::numeric_limits<T>::min()));
            limits.high = std::min(limits.high, static_cast<double>(std::numeric_limits<T>::max()));
            std::int64_t number = 0;
            std::string complaint = read_integer(node, limits, number);
            if (complaint.empty()) value = static_cast<T>(number);
            return complaint;
          },
          [&value] { return std::optional(toml_text(static_cast<std::int64_t>(value))); },
          back_to_default(value)};
}

/// Integer that is absent unless given.
template <class T>
Codec integer_codec(std::optional<T>& value) {
  const auto number = std::make_shared<T>();
  Codec codec = integer_codec(*number);
  codec.read = [read = codec.read, number, &value](const Node& node, const Limits& limits) {
    std::string complaint = read(node, limits);
    if (complaint.empty()) value = *number;
    return complaint;
  };
  codec.print = [&value] {
    return value ? std::optional(toml_text(static_cast<std::int64_t>(*value))) : std::nullopt;
  };
  codec.reset = back_to_default(value);
  return codec;
}

/// Treats 0, or the first choice, as an absent value.
template <class T>
Codec zero_is_unset(Codec codec, const T& value) {
  codec.print = [print = codec.print, &value] { return value != T{} ? print() : std::nullopt; };
  return codec;
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

/// One of several names, each standing for a value. `Place` is T or std::optional<T>.
template <class T, class Place>
Codec choice_codec(Place& value, const Choices<T>& choices) {
  std::vector<std::string> names;
  std::string type;
  for (const auto& [name, meaning] : choices) {
    names.push_back(name);
    type += (type.empty() ? "" : " | ") + toml_string(name);
  }
  return {type,
          [&value, choices, names](const Node& node, const Limits&) {
            std::string chosen;
            std::string complaint = read_name(node, names, chosen);
            for (const auto& [name, meaning] : choices) {
              if (complaint.empty() && name == chosen) value = meaning;
            }
            return complaint;
          },
          [&value, choices]() -> std::optional<std::string> {
            for (const auto& [name, meaning] : choices) {
              if (value == meaning) return toml_string(name);
            }
            return std::nullopt;
          },
          back_to_default(value)};
}

}  // namespace drogue::scene
