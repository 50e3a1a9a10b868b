#include "common/expression/compile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "common/expression/token.hpp"

namespace drogue::expression {
namespace {

/// `arguments` 0: one or more, folded to pairs.
struct Function {
  std::string_view name;
  int arguments;
};

constexpr std::array<Function, 28> functions = {
    {{"sin", 1},  {"cos", 1},  {"tan", 1},  {"asin", 1},  {"acos", 1},  {"atan", 1},    {"atan2", 2},
     {"sinh", 1}, {"cosh", 1}, {"tanh", 1}, {"asinh", 1}, {"acosh", 1}, {"atanh", 1},   {"exp", 1},
     {"log", 1},  {"ln", 1},   {"log2", 1}, {"log10", 1}, {"sqrt", 1},  {"abs", 1},     {"sign", 1},
     {"rint", 1}, {"min", 0},  {"max", 0},  {"sum", 0},   {"avg", 0},   {"besselj", 2}, {"floor", 1}}};

/// Operators by binding strength, weakest first; all of them group from the left.
const std::vector<std::vector<std::string_view>> levels = {
    {"||"}, {"&&"}, {"==", "!=", "<", ">", "<=", ">="}, {"+", "-"}, {"*", "/"}};

/// Recursive descent that emits postfix as it goes.
class Compiler {
 public:
  Compiler(const std::string& text, const std::vector<std::string>& variables)
      : _tokens(tokenize(text)), _variables(variables) {}

  std::vector<Instruction> run() {
    ternary();
    if (now().kind != Token::Kind::end) fail("unexpected " + shown(now()));
    return std::move(_program);
  }

 private:
  [[nodiscard]] const Token& now() const { return _tokens[_next]; }
  [[nodiscard]] bool at(std::string_view symbol) const {
    return now().kind == Token::Kind::symbol && now().text == symbol;
  }
  bool take(std::string_view symbol) {
    if (!at(symbol)) return false;
    ++_next;
    return true;
  }
  void need(const std::string& symbol) {
    if (!take(symbol)) fail("expected \"" + symbol + "\", not " + shown(now()));
  }
  static std::string shown(const Token& token) {
    return token.kind == Token::Kind::end ? "the end of the expression"
                                          : "\"" + token.text.substr(0, 40) + "\"";
  }
  [[noreturn]] void fail(const std::string& sentence) const {
    throw ExpressionError(now().position, sentence);
  }
  void emit(std::string_view name, double value = 0.0) { _program.push_back({std::string(name), value}); }

  void ternary() {
    constexpr int deepest = 100;  // a scene must not be able to exhaust the stack
    if (++_depth > deepest) fail("parentheses or signs nested too deeply");
    binary(0);
    if (take("?")) {
      ternary();
      need(":");
      ternary();
      emit("select");
    }
    --_depth;
  }

  void binary(std::size_t level) {
    if (level == levels.size()) return signed_power();
    binary(level + 1);
    while (now().kind == Token::Kind::symbol) {
      const auto& symbols = levels[level];
      const auto found = std::find(symbols.begin(), symbols.end(), now().text);
      if (found == symbols.end()) return;
      ++_next;
      binary(level + 1);
      emit(*found);
    }
  }

  /// A sign binds weaker than ^, which groups from the right: -x^2 = -(x^2), 2^-1 = 1/2, 2^3^2 = 2^9.
  void signed_power() {
    const bool negative = at("-");
    if (negative || at("+")) {
      ++_next;
      if (at("-") || at("+")) fail("two signs in a row; put what follows the first one in parentheses");
    }
    primary();
    if (take("^")) {
      if (++_depth > 100) fail("powers nested too deeply");
      signed_power();
      --_depth;
      emit("^");
    }
    if (negative) emit("negate");
  }

  void primary() {
    const Token token = now();
    if (token.kind == Token::Kind::number) {
      ++_next;
      return emit("constant", token.value);
    }
    if (take("(")) {
      ternary();
      return need(")");
    }
    if (token.kind != Token::Kind::name) fail("expected a number, a name or \"(\", not " + shown(token));
    ++_next;
    if (at("(")) return call(token);
    if (token.text == "pi") return emit("constant", std::numbers::pi);
    if (std::find(_variables.begin(), _variables.end(), token.text) != _variables.end())
      return emit(token.text);
    --_next;
    std::string known = "pi";
    for (const std::string& variable : _variables) known += ", " + variable;
    fail("unknown name " + shown(token) + "; known here are " + known);
  }

  /// Refuses a number, whose instructions begin at `first`, as the order of a Bessel function without one.
  void check_order(std::size_t first, int position) const {
    const std::size_t length = _program.size() - first;
    const bool is_number = _program[first].name == "constant" &&
                           (length == 1 || (length == 2 && _program.back().name == "negate"));
    const double order = _program[first].value;
    if (is_number && (order != std::floor(order) || order > 1000.0))
      throw ExpressionError(position, "besselj has integer orders from -1000 to 1000");
  }

  void call(const Token& name) {
    const auto* function = std::find_if(functions.begin(), functions.end(), [&](const Function& candidate) {
      return candidate.name == name.text;
    });
    if (function == functions.end()) {
      --_next;
      std::string known;
      for (const std::string& valid : function_names()) known += (known.empty() ? "" : ", ") + valid;
      fail("unknown function " + shown(name) + "; known are " + known);
    }
    need("(");
    int arguments = 0;
    const bool folds = function->arguments == 0;
    do {
      const int position = now().position;
      const std::size_t first = _program.size();
      ternary();
      ++arguments;
      if (name.text == "besselj" && arguments == 1) check_order(first, position);
      if (folds && arguments > 1) emit(name.text == "avg" || name.text == "sum" ? "+" : name.text);
    } while (take(","));
    if (!folds && arguments != function->arguments) {
      fail(name.text + " takes " + std::to_string(function->arguments) + " argument(s), not " +
           std::to_string(arguments));
    }
    need(")");
    if (!folds) return emit(name.text);
    if (name.text == "avg") {
      emit("constant", arguments);
      emit("/");
    }
  }

  std::vector<Token> _tokens;
  const std::vector<std::string>& _variables;
  std::vector<Instruction> _program;
  std::size_t _next = 0;
  int _depth = 0;
};

}  // namespace

std::vector<Instruction> compile(const std::string& text, const std::vector<std::string>& variables) {
  return Compiler(text, variables).run();
}

const std::vector<std::string>& function_names() {
  static const std::vector<std::string> names([] {
    std::vector<std::string> result;
    for (const Function& function : functions) result.emplace_back(function.name);
    return result;
  }());
  return names;
}

}  // namespace drogue::expression
