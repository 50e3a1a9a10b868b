#include "kernels/device/expression.hpp"

#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/random_expression.hpp"

namespace drogue::device {
namespace {

using Space = DROGUE_TEST_SPACE;
using Memory = Space::memory_space;
using testing::Step;

constexpr int points = 64;
using Points = Kokkos::View<double* [4], Memory>;
using Values = Kokkos::View<double*, Memory>;

ExpressionProgram program_of(const std::vector<Step>& steps) {
  ExpressionBuilder builder;
  for (const Step& step : steps) builder.push(step.name, step.value);
  return builder.program();
}

/// Evaluates the program at every point, in a kernel.
void evaluate_at(const ExpressionProgram& program, const Points& at, const Values& values) {
  Kokkos::parallel_for(
      "expression_test", Kokkos::RangePolicy<Space>(0, points),
      KOKKOS_LAMBDA(const int i) { values(i) = evaluate(program, at(i, 0), at(i, 1), at(i, 2), at(i, 3)); });
}

/// Points (x, y, z, t) in [low, high]^4 and the values of a program there, on the host.
class Sample {
 public:
  Sample(double low, double high, unsigned seed = 1) : _at("at", points), _values("values", points) {
    host = Kokkos::create_mirror_view(_at);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(low, high);
    for (int i = 0; i < points; ++i) {
      for (int k = 0; k < 4; ++k) host(i, k) = uniform(random);
    }
  }

  auto operator()(const std::vector<Step>& steps) {
    Kokkos::deep_copy(_at, host);
    evaluate_at(program_of(steps), _at, _values);
    return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, _values);
  }

  Points::host_mirror_type host;

 private:
  Points _at;
  Values _values;
};

/// Largest error of one function of x over [low, high] against long double, relative to max(1, |value|).
double function_error(const std::string& name, double low, double high) {
  double worst = 0.0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Sample sample(low, high, seed);
    const std::vector<Step> steps = {{"x"}, {name}};
    const auto values = sample(steps);
    for (int i = 0; i < points; ++i) {
      const long double x = sample.host(i, 0);
      const long double exact = testing::reference_value<long double>(steps, x, 0, 0, 0);
      const double error = static_cast<double>(std::abs(values(i) - exact) / std::max(1.0L, std::abs(exact)));
      if (!(error <= worst)) worst = error;
    }
  }
  return worst;
}

TEST(PortableMath, IsAccurateToThirteenDigits) {
  struct Range {
    const char* name;
    double low, high;
  };
  const Range ranges[] = {{"sin", -10, 10},     {"sin", -1e6, 1e6}, {"cos", -10, 10},  {"cos", -1e6, 1e6},
                          {"tan", -1.5, 1.5},   {"asin", -1, 1},    {"acos", -1, 1},   {"atan", -20, 20},
                          {"exp", -5, 5},       {"exp", -740, 700}, {"log", 1e-6, 4},  {"log", 1, 1e300},
                          {"log2", 1e-3, 1e6},  {"log10", 1, 1e6},  {"sinh", -30, 30}, {"sinh", -1, 1},
                          {"cosh", -30, 30},    {"tanh", -3, 3},    {"asinh", -5, 5},  {"acosh", 1, 50},
                          {"atanh", -0.9, 0.9}, {"sqrt", 0, 100},   {"floor", -9, 9},  {"rint", -9, 9}};
  for (const Range& range : ranges) {
    EXPECT_LT(function_error(range.name, range.low, range.high), 1e-13) << range.name << " to " << range.high;
  }
}

/// Value of one function, evaluated in a kernel.
double value_at(const std::string& name, double x) {
  Sample sample(0.0, 1.0);
  sample.host(0, 0) = x;
  return sample({{"x"}, {name}})(0);
}

TEST(PortableMath, ReducesAnglesOfAnySize) {
  for (const std::string name : {"sin", "cos"})
    for (const double high : {1.1e6, 1e7, 1e9, 4e15, 1e22, 1e100, 8e307}) {
      EXPECT_LT(function_error(name, -high, high), 5e-16) << name << " to " << high;
      EXPECT_LT(function_error(name, high, 1.05 * high), 5e-16) << name << " beyond " << high;
    }
  // The double that is closest to a multiple of pi/2, by 4.7e-19, and neighbours of the limit between
  // methods.
  for (const double x : {6381956970095103.0 * 0x1p797, 1e6, std::nextafter(1e6, 2e6)})
    for (const double sign : {-1.0, 1.0}) {
      EXPECT_NEAR(value_at("sin", sign * x), std::sin(sign * x), 5e-16);
      EXPECT_NEAR(value_at("cos", sign * x), std::cos(sign * x), 5e-16);
    }
}

TEST(PortableMath, KeepsRelativeAccuracyOfSmallValues) {
  for (const std::string name : {"sin", "tan", "sinh", "tanh", "asin", "atan"}) {
    Sample sample(1e-12, 1e-3);
    const auto values = sample({{"x"}, {name}});
    for (int i = 0; i < points; ++i) {
      const double x = sample.host(i, 0);
      EXPECT_NEAR(values(i) / testing::reference_value<double>({{"x"}, {name}}, x, 0, 0, 0), 1.0, 1e-14)
          << name;
    }
  }
}

TEST(PortableMath, PowersMatchTheReference) {
  Sample sample(0.01, 8.0);
  const std::vector<Step> free = {{"x"}, {"y"}, {"^"}};
  const auto values = sample(free);
  for (int i = 0; i < points; ++i) {
    const double exact = std::pow(sample.host(i, 0), sample.host(i, 1));
    EXPECT_NEAR(values(i), exact, 1e-13 * std::max(1.0, exact));
  }
  const auto cubes = sample({{"x"}, {"negate"}, {"constant", 3.0}, {"^"}});
  for (int i = 0; i < points; ++i) {
    const double x = sample.host(i, 0);
    EXPECT_NEAR(cubes(i), -x * x * x, 1e-15 * x * x * x);
  }
}

TEST(PortableMath, BesselFunctionsMatchTheReference) {
  for (const double order : {0.0, 1.0, 2.0, 7.0, 40.0}) {
    for (const double high : {1.0, 29.0, 31.0, 60.0, 1000.0}) {
      Sample sample(-high, high);
      const auto values = sample({{"constant", order}, {"x"}, {"besselj"}});
      for (int i = 0; i < points; ++i) {
        const double exact = ::jn(static_cast<int>(order), sample.host(i, 0));
        EXPECT_NEAR(values(i), exact, 1e-13) << "J_" << order << "(" << sample.host(i, 0) << ")";
      }
    }
  }
}

TEST(PortableMath, MatchesCmathAtSpecialValues) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(value_at("exp", 1000.0), inf);
  EXPECT_EQ(value_at("exp", -1000.0), 0.0);
  EXPECT_EQ(value_at("exp", 0.0), 1.0);
  EXPECT_EQ(value_at("log", 0.0), -inf);
  EXPECT_EQ(value_at("log", 1.0), 0.0);
  EXPECT_EQ(value_at("log", inf), inf);
  EXPECT_NEAR(value_at("log", 4.9e-324), std::log(4.9e-324), 1e-12);
  EXPECT_TRUE(std::isnan(value_at("log", -1.0)));
  EXPECT_TRUE(std::isnan(value_at("sqrt", -1.0)));
  EXPECT_TRUE(std::isnan(value_at("sin", inf)));
  EXPECT_TRUE(std::isnan(value_at("cos", -inf)));
  EXPECT_EQ(value_at("sin", 0.0), 0.0);
  EXPECT_EQ(value_at("asin", 1.0), std::asin(1.0));
  EXPECT_EQ(value_at("acos", -1.0), std::acos(-1.0));
}

// ctest-label: smoke
TEST(ExpressionProgram, AgreesWithTheReferenceOnRandomExpressions) {
  Sample sample(-2.0, 3.0);
  int compared = 0;
  for (unsigned seed = 0; seed < 600; ++seed) {
    const testing::RandomExpression random(seed);
    if (random.steps().size() > 60) continue;  // longer than a program may be
    const auto values = sample(random.steps());
    for (int i = 0; i < points; ++i) {
      const double x = sample.host(i, 0), y = sample.host(i, 1), z = sample.host(i, 2), t = sample.host(i, 3);
      if (!testing::well_conditioned(random.steps(), x, y, z, t, 1e-10)) continue;
      const double exact = testing::reference_value<double>(random.steps(), x, y, z, t);
      ASSERT_NEAR(values(i), exact, 1e-9 * std::max(1.0, std::abs(exact)))
          << random.text() << " at " << x << ", " << y << ", " << z << ", " << t;
      ++compared;
    }
  }
  EXPECT_GT(compared, 400 * points);
}

TEST(ExpressionBuilder, RejectsInvalidPrograms) {
  const auto refused = [](const std::vector<Step>& steps) {
    try {
      program_of(steps);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused({{"w"}}).find("\"w\""), std::string::npos);
  EXPECT_NE(refused({{"x"}, {"+"}}).find("operand"), std::string::npos);
  EXPECT_NE(refused({{"x"}, {"y"}}).find("one value"), std::string::npos);
  EXPECT_NE(refused({}).find("one value"), std::string::npos);
  EXPECT_NE(refused(std::vector<Step>(17, {"x"})).find("nested"), std::string::npos);
  std::vector<Step> steps = {{"x"}};
  for (int i = 0; i < 40; ++i) {
    steps.push_back({"constant", 1.0});
    steps.push_back({"+"});
  }
  EXPECT_NE(refused(steps).find("numbers"), std::string::npos);
  steps = {{"x"}};
  steps.insert(steps.end(), 96, {"negate"});
  EXPECT_NE(refused(steps).find("longer"), std::string::npos);
}

}  // namespace
}  // namespace drogue::device
