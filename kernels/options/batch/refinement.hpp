#pragma once

#include <optional>
#include <vector>

#include "kernels/options/pricer.hpp"

/// How prices get to finer grids until their stated errors are small enough.
namespace drogue::options {

/// What a launch spends on each price.
struct Resolution {
  int mesh = 0, steps = 0;

  friend bool operator==(const Resolution& a, const Resolution& b) {
    return a.mesh == b.mesh && a.steps == b.steps;
  }
  friend bool operator<(const Resolution& a, const Resolution& b) {
    return a.mesh != b.mesh ? a.mesh < b.mesh : a.steps < b.steps;
  }
};

/// How far a price has come whose tolerance decides.
struct Refinement {
  Resolution next;     ///< no mesh: it is there
  int often = 1;       ///< steps, of a fourth of the mesh
  double error = 0.0;  ///< stated last
};

/// Steps on a mesh: those that are given, or `often` for each four intervals.
[[nodiscard]] inline int steps_of(const Settings& settings, int mesh, int often) {
  return settings.steps != 0 ? settings.steps : mesh / 4 * often;
}

/// The next effort, the least of those that are missing; none if all prices are there.
[[nodiscard]] inline std::optional<Resolution> least_effort(const std::vector<Refinement>& rows) {
  std::optional<Resolution> least;
  for (const Refinement& row : rows)
    if (row.next.mesh != 0 && (!least || row.next < *least)) least = row.next;
  return least;
}

/// Goes on from a price. The error falls by at least 4 where mesh and steps double. Where it does not fall,
/// more steps are tried first, and still more where the values grew: jumps of long maturities are stiff. It
/// does where it falls as of an order of a half, as at a kink that hardly spreads. Where that does not help
/// on a fine mesh either, nothing will. `tolerance`: money.
inline void refine(Refinement& row, const Price& price, double tolerance, const Settings& settings) {
  constexpr int last_mesh = 2048, hopeless_mesh = 512;
  const int mesh = row.next.mesh;
  row.next = {};
  if (price.status == PriceStatus::ok) return;
  const bool grew = price.failure == FailureReason::unstable || price.failure == FailureReason::stiff;
  if (price.failure != FailureReason::none && !grew) return;
  const int most_often = grew ? 16 : 4;
  const bool stuck =
      price.status == PriceStatus::failed || (row.error > 0.0 && price.error > 0.7 * row.error);
  row.error = price.error;
  int next = mesh;
  if (stuck && row.often < most_often && settings.steps == 0) {
    row.often *= 4;
  } else if (stuck && mesh >= hopeless_mesh && price.status == PriceStatus::coarse) {
    return;
  } else {
    next *= 2;
    if (price.status == PriceStatus::coarse)
      for (double error = price.error / 16.0; error > tolerance && next < last_mesh; error /= 4.0) next *= 2;
  }
  if (next <= last_mesh) row.next = {next, steps_of(settings, next, row.often)};
}

}  // namespace drogue::options
