#include "common/scene/codec.hpp"

#include <cmath>

#include "common/expression/compile.hpp"
#include "common/expression/expression.hpp"

namespace drogue::scene {
namespace {

/// Integer without point or exponent: limits read `>= 8`, not `>= 8.0`.
std::string short_text(double value) {
  if (value == std::rint(value) && std::abs(value) < 1e10)
    return std::to_string(static_cast<std::int64_t>(value));
  return real_text(value);
}

std::string must_be(const std::string& what, const Limits& limits, const Node& node) {
  const std::string range = limits.text();
  return "must be " + what + (range.empty() ? "" : " " + range) + ", not " + describe(node);
}

std::string count_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " number" : " numbers");
}

std::string array_text(const std::vector<std::string>& elements) {
  std::string text;
  for (const std::string& element : elements) text += (text.empty() ? "" : ", ") + element;
  return "[" + text + "]";
}

/// Reads an array element by element; `read` takes a node and its index and returns the fault.
template <class Read>
std::string read_array(const Node& node, const std::string& of, Read read) {
  const auto* array = node.as<Node::Array>();
  if (array == nullptr) return "must be an array of " + of + ", not " + describe(node);
  for (std::size_t i = 0; i < array->size(); ++i) {
    const std::string complaint = read((*array)[i], i);
    if (!complaint.empty()) return "[" + std::to_string(i) + "] " + complaint;
  }
  return {};
}

std::string read_reals(const Node& node, const Limits& limits, bool increasing, std::vector<double>& values) {
  std::vector<double> numbers;
  std::string complaint = read_array(node, "numbers", [&](const Node& element, std::size_t) -> std::string {
    double number = 0.0;
    std::string wrong = read_real(element, limits, number);
    if (wrong.empty() && increasing && !numbers.empty() && number <= numbers.back()) {
      wrong = "= " + real_text(number) + " is not greater than the element before it, " +
              real_text(numbers.back());
    }
    numbers.push_back(number);
    return wrong;
  });
  if (complaint.empty()) values = numbers;
  return complaint;
}

}  // namespace

bool Limits::allow(double value) const {
  const bool low_holds = low_excluded ? value > low : value >= low;
  const bool high_holds = high_excluded ? value < high : value <= high;
  return low_holds && high_holds;
}

std::string Limits::text() const {
  const bool has_low = std::isfinite(low);
  const bool has_high = std::isfinite(high);
  if (has_low && has_high && !low_excluded && !high_excluded)
    return short_text(low) + " .. " + short_text(high);
  std::string text;
  if (has_low) text += (low_excluded ? "> " : ">= ") + short_text(low);
  if (has_low && has_high) text += " and ";
  if (has_high) text += (high_excluded ? "< " : "<= ") + short_text(high);
  return text;
}

std::string toml_text(double value) { return real_text(value); }
std::string toml_text(std::int64_t value) { return std::to_string(value); }

std::string read_real(const Node& node, const Limits& limits, double& value) {
  double number = 0.0;
  if (const auto* integer = node.as<std::int64_t>()) {
    number = static_cast<double>(*integer);
  } else if (const auto* real = node.as<double>()) {
    number = *real;
  } else {
    return must_be("a number", limits, node);
  }
  if (!std::isfinite(number)) return must_be("a finite number", limits, node);
  if (!limits.allow(number)) return "= " + describe(node) + " is out of range: it must be " + limits.text();
  value = number;
  return {};
}

std::string read_integer(const Node& node, const Limits& limits, std::int64_t& value) {
  const auto* integer = node.as<std::int64_t>();
  if (integer == nullptr) return must_be("an integer", limits, node);
  if (!limits.allow(static_cast<double>(*integer))) {
    return "= " + describe(node) + " is out of range: it must be " + limits.text();
  }
  value = *integer;
  return {};
}

Codec block_codec(int& threads) {
  Codec codec = zero_is_unset(integer_codec(threads), threads);
  codec.read = [read = codec.read, &threads](const Node& node, const Limits& limits) {
    const int before = threads;
    std::string fault = read(node, limits);
    if (!fault.empty() || threads % 32 == 0) return fault;
    threads = before;
    return "= " + describe(node) + " is not a multiple of 32";
  };
  return codec;
}

std::string read_name(const Node& node, const std::vector<std::string>& valid, std::string& value) {
  const auto* text = node.as<std::string>();
  std::string all;
  for (const std::string& name : valid) all += (all.empty() ? "" : ", ") + toml_string(name);
  const std::string one_of = valid.size() == 1 ? all : "one of " + all;
  if (text == nullptr) return "must be " + one_of + ", not " + describe(node);
  if (std::find(valid.begin(), valid.end(), *text) == valid.end()) {
    const std::string hint = suggestion(*text, valid);
    const bool near = hint.starts_with("did you mean");
    return "must be " + one_of + ", not " + describe(node) + (near ? "; " + hint : "");
  }
  value = *text;
  return {};
}

std::string read_expression(const Node& node, const std::vector<std::string>& variables, std::string& value) {
  const auto* text = node.as<std::string>();
  if (text == nullptr) return "must be a string that holds an expression, not " + describe(node);
  try {
    static_cast<void>(expression::Expression(*text, variables));
  } catch (const expression::ExpressionError& error) {
    return "= " + short_toml_string(*text) + ", at character " + std::to_string(error.position()) + ": " +
           error.what();
  }
  value = *text;
  return {};
}

Codec real_codec(double& value) {
  return {"real", [&value](const Node& node, const Limits& limits) { return read_real(node, limits, value); },
          [&value] { return std::optional(toml_text(value)); }, back_to_default(value)};
}

Codec real_codec(std::optional<double>& value) {
  return {"real",
          [&value](const Node& node, const Limits& limits) {
            double number = 0.0;
            std::string complaint = read_real(node, limits, number);
            if (complaint.empty()) value = number;
            return complaint;
          },
          [&value] { return value ? std::optional(toml_text(*value)) : std::nullopt; },
          back_to_default(value)};
}

Codec real_codec(std::map<std::string, double>& values, const std::string& name) {
  return {"real",
          [&values, name](const Node& node, const Limits& limits) {
            double number = 0.0;
            std::string complaint = read_real(node, limits, number);
            if (complaint.empty()) values[name] = number;
            return complaint;
          },
          [&values, name] {
            const auto found = values.find(name);
            return found != values.end() ? std::optional(toml_text(found->second)) : std::nullopt;
          },
          [&values, name] { values.erase(name); }};
}

Codec boolean_codec(bool& value) {
  return {"boolean",
          [&value](const Node& node, const Limits&) -> std::string {
            const auto* boolean = node.as<bool>();
            if (boolean == nullptr) return "must be true or false, not " + describe(node);
            value = *boolean;
            return {};
          },
          [&value] { return std::optional<std::string>(value ? "true" : "false"); }, back_to_default(value)};
}

Codec text_codec(std::string& value) {
  return {"string",
          [&value](const Node& node, const Limits&) -> std::string {
            const auto* text = node.as<std::string>();
            if (text == nullptr) return "must be a string, not " + describe(node);
            value = *text;
            return {};
          },
          [&value] { return value.empty() ? std::nullopt : std::optional(toml_string(value)); },
          back_to_default(value)};
}

Codec fixed_codec(std::string value) {
  return {toml_string(value),
          [value](const Node& node, const Limits&) {
            std::string same;
            return read_name(node, {value}, same);
          },
          [value] { return std::optional(toml_string(value)); }, [] {}};
}

Codec expression_codec(std::string& value, std::vector<std::string> variables) {
  std::string names;
  for (const std::string& variable : variables) names += (names.empty() ? "" : ", ") + variable;
  return {"expression of " + names,
          [&value, variables](const Node& node, const Limits&) {
            return read_expression(node, variables, value);
          },
          [&value] { return value.empty() ? std::nullopt : std::optional(toml_string(value)); },
          back_to_default(value)};
}

Codec real_or_expression_codec(std::string& value, std::vector<std::string> variables) {
  Codec codec = expression_codec(value, std::move(variables));
  codec.type = "real or " + codec.type;
  codec.read = [&value, read_text = codec.read](const Node& node, const Limits& limits) -> std::string {
    if (node.as<std::string>() != nullptr) return read_text(node, limits);
    double number = 0.0;
    std::string complaint = read_real(node, limits, number);
    if (complaint.empty()) value = real_text(number);
    return complaint;
  };
  return codec;
}

Codec interval_codec(double& low, double& high) {
  return {"[real, real]",
          [&low, &high](const Node& node, const Limits& limits) -> std::string {
            std::vector<double> ends;
            std::string complaint = read_reals(node, limits, true, ends);
            if (!complaint.empty()) return complaint;
            if (ends.size() != 2) return "must be two numbers, not " + count_text(ends.size());
            low = ends[0];
            high = ends[1];
            return {};
          },
          [&low, &high] {
            return std::optional(array_text({toml_text(low), toml_text(high)}));
          },
          [reset_low = back_to_default(low), reset_high = back_to_default(high)] {
            reset_low();
            reset_high();
          }};
}

Codec reals_codec(std::vector<double>& values, std::size_t size, bool increasing) {
  return {increasing ? "array of increasing reals" : "array of reals",
          [&values, size, increasing](const Node& node, const Limits& limits) -> std::string {
            std::vector<double> numbers;
            std::string complaint = read_reals(node, limits, increasing, numbers);
            if (!complaint.empty()) return complaint;
            if (size != 0 && numbers.size() != size) {
              return "must be " + count_text(size) + ", not " + count_text(numbers.size());
            }
            values = numbers;
            return {};
          },
          [&values] {
            std::vector<std::string> texts;
            for (const double value : values) texts.push_back(toml_text(value));
            return std::optional(array_text(texts));
          },
          back_to_default(values)};
}

Codec names_codec(std::vector<std::string>& values, std::vector<std::string> valid) {
  std::string type;
  for (const std::string& name : valid) type += (type.empty() ? "" : " | ") + toml_string(name);
  return {"array of " + type,
          [&values, valid](const Node& node, const Limits&) {
            std::vector<std::string> names;
            std::string complaint = read_array(node, "names", [&](const Node& element, std::size_t) {
              std::string name;
              std::string wrong = read_name(element, valid, name);
              if (wrong.empty() && std::find(names.begin(), names.end(), name) != names.end()) {
                wrong = "= " + toml_string(name) + " is given twice";
              }
              names.push_back(name);
              return wrong;
            });
            if (complaint.empty()) values = names;
            return complaint;
          },
          [&values] {
            std::vector<std::string> texts;
            for (const std::string& value : values) texts.push_back(toml_string(value));
            return std::optional(array_text(texts));
          },
          back_to_default(values)};
}

}  // namespace drogue::scene
