#pragma once

#include <initializer_list>
#include <string>
#include <variant>

#include "kernels/device/expression_program.hpp"

namespace drogue::testing {

/// Program from its instructions in postfix order: numbers, variables, operators, functions.
inline device::ExpressionProgram postfix(std::initializer_list<std::variant<double, const char*>> steps) {
  device::ExpressionBuilder builder;
  for (const auto& step : steps) {
    if (const double* number = std::get_if<double>(&step))
      builder.push("constant", *number);
    else
      builder.push(std::get<const char*>(step));
  }
  return builder.program();
}

}  // namespace drogue::testing
