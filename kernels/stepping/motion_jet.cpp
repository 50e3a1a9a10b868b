#include "kernels/stepping/motion_jet.hpp"

#include <cmath>

#include "kernels/device/expression.hpp"

namespace drogue::stepping {
namespace {

using device::Operation;

MotionJet constant(double value) { return {value, 0.0, 0.0}; }
bool is_constant(const MotionJet& u) { return u.rate == 0.0 && u.acceleration == 0.0; }

MotionJet sum(const MotionJet& u, const MotionJet& v, double weight = 1.0) {
  return {u.value + weight * v.value, u.rate + weight * v.rate, u.acceleration + weight * v.acceleration};
}
MotionJet product(const MotionJet& u, const MotionJet& v) {
  return {u.value * v.value, u.rate * v.value + u.value * v.rate,
          u.acceleration * v.value + 2.0 * u.rate * v.rate + u.value * v.acceleration};
}

/// Jet of f(u) with the derivatives of f at u. A constant has no derivative, wherever it lies.
MotionJet chained(const MotionJet& u, double value, double first, double second) {
  if (is_constant(u)) return constant(value);
  return {value, first * u.rate, second * u.rate * u.rate + first * u.acceleration};
}

MotionJet inverse(const MotionJet& u) {
  const double value = 1.0 / u.value;
  return chained(u, value, -value * value, 2.0 * value * value * value);
}

MotionJet exponential(const MotionJet& u) {
  const double value = device::apply(Operation::exp, u.value);
  return chained(u, value, value, value);
}

MotionJet logarithm(const MotionJet& u) {
  const double value = device::apply(Operation::log, u.value);
  return chained(u, value, 1.0 / u.value, -1.0 / (u.value * u.value));
}

MotionJet power(const MotionJet& u, const MotionJet& v) {
  const double value = device::apply(Operation::power, u.value, v.value), n = v.value;
  if (!is_constant(v)) {
    const MotionJet jet = exponential(product(v, logarithm(u)));
    return {value, jet.rate, jet.acceleration};
  }
  const auto term = [&](double factor, double exponent) {
    return factor == 0.0 ? 0.0 : factor * device::apply(Operation::power, u.value, exponent);
  };
  return chained(u, value, term(n, n - 1.0), term(n * (n - 1.0), n - 2.0));
}

MotionJet angle(const MotionJet& y, const MotionJet& x) {
  const MotionJet square = sum(product(x, x), product(y, y)), inverse_square = inverse(square);
  const double rate = (x.value * y.rate - y.value * x.rate) * inverse_square.value;
  const double acceleration =
      (x.value * y.acceleration - y.value * x.acceleration - rate * square.rate) * inverse_square.value;
  const double value = device::apply(Operation::atan2, y.value, x.value);
  return is_constant(x) && is_constant(y) ? constant(value) : MotionJet{value, rate, acceleration};
}

MotionJet bessel(const MotionJet& order, const MotionJet& u) {
  const auto j = [&](int shift) { return device::apply(Operation::besselj, order.value + shift, u.value); };
  return chained(u, j(0), 0.5 * (j(-1) - j(1)), 0.25 * (j(-2) - 2.0 * j(0) + j(2)));
}

MotionJet applied(Operation operation, const MotionJet& u) {
  const double x = u.value, value = device::apply(operation, x);
  const auto function = [&](double first, double second) { return chained(u, value, first, second); };
  const double cosine = device::apply(Operation::cos, x), sine = device::apply(Operation::sin, x);
  const double one_minus = 1.0 - x * x, one_plus = 1.0 + x * x;
  switch (operation) {
    case Operation::negate:
      return {-u.value, -u.rate, -u.acceleration};
    case Operation::sin:
      return function(cosine, -value);
    case Operation::cos:
      return function(-sine, -value);
    case Operation::tan:
      return function(1.0 + value * value, 2.0 * value * (1.0 + value * value));
    case Operation::asin:
      return function(1.0 / std::sqrt(one_minus), x / (one_minus * std::sqrt(one_minus)));
    case Operation::acos:
      return function(-1.0 / std::sqrt(one_minus), -x / (one_minus * std::sqrt(one_minus)));
    case Operation::atan:
      return function(1.0 / one_plus, -2.0 * x / (one_plus * one_plus));
    case Operation::sinh:
      return function(device::apply(Operation::cosh, x), value);
    case Operation::cosh:
      return function(device::apply(Operation::sinh, x), value);
    case Operation::tanh:
      return function(1.0 - value * value, -2.0 * value * (1.0 - value * value));
    case Operation::asinh:
      return function(1.0 / std::sqrt(one_plus), -x / (one_plus * std::sqrt(one_plus)));
    case Operation::acosh:
      return function(1.0 / std::sqrt(-one_minus), x / (one_minus * std::sqrt(-one_minus)));
    case Operation::atanh:
      return function(1.0 / one_minus, 2.0 * x / (one_minus * one_minus));
    case Operation::exp:
      return function(value, value);
    case Operation::log:
      return logarithm(u);
    case Operation::log2:
      return product(constant(1.0 / device::portable::ln2), logarithm(u));
    case Operation::log10:
      return product(constant(1.0 / device::portable::ln10), logarithm(u));
    case Operation::sqrt:
      return function(0.5 / value, -0.25 / (value * x));
    case Operation::abs:
      return x < 0.0 ? MotionJet{-u.value, -u.rate, -u.acceleration} : u;
    default:  // steps: sign, rint, floor
      return constant(value);
  }
}

MotionJet applied(Operation operation, const MotionJet& u, const MotionJet& v) {
  switch (operation) {
    case Operation::add:
      return sum(u, v);
    case Operation::subtract:
      return sum(u, v, -1.0);
    case Operation::multiply:
      return product(u, v);
    case Operation::divide: {
      const MotionJet quotient = product(u, inverse(v));
      return {u.value / v.value, quotient.rate, quotient.acceleration};
    }
    case Operation::power:
      return power(u, v);
    case Operation::atan2:
      return angle(u, v);
    case Operation::min:
      return v.value < u.value ? v : u;
    case Operation::max:
      return u.value < v.value ? v : u;
    case Operation::besselj:
      return bessel(u, v);
    default:  // comparisons and logic
      return constant(device::apply(operation, u.value, v.value));
  }
}

}  // namespace

MotionJet motion_jet(const device::ExpressionProgram& program, const std::array<double, 3>& place,
                     double time) {
  MotionJet stack[device::ExpressionProgram::max_depth + 1];
  int top = -1, constants = 0;
  for (int i = 0; i < program.length; ++i) {
    const Operation operation = program.operations[i];
    const int operands = device::operands_of(operation);
    top += 1 - operands;
    MotionJet& result = stack[top];
    if (operands == 3)
      result = stack[top].value != 0.0 ? stack[top + 1] : stack[top + 2];
    else if (operands == 2)
      result = applied(operation, stack[top], stack[top + 1]);
    else if (operands == 1)
      result = applied(operation, stack[top]);
    else if (operation == Operation::constant)
      result = constant(program.constants[constants++]);
    else if (operation == Operation::t)
      result = {time, 1.0, 0.0};
    else
      result = constant(place[operation == Operation::x ? 0 : operation == Operation::y ? 1 : 2]);
  }
  return stack[0];
}

}  // namespace drogue::stepping
