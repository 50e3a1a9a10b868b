#pragma once

#include <vector>

#include "perf/ladders/ladder.hpp"

namespace drogue::perf::ladder {

/// Problem of the transfer ladder: steps x <- 1 / (1 + x) of many values that the host owns.
struct TransferProblem {
  /// Largest error of a rung. The step is a contraction: rounding errors do not add up.
  static constexpr double tolerance = 1e-14;

  std::vector<double> start;     ///< in [0, 1]
  std::vector<double> expected;  ///< after the steps, in closed form by Fibonacci numbers
  long steps;
};

/// Throws std::bad_alloc.
[[nodiscard]] TransferProblem make_transfer_problem(std::size_t values, long steps);

/// Work per step: `launches` kernels over all values, with `copies` that move each value `moves` times
/// between host and device. Does not throw.
[[nodiscard]] Work transfer_work(const TransferProblem& problem, double launches, double copies,
                                 double moves);

}  // namespace drogue::perf::ladder
