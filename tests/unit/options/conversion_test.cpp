#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "common/program/failure.hpp"
#include "kernels/reference/options/cos.hpp"
#include "miniapps/options/conversion.hpp"
#include "miniapps/options/input/parameter_families.hpp"

// Laws of converted parameters: the exponent of the reference implementation against those of the sources.

namespace drogue::options_app {
namespace {

using Complex = std::complex<double>;
constexpr Complex i{0.0, 1.0};

const ParameterFamily& family(const std::string& name) {
  for (const ParameterFamily& each : parameter_families())
    if (each.name == name) return each;
  throw std::out_of_range(name);
}

/// Log of the characteristic function after a unit of time, up to a drift.
Complex exponent(const double* jump, double u) {
  return Complex(reference::characteristic_exponent({0.0, 0.0, 0.0, jump[0], jump[1], jump[2], jump[3]}, u));
}

/// Expects equal exponents up to a drift i c u, which a batch takes from rate and dividend.
void expect_same_law(const double* jump, const std::function<Complex(double)>& source) {
  const Complex difference = exponent(jump, 1.0) - source(1.0);
  EXPECT_NEAR(std::real(difference), 0.0, 1e-12);
  for (const double u : {0.3, 2.0, 7.0, 20.0}) {
    const Complex expected = source(u) + i * std::imag(difference) * u;
    EXPECT_NEAR(std::abs(exponent(jump, u) - expected), 0.0, 1e-11 * (1.0 + std::abs(expected))) << u;
  }
}

// Madan, Carr and Chang 1998, equation (7): (1 - i u theta nu + sigma^2 nu u^2/2)^(-t/nu).
TEST(OptionsConversion, VarianceGammaHasItsLaw) {
  for (const double years : {1.0, 252.0, 0.25}) {
    const double p[] = {0.12, 0.17, -0.14};
    double jump[4];
    family("variance-gamma").convert(p, jump);
    ASSERT_TRUE(scale_periods(jump, years));
    EXPECT_EQ(jump[3], 0.0);
    expect_same_law(jump, [&](double u) {
      return -years / p[1] * std::log(1.0 - i * u * p[2] * p[1] + 0.5 * p[0] * p[0] * p[1] * u * u);
    });
    // Cumulants: variance (sigma^2 + theta^2 nu) t, third (2 theta^2 nu^2 + 3 sigma^2 nu) theta t. Of the
    // batch: lambda (2/gamma^2 + 4 beta^2/gamma^4), lambda (12 beta/gamma^4 + 16 beta^3/gamma^6).
    const double g = jump[1] * jump[1] - jump[2] * jump[2], b = jump[2];
    EXPECT_NEAR(jump[0] * (2.0 / g + 4.0 * b * b / (g * g)), (p[0] * p[0] + p[2] * p[2] * p[1]) * years,
                1e-13 * years);
    EXPECT_NEAR(jump[0] * (12.0 * b / (g * g) + 16.0 * b * b * b / (g * g * g)),
                (2.0 * p[2] * p[2] * p[1] * p[1] + 3.0 * p[0] * p[0] * p[1]) * p[2] * years, 1e-13 * years);
  }
}

// Barndorff-Nielsen 1997: delta (gamma - sqrt(alpha^2 - (beta + i u)^2)) + i mu u.
TEST(OptionsConversion, NormalInverseGaussianHasItsLaw) {
  for (const double years : {1.0, 252.0}) {
    const double p[] = {40.0, -8.0, 0.02, 0.001};
    double jump[4];
    family("nig").convert(p, jump);
    ASSERT_TRUE(scale_periods(jump, years));
    expect_same_law(jump, [&](double u) {
      const Complex shifted = p[1] + i * u;
      return years *
             (p[2] * (std::sqrt(p[0] * p[0] - p[1] * p[1]) - std::sqrt(p[0] * p[0] - shifted * shifted)) +
              i * u * p[3]);
    });
  }
}

// The documented density of scipy.stats.genhyperbolic, integrated numerically: with x = (y - loc)/scale it is
// proportional to e^{b x} K_{p-1/2}(a s) s^{p-1/2}, s = sqrt(1 + x^2).
TEST(OptionsConversion, GenhyperbolicHasItsLaw) {
  for (const double order : {-0.5, 0.7, 1.5}) {
    const double p[] = {order, 1.4, -0.3, 0.002, 0.05};
    double jump[4];
    family("genhyperbolic").convert(p, jump);
    const auto transform = [&](double u) {
      Complex sum = 0.0;
      const double h = 1.0 / 256.0;
      for (double x = -60.0; x <= 60.0; x += h) {
        const double s = std::sqrt(1.0 + x * x);
        sum += h * std::exp(p[2] * x + i * u * (p[3] + p[4] * x)) *
               std::cyl_bessel_k(std::abs(order - 0.5), p[1] * s) * std::pow(s, order - 0.5);
      }
      return sum;
    };
    const Complex total = transform(0.0);
    const auto source = [&](double u) { return std::log(transform(u) / total); };
    const Complex difference = exponent(jump, 1.0) - source(1.0);
    EXPECT_NEAR(std::real(difference), 0.0, 1e-9);
    for (const double u : {5.0, 20.0})
      EXPECT_NEAR(std::abs(exponent(jump, u) - source(u) - i * std::imag(difference) * u), 0.0, 1e-7)
          << order;
    EXPECT_EQ(scale_periods(jump, 252.0), order == -0.5);
  }
}

ConversionCommand command_of(const std::string& family, const std::string& parameters = "") {
  ConversionCommand command;
  command.family = family;
  command.parameters = parameters;
  return command;
}

class Conversion : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(_folder); }
  void TearDown() override { std::filesystem::remove_all(_folder); }

  /// Text that `command` writes, or the code and message of its failure.
  std::string converted(ConversionCommand command, const std::string& content = "") {
    if (!content.empty()) {
      command.input = (_folder / "p.csv").string();
      std::ofstream(command.input) << content;
    }
    command.out = _folder / "out.csv";
    try {
      (void)convert_parameters(command);
    } catch (const Failure& failure) {
      EXPECT_FALSE(std::filesystem::exists(command.out));
      const std::string message = failure.what();
      return std::to_string(static_cast<int>(failure.code())) + '/' + message.substr(message.rfind('/') + 1);
    }
    std::stringstream text;
    text << std::ifstream(command.out).rdbuf();
    std::filesystem::remove(command.out);
    return text.str();
  }

  std::filesystem::path _folder =
      std::filesystem::temp_directory_path() / ("drogue_conversion_" + std::to_string(::getpid()));
};

TEST_F(Conversion, WritesColumnsOfABatch) {
  EXPECT_EQ(converted(command_of("nig", "alpha=40, beta=-8, delta=0.02")),
            "lambda,alpha,beta,delta,variance\n-0.5,40,-8,0.02,0\n");
  EXPECT_EQ(converted(command_of("nig"), "delta,strike,alpha,id,beta,rate\n0.02,95,40,x,-8,0.05\n"),
            "id,strike,rate,lambda,alpha,beta,delta,variance\nx,95,0.05,-0.5,40,-8,0.02,0\n");
}

TEST_F(Conversion, CountsTimeInYearsOrInPeriods) {
  ConversionCommand command = command_of("genhyperbolic");
  command.periods = 250.0;
  const std::string fit = "p,a,b,loc,scale,rate,dividend,maturity\n1,1.5,-0.5,0,0.01,0.05,,0.5\n";
  EXPECT_TRUE(
      converted(command, fit).starts_with("3/p.csv:2: sums of such returns are not generalized hyperbolic"));
  command.unit_is_period = true;
  EXPECT_EQ(converted(command, fit),
            "rate,dividend,maturity,lambda,alpha,beta,delta,variance\n2e-04,,125,1,150,-50,0.01,0\n");
  command = command_of("variance-gamma", "sigma=0.01,nu=0.8,theta=0");
  command.periods = 252.0;
  EXPECT_EQ(
      converted(command),
      "2/--parameters: lambda must lie between -128 and 128; --time-unit period gives rows that count time "
      "in periods");
  command.unit_is_period = true;
  EXPECT_TRUE(converted(command).starts_with("lambda,alpha,beta,delta,variance\n1.25,"));
  command.parameters = "sigma=0.01,nu=0.001,theta=0";
  for (const bool unit_is_period : {true, false}) {
    command.unit_is_period = unit_is_period;
    EXPECT_EQ(converted(command), "2/--parameters: lambda must lie between -128 and 128");
  }
  command = command_of("nig");
  command.periods = 250.0;
  EXPECT_EQ(converted(command, "alpha,beta,delta,rate\n40,-8,0.02,0.05\n"),
            "rate,lambda,alpha,beta,delta,variance\n0.05,-0.5,40,-8,5,0\n");
}

TEST_F(Conversion, TakesTheDefaultScale) {
  EXPECT_EQ(converted(command_of("genhyperbolic", "p=1,a=1.5,b=-0.4")),
            "lambda,alpha,beta,delta,variance\n1,1.5,-0.4,1,0\n");
  EXPECT_EQ(converted(command_of("genhyperbolic"), "p,a,b,scale\n1,1.5,-0.4,\n1,1.5,-0.4,0.5\n"),
            "lambda,alpha,beta,delta,variance\n1,1.5,-0.4,1,0\n1,3,-0.8,0.5,0\n");
  EXPECT_EQ(converted(command_of("genhyperbolic", "p=1,a=1.5,b=-0.4,scale=0")),
            "2/--parameters: scale must be > 0");
}

TEST_F(Conversion, RejectsLinesThatCannotBeRead) {
  EXPECT_EQ(converted(command_of("nig"), "alpha,beta,delta\n40,-8,0.02" + std::string(70000, ' ') + "\n"),
            "3/p.csv:2: the line is longer than 65536 bytes");
  EXPECT_EQ(converted(command_of("nig"), "alpha,beta,delta\n40,-8,0.02,\"junk\n").substr(0, 10),
            "3/p.csv:2:");
  EXPECT_EQ(converted(command_of("nig", "alpha=40,beta=-8,delta=1,\"junk")).substr(0, 15), "2/--parameters:");
}

TEST_F(Conversion, RejectsWhatCannotBeConverted) {
  EXPECT_EQ(converted(command_of("variance-gamma"), "sigma,nu\n0.1,1\n"),
            "3/p.csv:1: the column theta is missing");
  EXPECT_EQ(converted(command_of("variance-gamma"), "sigma,nu,theta\n0.1,0,0\n"),
            "3/p.csv:2: nu must be > 0");
  EXPECT_EQ(converted(command_of("variance-gamma"), "sigma,nu,theta\n0.1,x,0\n"),
            "3/p.csv:2: nu = \"x\" is not a finite number");
  EXPECT_EQ(converted(command_of("nig"), "alpha,beta,delta\n1,0.5,1\n"),
            "3/p.csv:2: |beta+1| < alpha must hold, else the asset has no mean");
  EXPECT_EQ(converted(command_of("nig"), "alpha,beta,delta\n1,2\n"),
            "3/p.csv:2: the row has 2 fields where the header has 3");
  EXPECT_EQ(converted(command_of("nig"), "alpha,betta,delta\n1,2,3\n").substr(0, 34),
            "3/p.csv:1: unknown column \"betta\";");
  EXPECT_EQ(converted(command_of("nig", "alpha=40,beta=-8")), "2/--parameters: delta is missing");
  EXPECT_EQ(converted(command_of("nig", "alpha=40,alpha=3")), "2/--parameters: alpha is given twice");
  EXPECT_EQ(converted(command_of("nig", "alpha=40,beta=-8,delta=")),
            "2/--parameters: delta = \"\" is not a finite number");
}

}  // namespace
}  // namespace drogue::options_app
