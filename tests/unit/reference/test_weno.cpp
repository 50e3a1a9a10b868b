#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "kernels/reference/gas/weno.hpp"

namespace drogue::reference {
namespace {

struct Scheme {
  gas::Weno weno;
  int power;
  std::string name;
};

class Weno : public ::testing::TestWithParam<Scheme> {};

INSTANTIATE_TEST_SUITE_P(Schemes, Weno,
                         ::testing::Values(Scheme{gas::Weno::js, 1, "js"}, Scheme{gas::Weno::z, 1, "z1"},
                                           Scheme{gas::Weno::z, 2, "z2"}, Scheme{gas::Weno::m, 1, "m"},
                                           Scheme{gas::Weno::teno5, 1, "teno5"}),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(Weno, WeightsSumToOneAndAreNonNegative) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  for (int trial = 0; trial < 2000; ++trial) {
    const double scale = std::pow(10.0, trial % 16 - 8);
    std::array<double, 5> f{};
    for (double& v : f) v = scale * value(random);
    const std::array<double, 3> w = weno_weights(f, GetParam().weno, GetParam().power);
    EXPECT_NEAR(w[0] + w[1] + w[2], 1.0, 1e-14);
    for (const double weight : w) EXPECT_GE(weight, 0.0);
  }
}

TEST_P(Weno, WeightsAreIdealForLinearData) {
  const std::array<double, 3> w =
      weno_weights({1.0, 1.25, 1.5, 1.75, 2.0}, GetParam().weno, GetParam().power);
  EXPECT_NEAR(w[0], 0.1, 1e-14);
  EXPECT_NEAR(w[1], 0.6, 1e-14);
  EXPECT_NEAR(w[2], 0.3, 1e-14);
}

TEST_P(Weno, ReconstructsFromTheSmoothSideOfAJump) {
  // The jump lies between i+1 and i+2: only the first two stencils are smooth.
  const std::array<double, 3> w = weno_weights({1.0, 1.0, 1.0, 1.0, 9.0}, GetParam().weno, GetParam().power);
  EXPECT_LT(w[2], 1e-5);
  const double value = weno_face_value({1.0, 1.0, 1.0, 1.0, 9.0}, GetParam().weno, GetParam().power);
  EXPECT_NEAR(value, 1.0, 1e-4);
}

TEST_P(Weno, PreservesConstantData) {
  for (const double value : {0.0, 1.0, -3.0, 1e-30, 1e12}) {
    const double face =
        weno_face_value({value, value, value, value, value}, GetParam().weno, GetParam().power);
    EXPECT_NEAR(face, value, 1e-15 * std::abs(value));
  }
}

TEST_P(Weno, IsFiniteWhereOneIndicatorVanishes) {
  // tau/(beta + 1e-40) is 1e40 and more; its sixth power is beyond the range of double.
  for (const double jump : {1e-6, 1.0, 1e10}) {
    const double face = weno_face_value({0.0, 0.0, 0.0, 0.0, jump}, GetParam().weno, GetParam().power);
    EXPECT_TRUE(std::isfinite(face)) << jump;
    EXPECT_LT(std::abs(face), 1e-4 * jump + 1e-5) << jump;
  }
}

TEST(WenoReconstruction, IdealWeightsReproduceQuarticsFromCellMeans) {
  // Cell means of x^4 over unit cells centred on -2 .. 2; the face is at 1/2.
  std::array<double, 5> means{};
  for (std::size_t k = 0; k < 5; ++k) {
    const double right = static_cast<double>(k) - 1.5;
    means[k] = (std::pow(right, 5) - std::pow(right - 1.0, 5)) / 5.0;
  }
  const std::array<double, 3> candidates = {(2.0 * means[0] - 7.0 * means[1] + 11.0 * means[2]) / 6.0,
                                            (-means[1] + 5.0 * means[2] + 2.0 * means[3]) / 6.0,
                                            (2.0 * means[2] + 5.0 * means[3] - means[4]) / 6.0};
  EXPECT_NEAR(0.1 * candidates[0] + 0.6 * candidates[1] + 0.3 * candidates[2], std::pow(0.5, 4), 1e-13);
  // Scaled until eps dominates the indicators, JS must give the same value.
  std::array<double, 5> small{};
  for (std::size_t k = 0; k < 5; ++k) small[k] = 1e-9 * means[k];
  EXPECT_NEAR(weno_face_value(small, gas::Weno::js, 1), 1e-9 * std::pow(0.5, 4), 1e-18);
}

TEST(WenoReconstruction, SmoothnessIsTheScaledSumOfSquaredDerivatives) {
  // For f = x every indicator is f'^2 = 1, for f = x^2 they are f'^2 + 13/12 f''^2 at the centre: 13/3.
  for (const double beta : smoothness({-2.0, -1.0, 0.0, 1.0, 2.0})) EXPECT_NEAR(beta, 1.0, 1e-15);
  for (const double beta : smoothness({4.0, 1.0, 0.0, 1.0, 4.0})) EXPECT_NEAR(beta, 13.0 / 3.0, 1e-14);
}

}  // namespace
}  // namespace drogue::reference
