#pragma once

#include <string>
#include <vector>

namespace drogue::expression {

struct Token {
  enum class Kind { number, name, symbol, end };

  Kind kind = Kind::end;
  std::string text;    ///< name or symbol
  double value = 0.0;  ///< number
  int position = 1;    ///< first character, counted from 1
};

/// Splits an expression; the last token is of kind `end`. Throws ExpressionError.
std::vector<Token> tokenize(const std::string& text);

}  // namespace drogue::expression
