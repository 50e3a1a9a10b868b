#pragma once

#include <cstdint>

#include <Kokkos_Core.hpp>

namespace drogue::stepping {

inline constexpr std::uint64_t no_failure = ~std::uint64_t{0};

/// Encodes a failure as an integer that is least for the first `order` (step or stage) and, within it, the
/// least index. A minimum of integers is independent of the order of threads. `index` < 2^31, `order` < 2^32.
KOKKOS_INLINE_FUNCTION std::uint64_t encode_failure(std::int64_t order, std::int64_t index) {
  return static_cast<std::uint64_t>(order) << 31U | static_cast<std::uint64_t>(index);
}
/// Step or stage of an encoded failure.
KOKKOS_INLINE_FUNCTION std::int64_t failure_order(std::uint64_t failure) {
  return static_cast<std::int64_t>(failure >> 31U);
}
/// Index of an encoded failure.
KOKKOS_INLINE_FUNCTION std::int64_t failure_index(std::uint64_t failure) {
  return static_cast<std::int64_t>(failure & 0x7fffffffU);
}

}  // namespace drogue::stepping
