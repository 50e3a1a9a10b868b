#pragma once

#include <cstdint>

namespace drogue::perf {

/// Number of FP64 operations. Constants, common subexpressions, unused results and sign changes are not
/// counted.
struct Arithmetic {
  std::int64_t additions = 0, multiplications = 0;
  /// a square root with its reciprocal counts as one root and one division
  std::int64_t divisions = 0, roots = 0;
  std::int64_t comparisons = 0;  ///< including maxima, minima and selections

  /// Floating-point operations by the convention of peak rates: a fused multiply-add is two, a comparison
  /// none. Does not throw.
  [[nodiscard]] constexpr std::int64_t flops() const {
    return additions + multiplications + divisions + roots;
  }

  /// Least number of instructions: every multiplication is fused with an addition, and every other operation
  /// takes one. Does not throw.
  [[nodiscard]] constexpr std::int64_t instructions() const {
    return (additions > multiplications ? additions : multiplications) + divisions + roots + comparisons;
  }

  friend constexpr Arithmetic operator+(const Arithmetic& a, const Arithmetic& b) {
    return {.additions = a.additions + b.additions,
            .multiplications = a.multiplications + b.multiplications,
            .divisions = a.divisions + b.divisions,
            .roots = a.roots + b.roots,
            .comparisons = a.comparisons + b.comparisons};
  }
  friend constexpr Arithmetic operator*(std::int64_t times, const Arithmetic& a) {
    return {.additions = times * a.additions,
            .multiplications = times * a.multiplications,
            .divisions = times * a.divisions,
            .roots = times * a.roots,
            .comparisons = times * a.comparisons};
  }
  friend constexpr bool operator==(const Arithmetic&, const Arithmetic&) = default;
};

}  // namespace drogue::perf
