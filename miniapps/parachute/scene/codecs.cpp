#include "miniapps/parachute/scene/codecs.hpp"

#include <charconv>
#include <utility>

namespace drogue::parachute_app {
namespace {

using scene::Codec;
using scene::Limits;
using scene::Node;

const scene::Choices<flow::BoundaryKind> kinds = {{"periodic", flow::BoundaryKind::periodic},
                                                  {"slip", flow::BoundaryKind::slip},
                                                  {"wall", flow::BoundaryKind::wall},
                                                  {"inflow", flow::BoundaryKind::inflow},
                                                  {"outflow", flow::BoundaryKind::outflow}};

std::string bracketed(const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ", ") + text;
  return "[" + list + "]";
}

/// Reads an array of `size` elements (0: any number); `read(element, index)` returns the fault.
template <class Read>
std::string read_elements(const Node& node, std::size_t size, const std::string& elements, const Read& read) {
  const std::string wanted = "must be an array of " + (size > 0 ? std::to_string(size) + " " : "") + elements;
  const auto* array = node.as<Node::Array>();
  if (array == nullptr) return wanted + ", not " + scene::describe(node);
  if (size > 0 && array->size() != size) return wanted + ", not of " + std::to_string(array->size());
  for (std::size_t i = 0; i < array->size(); ++i) {
    const std::string fault = read((*array)[i], i);
    if (!fault.empty()) return "[" + std::to_string(i) + "]" + (fault.starts_with('[') ? "" : " ") + fault;
  }
  return {};
}

std::string read_pair(const Node& node, const Limits& limits, std::array<double, 2>& pair) {
  return read_elements(node, 2, "numbers", [&](const Node& element, std::size_t i) {
    return scene::read_real(element, limits, pair[i]);
  });
}

/// Assigns the value that `read(node, limits, value)` fills in, if it reports no fault.
template <class T, class Read>
std::function<std::string(const Node&, const Limits&)> read_whole(T& place, Read read) {
  return [&place, read](const Node& node, const Limits& limits) {
    T value = place;
    std::string fault = read(node, limits, value);
    if (fault.empty()) place = std::move(value);
    return fault;
  };
}

/// A number as it is, anything else as a string.
std::string number_or_string(const std::string& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  return is_number ? scene::toml_text(number) : scene::toml_string(text);
}

std::string read_kind(const Node& node, bool of_one_side, flow::BoundaryKind& kind) {
  std::vector<std::string> names;
  for (const auto& [name, meaning] : kinds)
    if (!of_one_side || meaning != flow::BoundaryKind::periodic) names.push_back(name);
  std::string chosen;
  std::string fault = scene::read_name(node, names, chosen);
  for (const auto& [name, meaning] : kinds)
    if (name == chosen) kind = meaning;
  return fault;
}

std::string kind_name(flow::BoundaryKind kind) {
  for (const auto& [name, meaning] : kinds)
    if (meaning == kind) return scene::toml_string(name);
  return {};
}

}  // namespace

Codec cells_codec(std::array<int, 3>& cells) {
  return {"array of 3 integers",
          read_whole(cells,
                     [](const Node& node, const Limits& limits, std::array<int, 3>& value) {
                       return read_elements(node, 3, "integers", [&](const Node& element, std::size_t i) {
                         std::int64_t number = 0;
                         std::string fault = scene::read_integer(element, limits, number);
                         value[i] = static_cast<int>(number);
                         return fault;
                       });
                     }),
          [&cells] {
            std::vector<std::string> texts;
            for (const int n : cells) texts.push_back(std::to_string(n));
            return std::optional(bracketed(texts));
          },
          scene::back_to_default(cells)};
}

Codec domain_codec(std::array<double, 3>& low, std::array<double, 3>& high) {
  return {"array of 3 intervals [real, real]",
          [&low, &high](const Node& node, const Limits& limits) {
            std::array<double, 3> ends[2];
            std::string fault = read_elements(node, 3, "intervals", [&](const Node& element, std::size_t i) {
              std::array<double, 2> interval{};
              std::string wrong = read_pair(element, limits, interval);
              if (wrong.empty() && !(interval[0] < interval[1]))
                wrong = "= " + bracketed({scene::toml_text(interval[0]), scene::toml_text(interval[1])}) +
                        ": the first number must be the smaller";
              ends[0][i] = interval[0];
              ends[1][i] = interval[1];
              return wrong;
            });
            if (!fault.empty()) return fault;
            low = ends[0];
            high = ends[1];
            return fault;
          },
          [&low, &high] {
            std::vector<std::string> texts;
            for (std::size_t i = 0; i < 3; ++i)
              texts.push_back(bracketed({scene::toml_text(low[i]), scene::toml_text(high[i])}));
            return std::optional(bracketed(texts));
          },
          [low_reset = scene::back_to_default(low), high_reset = scene::back_to_default(high)] {
            low_reset();
            high_reset();
          }};
}

Codec vector_codec(std::array<double, 3>& vector) {
  return {"array of 3 reals",
          read_whole(vector,
                     [](const Node& node, const Limits& limits, std::array<double, 3>& value) {
                       return read_elements(node, 3, "numbers", [&](const Node& element, std::size_t i) {
                         return scene::read_real(element, limits, value[i]);
                       });
                     }),
          [&vector] {
            std::vector<std::string> texts;
            for (const double value : vector) texts.push_back(scene::toml_text(value));
            return std::optional(bracketed(texts));
          },
          scene::back_to_default(vector)};
}

Codec pair_codec(std::array<double, 2>& pair) {
  return {"array of 2 reals", read_whole(pair, read_pair),
          [&pair] {
            return std::optional(bracketed({scene::toml_text(pair[0]), scene::toml_text(pair[1])}));
          },
          scene::back_to_default(pair)};
}

Codec optional_pair_codec(std::optional<std::array<double, 2>>& pair) {
  return {"array of 2 reals",
          [&pair](const Node& node, const Limits& limits) {
            std::array<double, 2> value{};
            std::string fault = read_pair(node, limits, value);
            if (fault.empty()) pair = value;
            return fault;
          },
          [&pair]() -> std::optional<std::string> {
            if (!pair) return std::nullopt;
            return bracketed({scene::toml_text((*pair)[0]), scene::toml_text((*pair)[1])});
          },
          scene::back_to_default(pair)};
}

Codec vector_expression_codec(VectorExpression& vector, std::vector<std::string> variables) {
  std::string names;
  for (const std::string& variable : variables) names += (names.empty() ? "" : ", ") + variable;
  return {
      "array of 3 reals or expressions of " + names,
      read_whole(vector,
                 [variables](const Node& node, const Limits& limits, VectorExpression& value) {
                   return read_elements(
                       node, 3, "numbers or expressions", [&](const Node& element, std::size_t i) {
                         return scene::real_or_expression_codec(value[i], variables).read(element, limits);
                       });
                 }),
      [&vector]() -> std::optional<std::string> {
        if (vector[0].empty()) return std::nullopt;
        std::vector<std::string> texts;
        for (const std::string& text : vector) texts.push_back(number_or_string(text));
        return bracketed(texts);
      },
      scene::back_to_default(vector)};
}

Codec points_codec(std::vector<std::array<double, 2>>& points) {
  using Points = std::vector<std::array<double, 2>>;
  return {
      "array of pairs [real, real]",
      read_whole(points,
                 [](const Node& node, const Limits& limits, Points& value) {
                   value.clear();
                   return read_elements(node, 0, "pairs of numbers", [&](const Node& element, std::size_t i) {
                     std::array<double, 2> pair{};
                     std::string wrong = read_pair(element, limits, pair);
                     if (wrong.empty() && i > 0 && !(pair[0] > value.back()[0]))
                       wrong = "= " + scene::toml_text(pair[0]) + ", ...: not greater than the one before it";
                     value.push_back(pair);
                     return wrong;
                   });
                 }),
      [&points]() -> std::optional<std::string> {
        if (points.empty()) return std::nullopt;
        std::vector<std::string> texts;
        for (const auto& [where, value] : points)
          texts.push_back(bracketed({scene::toml_text(where), scene::toml_text(value)}));
        return bracketed(texts);
      },
      scene::back_to_default(points)};
}

Codec sides_codec(std::optional<SidePair>& sides) {
  std::string type;
  for (const auto& [name, meaning] : kinds) type += (type.empty() ? "" : " | ") + scene::toml_string(name);
  return {type + ", or [low side, high side]",
          read_whole(sides,
                     [](const Node& node, const Limits&, std::optional<SidePair>& value) {
                       SidePair pair{};
                       std::string fault;
                       if (node.as<Node::Array>() == nullptr) {
                         fault = read_kind(node, false, pair[0]);
                         pair[1] = pair[0];
                       } else {
                         fault = read_elements(node, 2, "names", [&](const Node& element, std::size_t i) {
                           return read_kind(element, true, pair[i]);
                         });
                       }
                       value = pair;
                       return fault;
                     }),
          [&sides]() -> std::optional<std::string> {
            if (!sides) return std::nullopt;
            const std::string low = kind_name((*sides)[0]), high = kind_name((*sides)[1]);
            return low == high ? low : bracketed({low, high});
          },
          scene::back_to_default(sides)};
}

Codec optional_integer_codec(std::optional<int>& value) {
  return {"integer",
          [&value](const Node& node, const Limits& limits) {
            std::int64_t number = 0;
            std::string fault = scene::read_integer(node, limits, number);
            if (fault.empty()) value = static_cast<int>(number);
            return fault;
          },
          [&value] { return value ? std::optional(std::to_string(*value)) : std::nullopt; },
          scene::back_to_default(value)};
}

Codec time_step_codec(double& dt) {
  return {"real or \"auto\"",
          [&dt](const Node& node, const Limits& limits) -> std::string {
            const auto* text = node.as<std::string>();
            if (text == nullptr) return scene::read_real(node, limits, dt);
            if (*text != "auto") return "must be a number or \"auto\", not " + scene::describe(node);
            dt = 0.0;
            return {};
          },
          [&dt] { return std::optional(dt > 0.0 ? scene::toml_text(dt) : scene::toml_string("auto")); },
          scene::back_to_default(dt)};
}

Codec absent_if_zero(Codec codec, const double& value) {
  codec.print = [print = std::move(codec.print), &value] { return value == 0.0 ? std::nullopt : print(); };
  return codec;
}

Codec standard_if_zero(Codec codec, const double& value, std::function<double()> standard) {
  codec.print = [print = std::move(codec.print), &value, standard = std::move(standard)] {
    return value == 0.0 ? scene::toml_text(standard()) : print();
  };
  return codec;
}

}  // namespace drogue::parachute_app
