#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "kernels/flow/make_grid.hpp"
#include "kernels/flow/step_constants.hpp"

// Amplification of waves by the time schemes at the admissible dt: von Neumann's analysis of advection and
// diffusion with constant coefficients, on a grid with two spacings.

namespace drogue::flow {
namespace {

using Complex = std::complex<double>;

/// Symbol of h times the derivative in a wave of the phase `angle` per cell.
using Derivative = Complex (*)(double angle);

Complex central(double angle) { return {0.0, std::sin(angle)}; }

/// Difference of the face values (2, -13, 47, 27, -3) / 60.
Complex upwind(double angle) {
  const auto wave = [angle](double cell) { return std::polar(1.0, cell * angle); };
  const Complex high =
      (2.0 * wave(-2.0) - 13.0 * wave(-1.0) + 47.0 * wave(0.0) + 27.0 * wave(1.0) - 3.0 * wave(2.0)) / 60.0;
  return high - high * wave(-1.0);
}

double runge_kutta(Complex z) { return std::abs(1.0 + z + z * z / 2.0 + z * z * z / 6.0); }

/// Larger root of g^2 - (1 + 3/2 z) g + z/2.
double adams_bashforth(Complex z) {
  const Complex half = 0.5 + 0.75 * z, root = std::sqrt(half * half - 0.5 * z);
  return std::max(std::abs(half + root), std::abs(half - root));
}

/// Uniform flow at a speed whose share of 1/dt is `advective`, with viscosity for the rest.
struct Flow {
  Flow(TimeScheme time, double advective) : velocity{1.0, 0.6} {
    parameters.cells = {16, 20, 1};
    parameters.high = {1.0, 2.0, 1.0};
    parameters.time_scheme = time;
    grid = make_grid(parameters);
    // The shares of a viscosity of 1 m^2/s and of this velocity, at the standard CFL number.
    parameters.viscosity = 1.0;
    const StepConstants unit = step_constants(parameters, grid);
    const double unit_rate = rate() / unit.cfl, unit_diffusion = 1.0 / (0.9 * unit.diffusive_dt);
    parameters.viscosity = (1.0 - advective) * unit_rate / unit_diffusion;
    for (double& u : velocity) u *= advective;
    constants = step_constants(parameters, grid);
    progress.rate_bits = Kokkos::bit_cast<std::uint64_t>(rate());
  }

  /// Sum of speeds over spacings, 1/s.
  [[nodiscard]] double rate() const {
    return velocity[0] * grid.inverse_h[0] + velocity[1] * grid.inverse_h[1];
  }

  /// Largest amplification by a step of dt (s) over all waves.
  [[nodiscard]] double amplification(double dt, Derivative derivative) const {
    constexpr int angles = 90;
    double most = 0.0;
    for (int i = 0; i <= angles; ++i)
      for (int j = -angles; j <= angles; ++j) {
        const double angle[] = {i * std::numbers::pi / angles, j * std::numbers::pi / angles};
        Complex z = 0.0;
        for (std::size_t axis = 0; axis < 2; ++axis) {
          const double h = grid.h[axis], sine = std::sin(0.5 * angle[axis]);
          z -= dt * velocity[axis] / h * derivative(angle[axis]);
          z -= dt * parameters.viscosity * 4.0 * sine * sine / (h * h);
        }
        most =
            std::max(most, parameters.time_scheme == TimeScheme::rk3 ? runge_kutta(z) : adams_bashforth(z));
      }
    return most;
  }

  double velocity[2];  ///< m/s
  Parameters parameters;
  MacGrid grid{};
  StepConstants constants{};
  Progress progress;
};

constexpr double round_off = 1e-12;

TEST(FlowStability, RungeKuttaAmplifiesNoWaveAtTheAdmissibleStepNorAtTheStableOne) {
  for (const double advective : {1.0, 0.99, 0.95, 0.9, 0.8, 0.6, 0.4, 0.2, 0.1, 0.05, 0.0})
    for (const Derivative derivative : {upwind, central}) {
      const Flow flow(TimeScheme::rk3, advective);
      const double dt = admissible_dt(flow.progress, flow.constants);
      EXPECT_LE(flow.amplification(dt, derivative), 1.0 + round_off) << advective;
      const double largest = stable_dt(flow.progress, flow.constants);
      EXPECT_GT(largest, 1.1 * dt);
      EXPECT_LE(flow.amplification(largest, derivative), 1.0 + round_off) << advective;
    }
}

TEST(FlowStability, RungeKuttaAmplifiesWavesAtTenPercentMoreThanTheStableStep) {
  for (const double advective : {1.0, 0.0}) {
    const Flow flow(TimeScheme::rk3, advective);
    EXPECT_GT(flow.amplification(1.1 * stable_dt(flow.progress, flow.constants), upwind), 1.05) << advective;
  }
}

TEST(FlowStability, AdamsBashforthAmplifiesNoWaveWhereDiffusionIsATenthOfTheLimit) {
  for (const double advective : {0.9, 0.8, 0.6, 0.4, 0.2, 0.1, 0.05, 0.0})
    for (const Derivative derivative : {upwind, central}) {
      const Flow flow(TimeScheme::ab2, advective);
      const double dt = admissible_dt(flow.progress, flow.constants);
      EXPECT_LE(flow.amplification(dt, derivative), 1.0 + round_off) << advective;
      EXPECT_GT(stable_dt(flow.progress, flow.constants), 1.1 * dt);
    }
}

TEST(FlowStability, AdamsBashforthIsWeaklyUnstableWithoutViscosity) {
  const Flow flow(TimeScheme::ab2, 1.0);
  const double dt = admissible_dt(flow.progress, flow.constants);
  EXPECT_NEAR(flow.amplification(dt, central), 1.027, 1e-3);
  EXPECT_NEAR(flow.amplification(dt, upwind), 1.095, 1e-3);
  EXPECT_GT(flow.amplification(stable_dt(flow.progress, flow.constants), central), 1.14);
}

TEST(FlowStepSize, CountsTheAccelerationsOfAllComponentsOfSides) {
  Control control{};
  control.next_rate_bits = Kokkos::bit_cast<std::uint64_t>(2.0);
  for (std::size_t c = 0; c < 3; ++c)
    control.side_acceleration[c] = Kokkos::bit_cast<std::uint64_t>(3.0 + static_cast<double>(c));
  StepConstants constants{};
  constants.cfl = 0.5;
  const double dt = constants.cfl / Kokkos::bit_cast<double>(limiting_rate_bits(control, constants));
  EXPECT_NEAR(dt * (2.0 + 12.0 * dt), constants.cfl, round_off);
}

}  // namespace
}  // namespace drogue::flow
