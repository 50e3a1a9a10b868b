#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace drogue::expression {

/// Error in an expression; `position` counts characters from 1.
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(int position, const std::string& sentence)
      : std::runtime_error(sentence), _position(position) {}

  [[nodiscard]] int position() const noexcept { return _position; }

 private:
  int _position;
};

/// Instruction of a postfix program. `name` is "constant" (pushes `value`), a variable (pushes it), an
/// operator of the grammar, "negate", "select" (c, a, b -> c ? a : b) or a function. min, max, sum and avg
/// are unfolded to pairs, so every name has a fixed number of operands.
struct Instruction {
  std::string name;
  double value = 0.0;
};

/// Compiles muParser syntax without assignment, strings and lists: numbers, `variables`, pi, the operators ?:
/// || && == != < > <= >= + - * / ^ and the functions of `function_names`. Throws ExpressionError, also for a
/// number that is no order of `besselj`, an integer from -1000 to 1000; another order gives NaN there.
std::vector<Instruction> compile(const std::string& text, const std::vector<std::string>& variables);

/// Functions that an expression may call.
const std::vector<std::string>& function_names();

}  // namespace drogue::expression
