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

/// Prints a text that is absent if it is empty.
std::optional<std::string> print_text(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(toml_string(text));
}

std::string count_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " number" : " numbers");
}

std::string read_reals(const Node& node, const Limits& limits, bool increasing, std::vector<double>& values) {
  std::vector<double> numbers;
  std::string complaint =
      read_elements(node, 0, "numbers", [&](const Node& element, std::size_t) -> std::string {
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

std::string joined(const std::vector<std::string>& texts, const std::string& between) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : between) + text;
  return all;
}

std::string toml_text(double value) { return real_text(value); }
std::string toml_text(bool value) { return value ? "true" : "false"; }

std::string read_elements(const Node& node, std::size_t size, const std::string& elements,
                          const std::function<std::string(const Node&, std::size_t)>& read) {
  const std::string wanted = "must be an array of " + (size > 0 ? std::to_string(size) + " " : "") + elements;
  const auto* array = node.as<Node::Array>();
  if (array == nullptr) return wanted + ", not " + describe(node);
  if (size > 0 && array->size() != size) return wanted + ", not of " + std::to_string(array->size());
  for (std::size_t i = 0; i < array->size(); ++i) {
    const std::string fault = read((*array)[i], i);
    if (!fault.empty()) return "[" + std::to_string(i) + "]" + (fault.starts_with('[') ? "" : " ") + fault;
  }
  return {};
}

std::string Form<bool>::read(const Node& node, const Limits& /*limits*/, bool& value) {
  const auto* boolean = node.as<bool>();
  if (boolean == nullptr) return "must be true or false, not " + describe(node);
  value = *boolean;
  return {};
}

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

std::string name_type(const std::vector<std::string>& names) {
  std::vector<std::string> quoted;
  for (const std::string& name : names) quoted.push_back(toml_string(name));
  return joined(quoted, " | ");
}

Codec block_codec(int& threads) {
  const auto read = [](const Node& node, const Limits& limits, int& value) {
    std::string fault = Form<int>::read(node, limits, value);
    if (fault.empty() && value % 32 != 0) fault = "= " + describe(node) + " is not a multiple of 32";
    return fault;
  };
  return zero_is_unset(make_codec("integer", threads, read, toml_text<int>), threads);
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

Codec text_codec(std::string& value) {
  return make_codec(
      "string", value,
      [](const Node& node, const Limits&, std::string& place) -> std::string {
        const auto* text = node.as<std::string>();
        if (text == nullptr) return "must be a string, not " + describe(node);
        place = *text;
        return {};
      },
      print_text);
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
  const auto read = [variables](const Node& node, const Limits&, std::string& place) {
    return read_expression(node, variables, place);
  };
  return make_codec("expression of " + joined(variables, ", "), value, read, print_text);
}

std::string read_real_or_expression(const Node& node, const Limits& limits,
                                    const std::vector<std::string>& variables, std::string& value) {
  if (node.as<std::string>() != nullptr) return read_expression(node, variables, value);
  double number = 0.0;
  std::string fault = read_real(node, limits, number);
  if (fault.empty()) value = real_text(number);
  return fault;
}

Codec real_or_expression_codec(std::string& value, std::vector<std::string> variables) {
  const auto read = [variables](const Node& node, const Limits& limits, std::string& place) {
    return read_real_or_expression(node, limits, variables, place);
  };
  return make_codec("real or expression of " + joined(variables, ", "), value, read, print_text);
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
            return std::optional(toml_text(std::array{low, high}));
          },
          [reset_low = back_to_default(low), reset_high = back_to_default(high)] {
            reset_low();
            reset_high();
          }};
}

Codec reals_codec(std::vector<double>& values, std::size_t size, bool increasing) {
  return make_codec(
      increasing ? "array of increasing reals" : "array of reals", values,
      [size, increasing](const Node& node, const Limits& limits, std::vector<double>& numbers) {
        std::string complaint = read_reals(node, limits, increasing, numbers);
        if (complaint.empty() && size != 0 && numbers.size() != size)
          complaint = "must be " + count_text(size) + ", not " + count_text(numbers.size());
        return complaint;
      },
      [](const std::vector<double>& numbers) { return array_text(numbers, real_text); });
}

Codec names_codec(std::vector<std::string>& values, std::vector<std::string> valid) {
  return make_codec(
      "array of " + name_type(valid), values,
      [valid](const Node& node, const Limits&, std::vector<std::string>& names) {
        names.clear();
        return read_elements(node, 0, "names", [&](const Node& element, std::size_t) {
          std::string name;
          std::string wrong = read_name(element, valid, name);
          if (wrong.empty() && std::find(names.begin(), names.end(), name) != names.end())
            wrong = "= " + toml_string(name) + " is given twice";
          names.push_back(name);
          return wrong;
        });
      },
      [](const std::vector<std::string>& names) { return array_text(names, toml_string); });
}

}  // namespace drogue::scene
