#include <array>
#include <utility>
#include <variant>

#include "common/expression/expression.hpp"
#include "miniapps/gas/scene/scene.hpp"

namespace drogue::gas_app {
namespace {

using expression::Expression;

struct RiemannValue {
  Riemann data;
  Primitive at(double x) const { return x < data.x0 ? data.left : data.right; }
};

struct RegionsValue {
  std::vector<Region> regions;
  Primitive at(double x) const {
    for (const Region& region : regions) {
      if (!region.until || x < *region.until) return region.state;
    }
    return regions.back().state;
  }
};

struct ExpressionValue {
  Expression rho;
  Expression u;
  Expression p;
  double dx;
  Primitive at(double x) const {
    const std::array<double, 2> values = {x, dx};
    return {rho(values), u(values), p(values)};
  }
};

ExpressionValue compiled(const GasScene& scene) {
  const std::vector<std::string> variables = {"x", "dx"};
  const ExpressionState& text = *scene.initial.expression;
  const gas::Parameters& parameters = scene.parameters;
  const double dx = (parameters.x_max - parameters.x_min) / static_cast<double>(parameters.cells);
  return {Expression(text.rho, variables), Expression(text.u, variables), Expression(text.p, variables), dx};
}

using Value = std::variant<RiemannValue, RegionsValue, ExpressionValue>;

Value value_of(const GasScene& scene) {
  if (scene.initial.riemann) return RiemannValue{*scene.initial.riemann};
  if (scene.initial.expression) return compiled(scene);
  return RegionsValue{scene.initial.regions};
}

}  // namespace

struct InitialState::Evaluator {
  Value value;
};

InitialState::InitialState(const GasScene& scene)
    : _evaluator(std::make_unique<Evaluator>(Evaluator{value_of(scene)})) {}
InitialState::InitialState(const InitialState& other)
    : _evaluator(std::make_unique<Evaluator>(*other._evaluator)) {}
InitialState::InitialState(InitialState&& other) noexcept = default;
InitialState& InitialState::operator=(const InitialState& other) { return *this = InitialState(other); }
InitialState& InitialState::operator=(InitialState&& other) noexcept = default;
InitialState::~InitialState() = default;

Primitive InitialState::operator()(double x) const {
  return std::visit([x](const auto& value) { return value.at(x); }, _evaluator->value);
}

}  // namespace drogue::gas_app
