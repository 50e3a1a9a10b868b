#include "common/expression/token.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "common/expression/compile.hpp"

namespace drogue::expression {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// Longer symbols first, so that `<=` is not read as `<`.
constexpr std::array<std::string_view, 18> symbols = {"||", "&&", "==", "!=", "<=", ">=", "<", ">", "+",
                                                      "-",  "*",  "/",  "^",  "(",  ")",  ",", "?", ":"};

Token read_number(std::string_view rest, int position) {
  Token token{Token::Kind::number, "", 0.0, position};
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), token.value);
  if (error != std::errc{} || !std::isfinite(token.value)) {
    throw ExpressionError(position, "a number that no double holds");
  }
  token.text = rest.substr(0, static_cast<std::size_t>(end - rest.data()));
  return token;
}

Token read_name(std::string_view rest, int position) {
  std::size_t length = 0;
  while (length < rest.size() && (is_letter(rest[length]) || is_digit(rest[length]))) ++length;
  return {Token::Kind::name, std::string(rest.substr(0, length)), 0.0, position};
}

Token read_symbol(std::string_view rest, int position) {
  for (const std::string_view symbol : symbols) {
    if (rest.starts_with(symbol)) return {Token::Kind::symbol, std::string(symbol), 0.0, position};
  }
  if (rest[0] == '=') throw ExpressionError(position, "\"=\" assigns; to compare write \"==\"");
  const auto byte = static_cast<unsigned char>(rest[0]);
  const bool printable = byte > 0x20 && byte < 0x7f;
  throw ExpressionError(position, printable ? "unexpected character \"" + std::string(1, rest[0]) + "\""
                                            : "a character that no expression has");
}

}  // namespace

std::vector<Token> tokenize(const std::string& text) {
  std::vector<Token> tokens;
  std::size_t at = 0;
  const std::string_view whole = text;
  while (true) {
    while (at < text.size() && (text[at] == ' ' || text[at] == '\t' || text[at] == '\n' || text[at] == '\r'))
      ++at;
    const int position = static_cast<int>(at) + 1;
    if (at == text.size()) {
      tokens.push_back({Token::Kind::end, "", 0.0, position});
      return tokens;
    }
    const std::string_view rest = whole.substr(at);
    const bool number = is_digit(rest[0]) || (rest[0] == '.' && rest.size() > 1 && is_digit(rest[1]));
    tokens.push_back(number               ? read_number(rest, position)
                     : is_letter(rest[0]) ? read_name(rest, position)
                                          : read_symbol(rest, position));
    at += tokens.back().text.size();
  }
}

}  // namespace drogue::expression
