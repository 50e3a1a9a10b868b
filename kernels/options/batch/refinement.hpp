#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "kernels/options/pricer.hpp"

/// Adaptive choice of meshes and steps until the error estimates of prices are within the tolerance.
namespace drogue::options {

/// Intervals in space and steps in time of a launch.
struct Resolution {
  int mesh = 0, steps = 0;

  friend bool operator==(const Resolution& a, const Resolution& b) {
    return a.mesh == b.mesh && a.steps == b.steps;
  }
  friend bool operator<(const Resolution& a, const Resolution& b) {
    return a.mesh != b.mesh ? a.mesh < b.mesh : a.steps < b.steps;
  }
};

/// State of the adaptive choice for one price.
struct Refinement {
  Resolution next;           ///< mesh 0: finished
  int steps_multiplier = 1;  ///< steps per four intervals
  double error = 0.0;        ///< previous estimate, money
};

/// Tolerance, relative to the strike, beyond which a price is `coarse`; infinite on a given mesh.
[[nodiscard]] inline double tolerance_of(const Settings& settings) {
  return settings.mesh != 0 ? std::numeric_limits<double>::infinity() : settings.tolerance;
}

/// Number of steps on a mesh: that of the settings, or `steps_multiplier` for each four intervals.
[[nodiscard]] inline int steps_of(const Settings& settings, int mesh, int steps_multiplier) {
  return settings.steps != 0 ? settings.steps : mesh / 4 * steps_multiplier;
}

/// Smallest resolution of the unfinished prices; none if all are finished.
[[nodiscard]] inline std::optional<Resolution> lowest_resolution(const std::vector<Refinement>& rows) {
  std::optional<Resolution> least;
  for (const Refinement& row : rows)
    if (row.next.mesh != 0 && (!least || row.next < *least)) least = row.next;
  return least;
}

/// Selects the next resolution from a price. The error decreases at least by a factor of 4 if mesh and steps
/// double. If it stagnates, more steps are tried first, and still more if the values grew: jumps of long
/// maturities are stiff. A decrease as for order 1/2 (a kink that hardly spreads) counts as progress. A price
/// that stagnates on a fine mesh with more steps is finished. `tolerance`: money.
inline void refine(Refinement& row, const Price& price, double tolerance, const Settings& settings) {
  constexpr int last_mesh = 2048, stagnation_mesh = 512;
  const int mesh = row.next.mesh;
  row.next = {};
  if (price.status == PriceStatus::ok) return;
  const bool grew = price.failure == PricingFailure::unstable || price.failure == PricingFailure::stiff;
  if (price.failure != PricingFailure::none && !grew) return;
  const int max_multiplier = grew ? 16 : 4;
  const bool stagnates =
      price.status == PriceStatus::failed || (row.error > 0.0 && price.error > 0.7 * row.error);
  row.error = price.error;
  int next = mesh;
  if (stagnates && row.steps_multiplier < max_multiplier && settings.steps == 0) {
    row.steps_multiplier *= 4;
  } else if (stagnates && mesh >= stagnation_mesh && price.status == PriceStatus::coarse) {
    return;
  } else {
    next *= 2;
    if (price.status == PriceStatus::coarse)
      for (double error = price.error / 16.0; error > tolerance && next < last_mesh; error /= 4.0) next *= 2;
  }
  if (next <= last_mesh) row.next = {next, steps_of(settings, next, row.steps_multiplier)};
}

}  // namespace drogue::options
