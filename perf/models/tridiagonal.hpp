#pragma once

#include <cstdint>

#include "perf/models/arithmetic.hpp"

/// Work per system of the tridiagonal solvers of `perf/tridiagonal/`. Bytes count each array of a system once
/// for reading and once for writing. No function throws.
namespace drogue::perf {

/// Operations of Pttrf and Pttrs: factors and both substitutions of n unknowns.
[[nodiscard]] constexpr Arithmetic spd_arithmetic(std::int64_t n) {
  return {.additions = 3 * (n - 1), .multiplications = 3 * (n - 1), .divisions = 2 * n - 1};
}

/// Diagonal, off-diagonal and right-hand side, which become factors and unknowns.
[[nodiscard]] constexpr std::int64_t spd_bytes(std::int64_t n) { return 16 * (3 * n - 1); }

/// Operations of both recurrences as a host runs them, cut into blocks for 32 lanes, with positive slopes;
/// all zero for other numbers of nodes. tests/kernels/perf/tridiagonal_work_host_test.cpp counts them.
[[nodiscard]] constexpr Arithmetic toeplitz_arithmetic(int nodes) {
  switch (nodes) {
    case 64:
      return {.additions = 559, .multiplications = 603, .comparisons = 217};
    case 128:
      return {.additions = 871, .multiplications = 983, .comparisons = 341};
    case 256:
      return {.additions = 1570, .multiplications = 1780, .comparisons = 627};
    default:
      return {};
  }
}

/// Four factors and the right-hand side; the unknowns.
[[nodiscard]] constexpr std::int64_t toeplitz_bytes(std::int64_t nodes) { return 8 * (4 + 2 * nodes); }

}  // namespace drogue::perf
