#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace drogue::expression {

/// An expression in muParser syntax, evaluated on the host. One copy a thread: a call uses the object's own
/// scratch.
class Expression {
 public:
  /// Checks `text` against the grammar of compile.hpp; throws ExpressionError.
  Expression(std::string text, std::vector<std::string> variables);
  Expression(const Expression& other);
  Expression(Expression&& other) noexcept;
  Expression& operator=(const Expression& other);
  Expression& operator=(Expression&& other) noexcept;
  ~Expression();

  [[nodiscard]] const std::string& text() const noexcept { return _text; }

  /// `values` in the order of the variables. Not finite where the expression is undefined.
  double operator()(std::span<const double> values) const;

 private:
  struct Parser;
  std::string _text;
  std::vector<std::string> _variables;
  std::unique_ptr<Parser> _parser;
};

}  // namespace drogue::expression
