#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace drogue::expression {

/// Expression in muParser syntax, evaluated on the host. Not thread-safe: every thread needs a copy.
class Expression {
 public:
  /// Throws ExpressionError if `text` does not fit the grammar of compile.hpp.
  Expression(std::string text, std::vector<std::string> variables);
  Expression(const Expression& other);
  Expression(Expression&& other) noexcept;
  Expression& operator=(const Expression& other);
  Expression& operator=(Expression&& other) noexcept;
  ~Expression();

  [[nodiscard]] const std::string& text() const noexcept { return _text; }

  /// Evaluates the expression; `values` in the order of the variables. Returns a non-finite number where the
  /// expression is undefined.
  double operator()(std::span<const double> values) const;

 private:
  struct Parser;
  std::string _text;
  std::vector<std::string> _variables;
  std::unique_ptr<Parser> _parser;
};

}  // namespace drogue::expression
