#include "common/expression/expression.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/expression/compile.hpp"
#include "common/expression/sample_times.hpp"
#include "tests/support/random_expression.hpp"

namespace drogue::expression {
namespace {

const std::vector<std::string> xyzt = {"x", "y", "z", "t"};

double value(const std::string& text, double x = 0.3, double y = -0.7, double z = 1.9, double t = 0.45) {
  const std::array<double, 4> point = {x, y, z, t};
  return Expression(text, xyzt)(point);
}

std::vector<testing::Step> steps_of(const std::string& text) {
  std::vector<testing::Step> steps;
  for (const Instruction& instruction : compile(text, xyzt))
    steps.push_back({instruction.name, instruction.value});
  return steps;
}

/// Position and message of an expression error.
std::pair<int, std::string> error_of(const std::string& text) {
  try {
    const Expression expression(text, xyzt);
  } catch (const ExpressionError& error) {
    return {error.position(), error.what()};
  }
  return {0, ""};
}

TEST(Expression, AgreesWithMuParser) {
  EXPECT_DOUBLE_EQ(value("1 + 2*3^2"), 19.0);
  EXPECT_DOUBLE_EQ(value("-2^2"), -4.0);
  EXPECT_DOUBLE_EQ(value("2^3^2"), 512.0);
  EXPECT_DOUBLE_EQ(value("2^-1"), 0.5);
  EXPECT_DOUBLE_EQ(value("x < 0 ? 1 : x > 0 ? 2 : 3"), 2.0);
  EXPECT_DOUBLE_EQ(value("pi"), std::numbers::pi);
  EXPECT_DOUBLE_EQ(value("ln(2) - log(2)"), 0.0);
  EXPECT_DOUBLE_EQ(value("avg(1, 2, 6) + min(3, 1, 2) + max(4, 9, 2) + sum(1, 2, 3)"), 3.0 + 1.0 + 9.0 + 6.0);
  EXPECT_DOUBLE_EQ(value("floor(-1.5) + rint(2.4) + sign(y)"), -2.0 + 2.0 - 1.0);
}

TEST(Expression, EvaluatesBesselFunctions) {
  EXPECT_NEAR(value("besselj(0, 2.404825557695773)"), 0.0, 1e-15);
  EXPECT_NEAR(value("besselj(1, 1)"), 0.44005058574493355, 1e-15);
  EXPECT_NEAR(value("besselj(2, -5)"), 0.04656511627775222, 1e-15);
  EXPECT_TRUE(std::isnan(value("besselj(x, 1)")));
}

TEST(Expression, RefusesNumbersThatAreNoOrdersOfBesselFunctions) {
  for (const char* order : {"0.5", "1001", "-1001", "-2.5"})
    EXPECT_EQ(error_of(std::string("1 + besselj(") + order + ", x)"),
              std::pair(13, std::string("besselj has integer orders from -1000 to 1000")))
        << order;
  for (const char* order : {"1000", "-1000", "-0", "500*t", "2*600"})
    EXPECT_EQ(error_of(std::string("besselj(") + order + ", x)").second, "") << order;
}

TEST(Expression, CopiesEvaluateIndependently) {
  const Expression first("x + 10*y", {"x", "y"});
  const Expression second = first;
  const std::array<double, 2> a = {1.0, 2.0};
  const std::array<double, 2> b = {3.0, 4.0};
  EXPECT_DOUBLE_EQ(first(a), 21.0);
  EXPECT_DOUBLE_EQ(second(b), 43.0);
  EXPECT_DOUBLE_EQ(first(a), 21.0);
}

TEST(Expression, ErrorsNameThePosition) {
  EXPECT_EQ(error_of("1 +"),
            std::pair(4, std::string("expected a number, a name or \"(\", not the end of the expression")));
  EXPECT_EQ(error_of("sin(x").first, 6);
  EXPECT_EQ(error_of("x + w").first, 5);
  EXPECT_NE(error_of("x + w").second.find("known here are pi, x, y, z, t"), std::string::npos);
  EXPECT_EQ(error_of("sinus(x)").first, 1);
  EXPECT_EQ(error_of("x = 3").first, 3);
  EXPECT_EQ(error_of("1, 2").first, 2);
  EXPECT_EQ(error_of("x ? 1").first, 6);
  EXPECT_EQ(error_of("atan2(x)").first, 8);
  EXPECT_EQ(error_of("1e999").first, 1);
  EXPECT_EQ(error_of("2x").first, 2);
  EXPECT_EQ(error_of("\"a\"").first, 1);
  EXPECT_EQ(error_of("").first, 1);
  EXPECT_GT(error_of(std::string(5000, '(')).first, 0);
  EXPECT_GT(error_of("2" + std::string(0, ' ') +
                     [] {
                       std::string tower;
                       for (int i = 0; i < 5000; ++i) tower += "^2";
                       return tower;
                     }())
                .first,
            0);
}

TEST(Compile, EmitsPostfixInOperatorPrecedence) {
  for (unsigned seed = 0; seed < 2000; ++seed) {
    const testing::RandomExpression random(seed);
    ASSERT_EQ(steps_of(random.text()), random.steps()) << random.text();
  }
}

TEST(Compile, AgreesWithMuParser) {
  int compared = 0;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    const testing::RandomExpression random(seed);
    const double x = 0.3, y = -0.7, z = 1.9, t = 0.45;
    if (!testing::well_conditioned(random.steps(), x, y, z, t, 1e-10)) continue;
    const double expected = testing::reference_value<double>(steps_of(random.text()), x, y, z, t);
    EXPECT_NEAR(value(random.text(), x, y, z, t), expected, 1e-9 * std::max(1.0, std::abs(expected)))
        << random.text();
    ++compared;
  }
  EXPECT_GT(compared, 1500);
}

TEST(Expression, SampleTimesHoldTheNumbersOfTheExpression) {
  const std::vector<std::string> variables = {"x", "t"};
  EXPECT_EQ(sample_times("3*x", variables, 2.0), std::vector<double>{0.0});
  const std::vector<double> times = sample_times("1/(t-0.3)+sqrt(-1.1+x)*5", variables, 2.0);
  EXPECT_EQ(times.size(), 259U) << "257 even ones, 0.3 and 1.1; 5 lies after the end";
  EXPECT_TRUE(std::ranges::is_sorted(times));
  EXPECT_EQ(times.back(), 2.0);
  for (const double number : {0.3, 1.1}) EXPECT_EQ(std::ranges::count(times, number), 1) << number;
}

}  // namespace
}  // namespace drogue::expression
