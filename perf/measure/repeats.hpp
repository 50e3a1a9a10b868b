#pragma once

#include <algorithm>
#include <cmath>

namespace drogue::perf {

/// Shorter works are repeated within a sample, s: a sample that a switch to another process can double is
/// useless.
inline constexpr double shortest_sample = 5e-3;
/// Longest sample of repeated works, s, with what is not timed, such as the copies of the scheme of [Shi].
inline constexpr double longest_repeated_sample = 25e-3;

/// Works of a sample that fill `shortest_sample`, 200 at most, from the timed seconds of one; fewer, but one,
/// if the sample would last longer than `longest_repeated_sample`, from the seconds of one with what is not
/// timed. Does not throw.
[[nodiscard]] inline long repeats_of(double timed, double whole) {
  const double wanted = std::ceil(shortest_sample / std::max(timed, 1e-9));
  const double affordable = std::floor(longest_repeated_sample / std::max(whole, 1e-9));
  return static_cast<long>(std::clamp(std::min(wanted, affordable), 1.0, 200.0));
}

}  // namespace drogue::perf
