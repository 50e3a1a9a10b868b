#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/reference/gas/exact_riemann.hpp"

namespace drogue::reference {
namespace {

struct StarCase {
  std::string name;
  Primitive left;
  Primitive right;
  double gamma;
  std::vector<std::string> star;  ///< p, u, rho left and right of the contact as published, all digits
};

std::vector<StarCase> star_cases() {
  const double g = 1.4;
  return {
      {"sod", {1, 0, 1}, {.125, 0, .1}, g, {".3031302", ".9274526", ".4263194", ".2655737"}},
      {"lax", {.445, .698, 3.528}, {.5, 0, .571}, g, {"2.466098", "1.528723", ".3445685", "1.304085"}},
      {"toro-1", {1, .75, 1}, {.125, 0, .1}, g, {".4662936", "1.360906", ".5798667", ".3397002"}},
      {"toro-2", {1, -2, .4}, {1, 2, .4}, g, {".001893873", "0.000000000", ".02185212", ".02185212"}},
      {"toro-3", {1, 0, 1000}, {1, 0, .01}, g, {"460.8938", "19.59745", ".5750623", "5.999241"}},
      {"toro-4",
       {5.99924, 19.5975, 460.894},
       {5.99242, -6.19633, 46.0950},
       g,
       {"1691.647", "8.689774", "14.28235", "31.0426"}},
      {"toro-5",
       {1, -19.59745, 1000},
       {1, -19.59745, .01},
       g,
       {"460.8938", "0.00000", ".5750623", "5.999241"}},
      {"leblanc",
       {1, 0, 2.0 / 3.0 * 1e-1},
       {1e-3, 0, 2.0 / 3.0 * 1e-10},
       5.0 / 3.0,
       {".0005155779", ".6218387", ".05407934", ".003999998"}},
      {"mach-2000",
       {5, 800, .4127},
       {.5, 0, .4127},
       5.0 / 3.0,
       {"246279.5", "607.7975", "19.99987", "1.999987"}},
  };
}

/// Half a unit of the last digit of a decimal number, plus a margin for its rounding to double.
double half_unit(const std::string& digits) {
  const std::size_t decimals = digits.size() - digits.find('.') - 1;
  return 0.501 * std::pow(10.0, -static_cast<double>(decimals));
}

TEST(ExactRiemann, MatchesTheTabulatedStarStates) {
  for (const StarCase& c : star_cases()) {
    const ExactRiemann solution(c.left, c.right, c.gamma);
    const std::vector<double> star = {solution.star_pressure(), solution.star_velocity(),
                                      solution.star_density_left(), solution.star_density_right()};
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(star[k], std::stod(c.star[k]), half_unit(c.star[k])) << c.name << " value " << k;
  }
}

TEST(ExactRiemann, SampledSolutionSatisfiesTheIntegralConservationLaws) {
  // Over [-1, 1] and unit time the mean state differs from the initial one by the difference of the end
  // fluxes.
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-1.0, 1.0);
  std::uniform_real_distribution<double> velocity(-0.5, 0.5);
  for (int trial = 0; trial < 50; ++trial) {
    const double gamma = trial % 2 == 0 ? 1.4 : 5.0 / 3.0;
    const Primitive left = {std::pow(10.0, exponent(random)), velocity(random),
                            std::pow(10.0, exponent(random))};
    const Primitive right = {std::pow(10.0, exponent(random)), velocity(random),
                             std::pow(10.0, exponent(random))};
    const ExactRiemann solution(left, right, gamma);
    const double half_width = 20.0;
    const int cells = 40000;
    Conserved sum{};
    for (int i = 0; i < cells; ++i) {
      const double speed = -half_width + 2.0 * half_width * (i + 0.5) / cells;
      const Conserved U = to_conserved(solution.sample(speed), gamma);
      for (std::size_t s = 0; s < 3; ++s) sum[s] += U[s] * 2.0 * half_width / cells;
    }
    const Conserved UL = to_conserved(left, gamma);
    const Conserved UR = to_conserved(right, gamma);
    const Conserved FL = physical_flux(UL, gamma);
    const Conserved FR = physical_flux(UR, gamma);
    for (std::size_t s = 0; s < 3; ++s) {
      const double expected = half_width * (UL[s] + UR[s]) - (FR[s] - FL[s]);
      EXPECT_NEAR(sum[s], expected, 4e-3 * (UL[2] + UR[2] + UL[0] + UR[0]))
          << "trial " << trial << " of " << s;
    }
  }
}

TEST(ExactRiemann, IsSymmetricUnderReflection) {
  for (const StarCase& c : star_cases()) {
    const ExactRiemann solution(c.left, c.right, c.gamma);
    const ExactRiemann image({c.right.rho, -c.right.u, c.right.p}, {c.left.rho, -c.left.u, c.left.p},
                             c.gamma);
    for (double speed = -30.3; speed < 30.0; speed += 0.7) {
      const Primitive a = solution.sample(speed);
      const Primitive b = image.sample(-speed);
      EXPECT_NEAR(a.rho, b.rho, 1e-12 * a.rho) << c.name << " at " << speed;
      EXPECT_NEAR(a.p, b.p, 1e-11 * a.p) << c.name << " at " << speed;
    }
  }
}

/// The solution is the initial state just outside of its outermost waves, and another state just inside.
TEST(ExactRiemann, OutermostWavesBoundTheInitialStates) {
  for (const StarCase& c : star_cases()) {
    const ExactRiemann solution(c.left, c.right, c.gamma);
    const double left = solution.left_wave().value(), right = solution.right_wave().value();
    const double step = 1e-6 * (right - left);
    EXPECT_EQ(solution.sample(left - step).p, c.left.p) << c.name;
    EXPECT_EQ(solution.sample(right + step).p, c.right.p) << c.name;
    EXPECT_NE(solution.sample(left + step).p, c.left.p) << c.name;
    EXPECT_NE(solution.sample(right - step).p, c.right.p) << c.name;
  }
  const ExactRiemann contact({1, 0.5, 1}, {0.2, 0.5, 1}, 1.4), vacuum({1, 0, 1}, {0, 0, 0}, 1.4);
  EXPECT_FALSE(contact.left_wave() || contact.right_wave() || vacuum.right_wave());
  EXPECT_DOUBLE_EQ(vacuum.left_wave().value(), -std::sqrt(1.4));
}

TEST(ExactRiemann, FormsAVacuumBetweenRapidlySeparatingStates) {
  const ExactRiemann limit({7, -1, .2}, {7, 1, .2}, 1.4);
  EXPECT_NEAR(limit.star_pressure(), 0.0, 1e-30);
  const ExactRiemann solution({1, -10, .4}, {1, 10, .4}, 1.4);
  EXPECT_TRUE(solution.has_vacuum());
  EXPECT_EQ(solution.sample(0.3).rho, 0.0);
  EXPECT_EQ(solution.sample(0.3).p, 0.0);
  EXPECT_EQ(solution.sample(-12.0).rho, 1.0);
  EXPECT_EQ(solution.sample(12.0).u, 10.0);
  const double front = -10.0 + 5.0 * std::sqrt(1.4 * .4);
  EXPECT_GT(solution.sample(front - 1e-3).rho, 0.0);
  EXPECT_LT(solution.sample(front - 1e-3).rho, 1e-9);
}

TEST(ExactRiemann, ExpandsIntoAnInitialVacuum) {
  const Primitive gas = {1, 0, 1};
  const Primitive vacuum = {0, 0, 0};
  const double c = std::sqrt(1.4);
  const ExactRiemann to_right(gas, vacuum, 1.4);
  const ExactRiemann to_left(vacuum, gas, 1.4);
  // On x/t = 0 the fan is sonic: u = c there, and c = 2/(gamma+1) of the speed of sound at rest.
  EXPECT_NEAR(to_right.sample(0.0).u, 2.0 / 2.4 * c, 1e-14);
  EXPECT_NEAR(to_left.sample(0.0).u, -2.0 / 2.4 * c, 1e-14);
  EXPECT_EQ(to_right.sample(5.01 * c).rho, 0.0);
  EXPECT_GT(to_right.sample(4.9 * c).rho, 0.0);
  EXPECT_EQ(to_left.sample(-5.01 * c).rho, 0.0);
  EXPECT_EQ(to_left.sample(1.01 * c).rho, 1.0);
}

TEST(ExactRiemann, SolvesForPressuresOverSixteenDecades) {
  for (const double ratio : {1e-16, 1e-8, 1e-2, 1e2, 1e8, 1e16}) {
    for (const double gamma : {1.05, 1.4, 5.0 / 3.0, 3.0}) {
      const ExactRiemann solution({1, 0, ratio}, {1, 0, 1}, gamma);
      const double p = solution.star_pressure();
      EXPECT_GE(p, std::min(1.0, ratio)) << ratio << " " << gamma;
      EXPECT_LE(p, std::max(1.0, ratio)) << ratio << " " << gamma;
      // The velocity on both sides of the contact is the same.
      const double below = solution.sample(solution.star_velocity() * (1.0 - 1e-9)).u;
      const double above = solution.sample(solution.star_velocity() * (1.0 + 1e-9)).u;
      EXPECT_NEAR(below, above, 1e-11 * std::abs(above)) << ratio << " " << gamma;
    }
  }
}

TEST(ExactRiemann, EndsForPressureRatiosBeyondTheRangeOfNumbers) {
  EXPECT_GT(ExactRiemann({1, 0, 1e200}, {1, 0, 1e-200}, 1.4).star_pressure(), 0.0);
}

TEST(ExactRiemann, RejectsUnphysicalStates) {
  EXPECT_THROW(ExactRiemann({1, 0, -1}, {1, 0, 1}, 1.4), std::invalid_argument);
  EXPECT_THROW(ExactRiemann({1, 0, 1}, {0, 0, 1}, 1.4), std::invalid_argument);
  EXPECT_THROW(ExactRiemann({1, std::nan(""), 1}, {1, 0, 1}, 1.4), std::invalid_argument);
  EXPECT_THROW(ExactRiemann({1, 0, 1}, {1, 0, 1}, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::reference
