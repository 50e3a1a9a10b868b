#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "kernels/options/pide/scheme.hpp"

// Growth of single modes in the time march, from the roots of the characteristic polynomial of IMEX-BDF2.

namespace drogue::options {
namespace {

/// A stiff set of symbols, per year: those of jumps without Brownian part, whose symbol grows like the wave
/// number.
struct StiffModes {
  static constexpr double dt = 1.0, rate = 0.05;
  double symbol[symbol_count];

  explicit StiffModes(double shortest) {
    for (int k = 0; k < symbol_count; ++k) symbol[k] = shortest * std::sqrt(0.25 * form(k));
  }
  static double form(int k) { return 2.0 - 2.0 * AngleCosines::of[k]; }

  [[nodiscard]] Jumps<double> jumps() {
    Jumps<double> jumps{};
    jumps.symbol = symbol;
    return jumps;
  }

  /// Largest modulus of the roots over all angles, with the given amount of added diffusion.
  [[nodiscard]] double growth(double added) const {
    double largest = 0.0;
    for (int k = 0; k < symbol_count; ++k) {
      const double implicit = added * form(k), explicit_part = symbol[k] + rate - added * form(k);
      // (3/2 z^2 - 2 z + 1/2)/dt + I z^2 + E (2 z - 1) = 0
      const double a = 1.5 / dt + implicit, b = -2.0 / dt + 2.0 * explicit_part, c = 0.5 / dt - explicit_part;
      const std::complex<double> root = std::sqrt(std::complex<double>(b * b - 4.0 * a * c));
      largest = std::max({largest, std::abs(-b + root) / (2.0 * a), std::abs(-b - root) / (2.0 * a)});
    }
    return largest;
  }

  /// Smallest diffusion with 3 E <= limit/dt + I at all angles.
  [[nodiscard]] double smallest_diffusion(double limit) const {
    double added = 0.0;
    for (int k = 0; k < symbol_count; ++k)
      added = std::max(added, (3.0 * (symbol[k] + rate) - limit / dt) / (4.0 * form(k)));
    return added;
  }
};

// 4/dt is the limit of stability, at which the mode of the highest need alternates without decay. The margin
// of the scheme damps it.
TEST(OptionsStability, AddedDiffusionDampsWhatAlternatesAtTheLimit) {
  for (const double shortest : {3.0, 10.0, 100.0}) {
    StiffModes modes(shortest);
    PutPack<double> put{};
    put.rate = StiffModes::rate;
    const double added = added_diffusion(put, modes.jumps(), 0.0, StiffModes::dt);
    EXPECT_NEAR(modes.growth(modes.smallest_diffusion(4.0)), 1.0, 1e-12) << shortest;
    EXPECT_GT(modes.growth(modes.smallest_diffusion(4.2)), 1.0 + 1e-4) << shortest;
    EXPECT_LT(modes.growth(added), 1.0 - 1e-3) << shortest;
    // More diffusion than the margin needs would cost accuracy.
    EXPECT_LT(added, 1.15 * modes.smallest_diffusion(4.0) + 0.1 / StiffModes::dt) << shortest;
  }
}

}  // namespace
}  // namespace drogue::options
