#include "common/expression/expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "common/expression/compile.hpp"

namespace drogue::expression {
namespace {

/// J_n(x) of integer order; NaN for another order.
double besselj(double n, double x) {
  constexpr double largest_order = 1000.0;
  if (n != std::rint(n) || !(std::abs(n) <= largest_order)) return std::numeric_limits<double>::quiet_NaN();
  return ::jn(static_cast<int>(n), x);
}

double whole_part(double x) { return std::floor(x); }

}  // namespace

struct Expression::Parser {
  Parser(const std::string& text, const std::vector<std::string>& variables) : values(variables.size()) {
    parser.ClearConst();
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineFun("besselj", besselj);
    parser.DefineFun("floor", whole_part);
    for (std::size_t i = 0; i < variables.size(); ++i) parser.DefineVar(variables[i], &values[i]);
    parser.SetExpr(text);
    parser.Eval();  // muParser translates at the first evaluation
  }

  std::vector<double> values;  // muParser keeps pointers into it: never resized
  mu::Parser parser;
};

Expression::Expression(std::string text, std::vector<std::string> variables)
    : _text(std::move(text)), _variables(std::move(variables)) {
  compile(_text, _variables);  // the narrower grammar and the better message
  try {
    _parser = std::make_unique<Parser>(_text, _variables);
  } catch (const mu::ParserError& error) {
    throw ExpressionError(error.GetPos() + 1, error.GetMsg());
  }
}

Expression::Expression(const Expression& other) : Expression(other._text, other._variables) {}
Expression::Expression(Expression&& other) noexcept = default;
Expression& Expression::operator=(const Expression& other) { return *this = Expression(other); }
Expression& Expression::operator=(Expression&& other) noexcept = default;
Expression::~Expression() = default;

double Expression::operator()(std::span<const double> values) const {
  std::copy(values.begin(), values.end(), _parser->values.begin());
  return _parser->parser.Eval();
}

}  // namespace drogue::expression
