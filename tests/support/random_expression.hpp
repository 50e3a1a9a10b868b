#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace drogue::testing {

/// Instruction of a postfix program, by name; `value` is the number of a "constant".
struct Step {
  std::string name;
  double value = 0.0;
  bool operator==(const Step&) const = default;
};

/// Value of a postfix program by <cmath>, independent of the evaluators under test.
template <class Real>
Real reference_value(const std::vector<Step>& steps, Real x, Real y, Real z, Real t) {
  std::vector<Real> stack;
  const auto pop = [&stack] {
    const Real top = stack.back();
    stack.pop_back();
    return top;
  };
  const auto truth = [](bool holds) { return holds ? Real(1) : Real(0); };
  for (const Step& step : steps) {
    const std::string& name = step.name;
    if (name == "constant") {
      stack.push_back(static_cast<Real>(step.value));
    } else if (name == "x" || name == "y" || name == "z" || name == "t") {
      stack.push_back(name == "x" ? x : name == "y" ? y : name == "z" ? z : t);
    } else if (name == "select") {
      const Real otherwise = pop();
      const Real then = pop();
      stack.push_back(pop() != 0 ? then : otherwise);
    } else if (name.find_first_of("+-*/^<>=&|!") == 0 || name == "min" || name == "max" || name == "atan2" ||
               name == "besselj") {
      const Real b = pop();
      const Real a = pop();
      stack.push_back(name == "+"       ? a + b
                      : name == "-"     ? a - b
                      : name == "*"     ? a * b
                      : name == "/"     ? a / b
                      : name == "^"     ? std::pow(a, b)
                      : name == "<"     ? truth(a < b)
                      : name == ">"     ? truth(a > b)
                      : name == "<="    ? truth(a <= b)
                      : name == ">="    ? truth(a >= b)
                      : name == "=="    ? truth(a == b)
                      : name == "!="    ? truth(a != b)
                      : name == "&&"    ? truth(a != 0 && b != 0)
                      : name == "||"    ? truth(a != 0 || b != 0)
                      : name == "min"   ? std::min(a, b)
                      : name == "max"   ? std::max(a, b)
                      : name == "atan2" ? std::atan2(a, b)
                                        : static_cast<Real>(::jnl(static_cast<int>(a), b)));
    } else {
      const Real a = pop();
      stack.push_back(name == "negate"  ? -a
                      : name == "sin"   ? std::sin(a)
                      : name == "cos"   ? std::cos(a)
                      : name == "tan"   ? std::tan(a)
                      : name == "asin"  ? std::asin(a)
                      : name == "acos"  ? std::acos(a)
                      : name == "atan"  ? std::atan(a)
                      : name == "sinh"  ? std::sinh(a)
                      : name == "cosh"  ? std::cosh(a)
                      : name == "tanh"  ? std::tanh(a)
                      : name == "asinh" ? std::asinh(a)
                      : name == "acosh" ? std::acosh(a)
                      : name == "atanh" ? std::atanh(a)
                      : name == "exp"   ? std::exp(a)
                      : name == "log"   ? std::log(a)
                      : name == "ln"    ? std::log(a)
                      : name == "log2"  ? std::log2(a)
                      : name == "log10" ? std::log10(a)
                      : name == "sqrt"  ? std::sqrt(a)
                      : name == "abs"   ? std::abs(a)
                      : name == "sign"  ? Real(a > 0) - Real(a < 0)
                      : name == "rint"  ? std::floor(a + Real(0.5))
                                        : std::floor(a));
    }
  }
  return stack.back();
}

/// Random expression as text, with necessary and a few redundant parentheses, and as the equivalent postfix
/// program.
class RandomExpression {
 public:
  explicit RandomExpression(unsigned seed) : _random(seed) { _root = make(4); }

  [[nodiscard]] const std::string& text() const { return _root.text; }
  [[nodiscard]] const std::vector<Step>& steps() const { return _root.steps; }

 private:
  struct Part {
    std::string text;
    int strength;  ///< of its outermost operator: 0 ?: ... 5 * /, 6 sign, 7 ^, 8 a primary
    std::vector<Step> steps;
  };

  int pick(int count) { return std::uniform_int_distribution<int>(0, count - 1)(_random); }

  static void append(std::vector<Step>& steps, const std::vector<Step>& more) {
    steps.insert(steps.end(), more.begin(), more.end());
  }

  std::string inside(const Part& part, int least) {
    const bool needs = part.strength < least || pick(8) == 0;
    return needs ? "(" + part.text + ")" : part.text;
  }

  Part leaf() {
    static const char* const names[] = {"x", "y", "z", "t"};
    if (pick(3) != 0) {
      const std::string name = names[pick(4)];
      return {name, 8, {{name, 0.0}}};
    }
    const double value = 0.25 * (1 + pick(12));
    std::string text = std::to_string(value);
    return {text, 8, {{"constant", std::stod(text)}}};
  }

  Part binary(int depth) {
    static const std::pair<const char*, int> operators[] = {
        {"||", 1}, {"&&", 2}, {"==", 3}, {"!=", 3}, {"<", 3}, {">", 3}, {"<=", 3}, {">=", 3},
        {"+", 4},  {"-", 4},  {"*", 5},  {"/", 5},  {"+", 4}, {"-", 4}, {"*", 5}};
    const auto& [symbol, strength] = operators[pick(15)];
    return join(symbol, strength, operand(strength, depth), operand(strength, depth));
  }

  /// Operands of && and || are comparisons, because muParser truncates constant operands to integers.
  Part operand(int strength, int depth) {
    if (strength > 2) return make(depth - 1);
    return join("<", 3, make(depth - 1), make(depth - 1));
  }

  Part join(const std::string& symbol, int strength, const Part& left, const Part& right) {
    Part part{inside(left, strength) + " " + symbol + " " + inside(right, strength + 1), strength,
              left.steps};
    append(part.steps, right.steps);
    part.steps.push_back({symbol, 0.0});
    return part;
  }

  Part power(int depth) {
    const Part base = call("abs", make(depth - 1));
    const Part exponent = pick(4) == 0 ? negate(leaf()) : leaf();
    Part part{inside(base, 8) + "^" + inside(exponent, 6), 7, base.steps};
    append(part.steps, exponent.steps);
    part.steps.push_back({"^", 0.0});
    return part;
  }

  Part negate(const Part& operand) {
    Part part{"-" + inside(operand, 7), 6, operand.steps};
    part.steps.push_back({"negate", 0.0});
    return part;
  }

  Part choice(int depth) {
    const Part parts[] = {make(depth - 1), make(depth - 1), make(depth - 1)};
    Part part{inside(parts[0], 1) + " ? " + inside(parts[1], 1) + " : " + inside(parts[2], 0), 0, {}};
    for (const Part& each : parts) append(part.steps, each.steps);
    part.steps.push_back({"select", 0.0});
    return part;
  }

  static Part call(const std::string& name, const Part& argument) {
    Part part{name + "(" + argument.text + ")", 8, argument.steps};
    part.steps.push_back({name, 0.0});
    return part;
  }

  /// Restricts arguments to ranges where the function is defined and well conditioned.
  Part function(int depth) {
    static const char* const any[] = {"sin", "cos", "atan", "tanh", "abs", "sign", "asinh", "rint", "floor"};
    static const char* const small[] = {"exp", "sinh", "cosh", "asin", "acos", "tan"};
    static const char* const positive[] = {"sqrt", "log", "ln", "log2", "log10", "acosh"};
    const Part argument = make(depth - 1);
    const int kind = pick(5);
    if (kind == 0) return call(any[pick(9)], argument);
    if (kind == 1) return call(small[pick(6)], call("sin", argument));
    if (kind == 2) {
      Part shifted{"1+abs(" + argument.text + ")", 4, {{"constant", 1.0}}};
      append(shifted.steps, argument.steps);
      shifted.steps.push_back({"abs", 0.0});
      shifted.steps.push_back({"+", 0.0});
      return call(positive[pick(6)], shifted);
    }
    if (kind == 3) {
      const int order = pick(5);
      Part part{
          "besselj(" + std::to_string(order) + ", " + argument.text + ")", 8, {{"constant", double(order)}}};
      append(part.steps, argument.steps);
      part.steps.push_back({"besselj", 0.0});
      return part;
    }
    static const char* const pairs[] = {"min", "max", "atan2", "sum"};
    const std::string name = pairs[pick(4)];
    const Part second = make(depth - 1);
    Part part{name + "(" + argument.text + "," + second.text + ")", 8, argument.steps};
    append(part.steps, second.steps);
    part.steps.push_back({name == "sum" ? "+" : name, 0.0});
    return part;
  }

  Part make(int depth) {
    if (depth == 0) return leaf();
    switch (pick(8)) {
      case 0:
        return leaf();
      case 1:
        return negate(make(depth - 1));
      case 2:
        return choice(depth);
      case 3:
        return power(depth);
      case 4:
      case 5:
        return function(depth);
      default:
        return binary(depth);
    }
  }

  std::mt19937 _random;
  Part _root;
};

/// True if rounding of the arguments changes the value by less than `tolerance`. False near poles and jumps,
/// where two correct evaluations may differ.
inline bool well_conditioned(const std::vector<Step>& steps, double x, double y, double z, double t,
                             double tolerance) {
  const long double exact = reference_value<long double>(steps, x, y, z, t);
  if (!std::isfinite(static_cast<double>(exact)) || std::abs(exact) > 1e6L) return false;
  for (const long double nudge : {1e-13L, -1e-13L}) {
    const long double moved = reference_value<long double>(steps, x * (1 + nudge), y * (1 - nudge),
                                                           z * (1 + nudge), t * (1 - nudge));
    if (!(std::abs(moved - exact) <= tolerance * std::max(1.0L, std::abs(exact)))) return false;
  }
  return true;
}

}  // namespace drogue::testing
