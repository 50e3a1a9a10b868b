#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "common/expression/compile.hpp"
#include "kernels/device/expression_program.hpp"

namespace drogue::expression {
namespace {

/// Compiles an expression of t and assembles its device program, as an application does.
device::ExpressionProgram device_program(const std::string& text) {
  device::ExpressionBuilder builder;
  for (const Instruction& step : compile(text, {"x", "y", "z", "t"})) builder.push(step.name, step.value);
  return builder.program();
}

TEST(DeviceProgram, AcceptsEveryFunctionOfTheGrammar) {
  for (const std::string& name : function_names()) {
    const bool two = name == "atan2" || name == "besselj";
    EXPECT_NO_THROW(device_program(name + (two ? "(x, y)" : "(x)"))) << name;
  }
}

TEST(DeviceProgram, AcceptsEveryOperatorOfTheGrammar) {
  const auto program =
      device_program("x+y-z*t/2^3 < 1 || x > y && x <= y || x >= y && x == y || -x != y ? 1 : pi");
  EXPECT_EQ(program.operations[program.length - 1], device::Operation::select);
}

TEST(DeviceProgram, KeepsConstantsInOrder) {
  const auto program = device_program("1.5*x + 2.5");
  EXPECT_EQ(program.length, 5);
  EXPECT_EQ(program.constants[0], 1.5);
  EXPECT_EQ(program.constants[1], 2.5);
}

TEST(DeviceProgram, RefusesAnExpressionThatDoesNotFit) {
  std::string text = "x";
  for (int i = 0; i < 100; ++i) text += " + x";
  EXPECT_THROW(device_program(text), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::expression
