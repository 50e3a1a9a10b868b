#pragma once

#include <Kokkos_BitManipulation.hpp>
#include <Kokkos_Core.hpp>
#include <cstdint>

#include "kernels/device/pack.hpp"

namespace drogue::coupling {

// Sums of doubles as 64-bit integers, whose additions commute and associate: any order of atomic additions
// gives the same bits.

/// Unsigned, because CUDA has no signed 64-bit atomic addition; read as two's complement. Kokkos adds this
/// type by one instruction on CUDA, but `unsigned long long` by compare and exchange.
using FixedPoint = std::uint64_t;

/// Powers of two between doubles and their fixed-point form.
struct FixedPointScale {
  double factor;   ///< units per number
  double inverse;  ///< numbers per unit
};

/// Least power of two that is at least `count`, the number of summands. Dimensionless. Does not throw.
[[nodiscard]] inline double summand_bound(int count) {
  double bound = 1.0;
  while (bound < count) bound *= 2.0;
  return bound;
}

/// Scale for sums of at most `summands` numbers (a power of two) of magnitude at most `largest`, in any unit.
/// No sum exceeds 2^62 units, so none overflows; a unit is at most largest * summands / 2^61. Outside 1e-270
/// to 1e270, `largest` counts as the nearer bound.
KOKKOS_INLINE_FUNCTION FixedPointScale fixed_point_scale(double largest, double summands) {
  const double limited = largest > 1e-270 ? (largest < 1e270 ? largest : 1e270) : 1e-270;
  constexpr double two_61 = 2305843009213693952.0, inverse_two_61 = 1.0 / two_61;
  // All factors are powers of two. The first brings `limited` into [1, 2).
  const double to_one = device::binary_reciprocal(limited), from_one = device::binary_reciprocal(to_one);
  return {to_one * (two_61 * device::binary_reciprocal(summands)), from_one * (inverse_two_61 * summands)};
}

/// Nearest integer to a dimensionless number of magnitude below 2^62. Half-way cases round up.
KOKKOS_INLINE_FUNCTION std::int64_t to_fixed_point(double scaled) {
  return static_cast<std::int64_t>(Kokkos::floor(scaled + 0.5));
}

/// Value in units of a sum.
KOKKOS_INLINE_FUNCTION double from_fixed_point(FixedPoint sum) {
  return static_cast<double>(static_cast<std::int64_t>(sum));
}

}  // namespace drogue::coupling
