#include "kernels/device/expression_program.hpp"

#include <stdexcept>
#include <string>

namespace drogue::device {
namespace {

struct Step {
  std::string_view name;
  Operation operation;
  int operands;
};

constexpr Step steps[] = {
    {"constant", Operation::constant, 0},
    {"x", Operation::x, 0},
    {"y", Operation::y, 0},
    {"z", Operation::z, 0},
    {"t", Operation::t, 0},
    {"||", Operation::logical_or, 2},
    {"&&", Operation::logical_and, 2},
    {"==", Operation::equal, 2},
    {"!=", Operation::unequal, 2},
    {"<", Operation::less, 2},
    {">", Operation::greater, 2},
    {"<=", Operation::less_equal, 2},
    {">=", Operation::greater_equal, 2},
    {"+", Operation::add, 2},
    {"-", Operation::subtract, 2},
    {"*", Operation::multiply, 2},
    {"/", Operation::divide, 2},
    {"^", Operation::power, 2},
    {"negate", Operation::negate, 1},
    {"select", Operation::select, 3},
    {"sin", Operation::sin, 1},
    {"cos", Operation::cos, 1},
    {"tan", Operation::tan, 1},
    {"asin", Operation::asin, 1},
    {"acos", Operation::acos, 1},
    {"atan", Operation::atan, 1},
    {"atan2", Operation::atan2, 2},
    {"sinh", Operation::sinh, 1},
    {"cosh", Operation::cosh, 1},
    {"tanh", Operation::tanh, 1},
    {"asinh", Operation::asinh, 1},
    {"acosh", Operation::acosh, 1},
    {"atanh", Operation::atanh, 1},
    {"exp", Operation::exp, 1},
    {"log", Operation::log, 1},
    {"ln", Operation::log, 1},
    {"log2", Operation::log2, 1},
    {"log10", Operation::log10, 1},
    {"sqrt", Operation::sqrt, 1},
    {"abs", Operation::abs, 1},
    {"sign", Operation::sign, 1},
    {"rint", Operation::rint, 1},
    {"floor", Operation::floor, 1},
    {"min", Operation::min, 2},
    {"max", Operation::max, 2},
    {"besselj", Operation::besselj, 2},
};

const Step& find_step(std::string_view name) {
  for (const Step& step : steps) {
    if (step.name == name) return step;
  }
  throw std::invalid_argument("an expression program has no step \"" + std::string(name) + "\"");
}

}  // namespace

void ExpressionBuilder::push(std::string_view name, double value) {
  const Step& step = find_step(name);
  if (_program.length == ExpressionProgram::max_length) {
    throw std::invalid_argument("the expression is longer than " +
                                std::to_string(ExpressionProgram::max_length) + " operations");
  }
  if (_depth < step.operands) throw std::invalid_argument("\"" + std::string(name) + "\" lacks an operand");
  _depth += 1 - step.operands;
  if (_depth > ExpressionProgram::max_depth) {
    throw std::invalid_argument("the expression is nested deeper than " +
                                std::to_string(ExpressionProgram::max_depth) + " operands");
  }
  if (step.operation == Operation::constant) {
    if (_constants == ExpressionProgram::max_constants) {
      throw std::invalid_argument("the expression holds more than " +
                                  std::to_string(ExpressionProgram::max_constants) + " numbers");
    }
    _program.constants[_constants++] = value;
  }
  _program.operations[_program.length++] = step.operation;
}

ExpressionProgram ExpressionBuilder::program() const {
  if (_depth != 1) throw std::invalid_argument("the expression does not end with one value");
  return _program;
}

}  // namespace drogue::device
