#pragma once

#include <vector>

namespace drogue::perf {

/// Largest ratio of the time of a kernel in Kokkos to that of the same algorithm in CUDA that is a goal.
inline constexpr double largest_version_cost = 1.05;

/// Verdict on a ratio of times against a goal.
enum class Goal {
  met,        ///< the whole interval is below it
  missed,     ///< the whole interval is above it
  undecided,  ///< the interval contains it: the samples are too few or too noisy
};

/// Time of one version of a kernel against another.
struct VersionCost {
  double ratio = 1.0;  ///< of the times, from all pairs of samples
  double low = 1.0;    ///< interval that holds the ratio with a probability of at least 95 %
  double high = 1.0;
};

/// Cost of `version` against `other` from samples that took turns, s; both lists are positive and not empty.
/// Does not throw.
VersionCost version_cost(const std::vector<double>& version, const std::vector<double>& other);

/// Verdict on a cost. Does not throw.
Goal goal(const VersionCost& cost, double largest = largest_version_cost);

/// "met", "missed" or "undecided". Does not throw.
const char* name(Goal goal);

}  // namespace drogue::perf
