#pragma once

#include "kernels/device/bessel.hpp"
#include "kernels/device/expression_program.hpp"
#include "kernels/device/portable_math.hpp"

namespace drogue::device {

/// Value of an operation with one operand; `a` itself for any other operation.
KOKKOS_INLINE_FUNCTION double apply(Operation operation, double a) {
  switch (operation) {
    case Operation::negate:
      return -a;
    case Operation::sin:
      return portable::wide_sin(a);
    case Operation::cos:
      return portable::wide_cos(a);
    case Operation::tan:
      return portable::wide_sin(a) / portable::wide_cos(a);
    case Operation::asin:
      return portable::asin(a);
    case Operation::acos:
      return portable::acos(a);
    case Operation::atan:
      return portable::atan(a);
    case Operation::sinh:
      return portable::sinh(a);
    case Operation::cosh:
      return portable::cosh(a);
    case Operation::tanh:
      return portable::tanh(a);
    case Operation::asinh:
      return portable::asinh(a);
    case Operation::acosh:
      return portable::acosh(a);
    case Operation::atanh:
      return portable::atanh(a);
    case Operation::exp:
      return portable::exp(a);
    case Operation::log:
      return portable::log(a);
    case Operation::log2:
      return portable::log(a) / portable::ln2;
    case Operation::log10:
      return portable::log(a) / portable::ln10;
    case Operation::sqrt:
      return Kokkos::sqrt(a);
    case Operation::abs:
      return portable::magnitude(a);
    case Operation::sign:
      return a < 0.0 ? -1.0 : a > 0.0 ? 1.0 : 0.0;
    case Operation::rint:
      return Kokkos::floor(a + 0.5);
    case Operation::floor:
      return Kokkos::floor(a);
    default:
      return a;
  }
}

/// Value of an operation with two operands; comparisons return 1 or 0.
KOKKOS_INLINE_FUNCTION double apply(Operation operation, double a, double b) {
  switch (operation) {
    case Operation::logical_or:
      return a != 0.0 || b != 0.0 ? 1.0 : 0.0;
    case Operation::logical_and:
      return a != 0.0 && b != 0.0 ? 1.0 : 0.0;
    case Operation::equal:
      return a == b ? 1.0 : 0.0;
    case Operation::unequal:
      return a != b ? 1.0 : 0.0;
    case Operation::less:
      return a < b ? 1.0 : 0.0;
    case Operation::greater:
      return a > b ? 1.0 : 0.0;
    case Operation::less_equal:
      return a <= b ? 1.0 : 0.0;
    case Operation::greater_equal:
      return a >= b ? 1.0 : 0.0;
    case Operation::add:
      return a + b;
    case Operation::subtract:
      return a - b;
    case Operation::multiply:
      return a * b;
    case Operation::divide:
      return a / b;
    case Operation::power:
      return portable::pow(a, b);
    case Operation::atan2:
      return portable::atan2(a, b);
    case Operation::min:
      return b < a ? b : a;
    case Operation::max:
      return a < b ? b : a;
    default:
      return portable::besselj(a, b);
  }
}

/// Number of operands that an operation pops from the stack.
KOKKOS_INLINE_FUNCTION int operands_of(Operation operation) {
  if (operation <= Operation::t) return 0;
  if (operation == Operation::select) return 3;
  const bool two = operation <= Operation::power || operation == Operation::atan2 ||
                   operation == Operation::min || operation == Operation::max ||
                   operation == Operation::besselj;
  return two ? 2 : 1;
}

/// Value of a program at the point (x, y, z) and time t. Evaluates both branches of a `select`.
KOKKOS_INLINE_FUNCTION double evaluate(const ExpressionProgram& program, double x, double y, double z,
                                       double t) {
  double stack[ExpressionProgram::max_depth + 1];
  int top = -1;
  int constant = 0;
  for (int i = 0; i < program.length; ++i) {
    const Operation operation = program.operations[i];
    switch (operands_of(operation)) {
      case 0:
        ++top;
        stack[top] = operation == Operation::constant ? program.constants[constant++]
                     : operation == Operation::x      ? x
                     : operation == Operation::y      ? y
                     : operation == Operation::z      ? z
                                                      : t;
        break;
      case 1:
        stack[top] = apply(operation, stack[top]);
        break;
      case 2:
        --top;
        stack[top] = apply(operation, stack[top], stack[top + 1]);
        break;
      default:
        top -= 2;
        stack[top] = stack[top] != 0.0 ? stack[top + 1] : stack[top + 2];
        break;
    }
  }
  return stack[0];
}

}  // namespace drogue::device
