#include "miniapps/springs/scene/expressions.hpp"

#include <algorithm>
#include <array>

#include "common/expression/compile.hpp"
#include "common/expression/expression.hpp"
#include "common/expression/sample_times.hpp"

namespace drogue::springs_app {
namespace {

const std::vector<std::string> place_and_time = {"x", "y", "z", "t"};

}  // namespace

std::vector<double> values_at(const std::string& expression, const fabric::Mesh& mesh, double time) {
  std::vector<double> values(mesh.rest.size(), 0.0);
  if (expression.empty()) return values;
  const expression::Expression value(expression, place_and_time);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const fabric::Vector& x = mesh.rest[i];
    values[i] = value(std::array{x[0], x[1], x[2], time});
  }
  return values;
}

std::vector<fabric::Vector> values_at(const ExpressionVector& expressions, const fabric::Mesh& mesh,
                                      double time) {
  std::vector<fabric::Vector> vectors(mesh.rest.size(), fabric::Vector{});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (expressions.of(axis).empty()) continue;
    const std::vector<double> values = values_at(expressions.of(axis), mesh, time);
    for (std::size_t i = 0; i < values.size(); ++i) vectors[i][axis] = values[i];
  }
  return vectors;
}

std::vector<int> selected(const std::string& where, const fabric::Mesh& mesh) {
  std::vector<int> vertices;
  const std::vector<double> values =
      where.empty() ? std::vector<double>(mesh.rest.size(), 1.0) : values_at(where, mesh);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] != 0.0) vertices.push_back(static_cast<int>(i));
  return vertices;
}

bool depends_on_time(const std::string& expression) {
  if (expression.empty()) return false;
  const auto program = expression::compile(expression, place_and_time);
  return std::ranges::any_of(program, [](const auto& step) { return step.name == "t"; });
}

std::vector<double> sample_times(const std::string& expression, double end) {
  return expression::sample_times(expression, place_and_time, end);
}

device::ExpressionProgram device_program(const std::string& expression) {
  device::ExpressionBuilder builder;
  for (const auto& step : expression::compile(expression, place_and_time))
    builder.push(step.name, step.value);
  return builder.program();
}

std::optional<double> constant_value(const std::string& expression) {
  if (expression.empty()) return std::nullopt;
  const auto program = expression::compile(expression, place_and_time);
  const auto varies = [](const auto& step) { return std::ranges::count(place_and_time, step.name) > 0; };
  if (std::ranges::any_of(program, varies)) return std::nullopt;
  return expression::Expression(expression, place_and_time)(std::array{0.0, 0.0, 0.0, 0.0});
}

}  // namespace drogue::springs_app
