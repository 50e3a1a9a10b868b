#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/reference/gas/eigensystem.hpp"
#include "kernels/reference/gas/face_flux.hpp"

namespace drogue::reference {
namespace {

class Eigenvectors : public ::testing::TestWithParam<gas::FaceAverage> {
 protected:
  Primitive random_state() {
    std::uniform_real_distribution<double> exponent(-1.0, 1.0);
    std::uniform_real_distribution<double> velocity(-3.0, 3.0);
    return {std::pow(10.0, exponent(_random)), velocity(_random), std::pow(10.0, exponent(_random))};
  }

  std::mt19937 _random{3};
};

INSTANTIATE_TEST_SUITE_P(Means, Eigenvectors,
                         ::testing::Values(gas::FaceAverage::arithmetic, gas::FaceAverage::conserved,
                                           gas::FaceAverage::roe));

TEST_P(Eigenvectors, LeftTimesRightIsTheIdentity) {
  for (int trial = 0; trial < 200; ++trial) {
    const double gamma = trial % 2 == 0 ? 1.4 : 5.0 / 3.0;
    const Conserved a = to_conserved(random_state(), gamma);
    const Conserved b = to_conserved(random_state(), gamma);
    const Eigensystem e = eigensystem(face_state(a, b, GetParam(), gamma), gamma);
    for (std::size_t column = 0; column < 3; ++column) {
      const std::array<double, 3> r = {e.right[0][column], e.right[1][column], e.right[2][column]};
      const std::array<double, 3> product = multiply(e.left, r);
      for (std::size_t row = 0; row < 3; ++row) EXPECT_NEAR(product[row], row == column ? 1.0 : 0.0, 1e-12);
    }
  }
}

TEST_P(Eigenvectors, DiagonaliseTheJacobianOfAUniformState) {
  const double gamma = 1.4;
  for (int trial = 0; trial < 50; ++trial) {
    const Primitive w = random_state();
    const Conserved U = to_conserved(w, gamma);
    const Eigensystem e = eigensystem(face_state(U, U, GetParam(), gamma), gamma);
    const double c = sound_speed(w, gamma);
    const std::array<double, 3> speeds = {w.u - c, w.u, w.u + c};
    for (std::size_t s = 0; s < 3; ++s) {
      // A central difference of the flux along the eigenvector is the eigenvalue times the vector.
      const double h = 1e-6 * w.rho;
      Conserved ahead = U;
      Conserved behind = U;
      for (std::size_t k = 0; k < 3; ++k) {
        ahead[k] += h * e.right[k][s];
        behind[k] -= h * e.right[k][s];
      }
      const Conserved fa = physical_flux(ahead, gamma);
      const Conserved fb = physical_flux(behind, gamma);
      for (std::size_t k = 0; k < 3; ++k) {
        const double scale = 1.0 + std::abs(U[2]) / w.rho * (1.0 + std::abs(w.u) + c);
        EXPECT_NEAR((fa[k] - fb[k]) / (2.0 * h), speeds[s] * e.right[k][s], 1e-6 * scale);
      }
    }
  }
}

TEST(RoeAverage, LinearisesTheJumpOfTheFlux) {
  const double gamma = 1.4;
  const Conserved a = to_conserved({1.0, 0.3, 2.0}, gamma);
  const Conserved b = to_conserved({0.2, -1.1, 0.7}, gamma);
  const FaceState face = face_state(a, b, gas::FaceAverage::roe, gamma);
  const Eigensystem e = eigensystem(face, gamma);
  const std::array<double, 3> strength = multiply(e.left, {b[0] - a[0], b[1] - a[1], b[2] - a[2]});
  const std::array<double, 3> speeds = {face.u - face.c, face.u, face.u + face.c};
  const Conserved fa = physical_flux(a, gamma);
  const Conserved fb = physical_flux(b, gamma);
  const std::array<double, 3> jump =
      multiply(e.right, {speeds[0] * strength[0], speeds[1] * strength[1], speeds[2] * strength[2]});
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(jump[k], fb[k] - fa[k], 1e-13);
}

TEST(SplittingAlpha, IsTheLargestWaveSpeedOfItsScope) {
  const double gamma = 1.4;
  std::array<Conserved, 6> stencil{};
  for (std::size_t k = 0; k < 6; ++k)
    stencil[k] = to_conserved({1.4, 0.1 * static_cast<double>(k), 1.0}, gamma);
  const SpeedBounds mesh{{7.0, 8.0, 9.0}, 9.0};
  const auto alpha = [&](gas::Splitting s) { return splitting_alpha(s, mesh, stencil, gamma); };
  EXPECT_EQ(alpha(gas::Splitting::lf_single), (std::array<double, 3>{9.0, 9.0, 9.0}));
  EXPECT_EQ(alpha(gas::Splitting::lf_global), (std::array<double, 3>{7.0, 8.0, 9.0}));
  const std::array<double, 3> local = alpha(gas::Splitting::lf_stencil);  // c = 1, u = 0 .. 0.5
  EXPECT_NEAR(local[0], 1.0, 1e-15);
  EXPECT_NEAR(local[1], 0.5, 1e-15);
  EXPECT_NEAR(local[2], 1.5, 1e-15);
}

}  // namespace
}  // namespace drogue::reference
