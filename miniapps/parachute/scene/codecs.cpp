#include "miniapps/parachute/scene/codecs.hpp"

#include <charconv>

namespace drogue::parachute_app {
namespace {

using flow::BoundaryKind;
using scene::array_text, scene::Codec, scene::Limits, scene::Node, scene::toml_string, scene::toml_text;

using Pair = std::array<double, 2>;

const scene::Choices<BoundaryKind> kinds = {{"periodic", BoundaryKind::periodic},
                                            {"slip", BoundaryKind::slip},
                                            {"wall", BoundaryKind::wall},
                                            {"inflow", BoundaryKind::inflow},
                                            {"outflow", BoundaryKind::outflow}};
const scene::Choices<BoundaryKind> kinds_of_one_side(kinds.begin() + 1, kinds.end());

/// A number as it is, anything else as a string.
std::string number_or_string(const std::string& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  return is_number ? toml_text(number) : toml_string(text);
}

const char* const box_type = "array of 3 intervals [real, real]";

std::string read_box(const Node& node, const Limits& limits, Box& box) {
  return scene::read_elements(node, 3, "intervals", [&](const Node& element, std::size_t i) {
    std::string wrong = scene::Form<Pair>::read(element, limits, box[i]);
    if (wrong.empty() && !(box[i][0] < box[i][1]))
      wrong = "= " + toml_text(box[i]) + ": the first number must be the smaller";
    return wrong;
  });
}

}  // namespace

Codec box_codec(Box& box) { return scene::make_codec(box_type, box, read_box, toml_text<Pair, 3>); }

Codec box_codec(std::optional<Box>& box) {
  return scene::make_codec(
      box_type, box,
      [](const Node& node, const Limits& limits, std::optional<Box>& value) {
        return read_box(node, limits, value.emplace());
      },
      [](const std::optional<Box>& value) {
        return value ? std::optional(toml_text(*value)) : std::nullopt;
      });
}

Codec spacing_codec(std::array<double, 3>& spacing) {
  return scene::make_codec(
      "real or array of 3 reals", spacing,
      [](const Node& node, const Limits& limits, std::array<double, 3>& value) {
        if (node.as<Node::Array>() != nullptr)
          return scene::Form<std::array<double, 3>>::read(node, limits, value);
        double all = 0.0;
        std::string fault = scene::read_real(node, limits, all);
        value.fill(all);
        return fault;
      },
      [](const std::array<double, 3>& value) {
        const bool is_one = value[0] == value[1] && value[0] == value[2];
        return std::optional(is_one ? toml_text(value[0]) : toml_text(value));
      });
}

Codec faces_codec(std::optional<std::array<AxisFaces, 3>>& faces) {
  return scene::make_codec(
      "array of 3 arrays of reals or names of files", faces,
      [](const Node& node, const Limits& limits, std::optional<std::array<AxisFaces, 3>>& value) {
        std::array<AxisFaces, 3>& axes = value.emplace();
        return scene::read_elements(
            node, 3, "arrays of numbers or names of files", [&](const Node& axis, std::size_t i) {
              if (const auto* file = axis.as<std::string>(); file != nullptr) {
                axes[i].file = *file;
                return std::string();
              }
              return scene::read_elements(axis, 0, "numbers", [&](const Node& face, std::size_t) {
                return scene::read_real(face, limits, axes[i].values.emplace_back());
              });
            });
      },
      [](const std::optional<std::array<AxisFaces, 3>>& value) -> std::optional<std::string> {
        if (!value) return std::nullopt;
        return array_text(*value, [](const AxisFaces& axis) {
          return array_text(axis.values, [](double face) { return toml_text(face); });
        });
      });
}

Codec vector_expression_codec(VectorExpression& vector, const std::vector<std::string>& variables) {
  return scene::make_codec(
      "array of 3 reals or expressions of " + scene::joined(variables, ", "), vector,
      [variables](const Node& node, const Limits& limits, VectorExpression& value) {
        return scene::read_elements(
            node, 3, "numbers or expressions", [&](const Node& element, std::size_t i) {
              return scene::read_real_or_expression(element, limits, variables, value[i]);
            });
      },
      [](const VectorExpression& value) {
        return value[0].empty() ? std::nullopt : std::optional(array_text(value, number_or_string));
      });
}

Codec points_codec(std::vector<Pair>& points) {
  return scene::make_codec(
      "array of pairs [real, real]", points,
      [](const Node& node, const Limits& limits, std::vector<Pair>& value) {
        value.clear();
        return scene::read_elements(
            node, 0, "pairs of numbers", [&](const Node& element, std::size_t i) -> std::string {
              Pair pair{};
              std::string wrong = scene::Form<Pair>::read(element, limits, pair);
              if (wrong.empty() && i > 0 && !(pair[0] > value.back()[0]))
                wrong = "= " + toml_text(pair[0]) + ", ...: not greater than the one before it";
              value.push_back(pair);
              return wrong;
            });
      },
      [](const std::vector<Pair>& value) {
        return value.empty() ? std::nullopt : std::optional(array_text(value, toml_text<double, 2>));
      });
}

Codec sides_codec(std::optional<SidePair>& sides) {
  return scene::make_codec(
      scene::choice_type(kinds) + ", or [low side, high side]", sides,
      [](const Node& node, const Limits& limits, std::optional<SidePair>& value) {
        SidePair& pair = value.emplace();
        if (node.as<Node::Array>() != nullptr)
          return scene::read_elements(node, 2, "names", [&](const Node& element, std::size_t i) {
            return scene::choice_codec(pair[i], kinds_of_one_side).read(element, limits);
          });
        std::string fault = scene::choice_codec(pair[0], kinds).read(node, limits);
        pair[1] = pair[0];
        return fault;
      },
      [](const std::optional<SidePair>& value) -> std::optional<std::string> {
        if (!value) return std::nullopt;
        const auto text = [](BoundaryKind kind) { return toml_string(scene::choice_name(kinds, kind)); };
        return (*value)[0] == (*value)[1] ? text((*value)[0]) : array_text(*value, text);
      });
}

Codec time_step_codec(double& dt) {
  return scene::make_codec(
      "real or \"auto\"", dt,
      [](const Node& node, const Limits& limits, double& value) -> std::string {
        const auto* text = node.as<std::string>();
        if (text == nullptr) return scene::read_real(node, limits, value);
        if (*text != "auto") return "must be a number or \"auto\", not " + scene::describe(node);
        value = 0.0;
        return {};
      },
      [](double value) { return value > 0.0 ? toml_text(value) : toml_string("auto"); });
}

Codec standard_if_zero(double& value, const std::function<double()>& standard) {
  Codec codec = scene::codec_of(value);
  codec.print = [&value, standard] { return toml_text(value == 0.0 ? standard() : value); };
  return codec;
}

}  // namespace drogue::parachute_app
