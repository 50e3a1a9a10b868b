#pragma once

#include <cstdint>
#include <string_view>

namespace drogue::device {

/// Instruction of an expression program, which operates on a stack of reals.
enum class Operation : std::uint8_t {
  constant,
  x,
  y,
  z,
  t,
  logical_or,
  logical_and,
  equal,
  unequal,
  less,
  greater,
  less_equal,
  greater_equal,
  add,
  subtract,
  multiply,
  divide,
  power,
  negate,
  select,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,
  sinh,
  cosh,
  tanh,
  asinh,
  acosh,
  atanh,
  exp,
  log,
  log2,
  log10,
  sqrt,
  abs,
  sign,
  rint,
  floor,
  min,
  max,
  besselj,
};

/// Expression of x, y, z and t as a postfix program. Trivially copyable, to be captured by kernels.
struct ExpressionProgram {
  static constexpr int max_length = 96;
  static constexpr int max_constants = 32;
  static constexpr int max_depth = 16;

  int length = 0;
  Operation operations[max_length] = {};
  double constants[max_constants] = {};  ///< in the order of the `constant` operations
};

/// Builds a program from the names of its instructions: "constant", a variable, an operator (`+`, `<=`),
/// "negate", "select" or a function. Each call throws std::invalid_argument (one sentence) for an unknown
/// name, a stack underflow or overflow, or a program that is too long.
class ExpressionBuilder {
 public:
  /// Appends an instruction; `value` is the number of a "constant".
  void push(std::string_view name, double value = 0.0);

  /// Finished program. Throws if it does not leave exactly one value on the stack.
  [[nodiscard]] ExpressionProgram program() const;

 private:
  ExpressionProgram _program;
  int _constants = 0;
  int _depth = 0;
};

}  // namespace drogue::device
