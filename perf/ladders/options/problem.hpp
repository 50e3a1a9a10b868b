#pragma once

#include <vector>

#include "perf/ladders/ladder.hpp"

namespace drogue::perf::ladder {

/// Nodes of the grid of an option, time steps of a solve.
inline constexpr int option_nodes = 128, option_steps = 32;

/// Coefficients of a time step of an option: v <- T^-1 (v + jumps W v), tridiagonal T with constant rows
/// -lower, diagonal, -upper between the first and the last node.
struct OptionStep {
  double lower, diagonal, upper;
  double jumps;    ///< dt times jumps per year
  double rate_dt;  ///< rate times dt, of the discounted strike at the first node
};

/// Problem of the options ladder: European puts of strike 1 under jumps of normal logarithms (Merton 1976) by
/// implicit Euler steps, with the jumps of each step from the values before it. Options differ in variance,
/// rate and maturity and share the distribution of jumps.
struct OptionsProblem {
  /// Largest error of a rung: sums of 128 values below one, in 32 steps that damp.
  static constexpr double tolerance = 1e-13;

  double low, h;                  ///< x_0 = ln(spot/strike) of the first node, and spacing
  std::vector<double> weights;    ///< w_d of jumps by d = 1 - nodes .. nodes - 1, at index d + nodes - 1
  std::vector<OptionStep> steps;  ///< of each option
  std::vector<double> payoff;     ///< at the nodes
  std::vector<double> expected;   ///< (options, nodes): values by elimination with pivots in long double

  [[nodiscard]] int options() const { return static_cast<int>(steps.size()); }
};

/// Additions and multiplications per node of `solve_step`, counted by tests/kernels/ladders/.
inline constexpr double elimination_operations = 8.0;

/// Throws std::bad_alloc.
[[nodiscard]] OptionsProblem make_options_problem(int options);

/// Price of the k-th option of a problem at spot = strike by the series of Merton 1976, eq. (19), in strikes.
/// Does not throw.
[[nodiscard]] double merton_put(int k);

/// Largest difference of (options, nodes) values from the expected ones, in strikes. Infinite for values that
/// are not finite. Does not throw.
[[nodiscard]] double difference(const OptionsProblem& problem, const std::vector<double>& values);

/// Work of a batch with the given launches, and bytes per option, node and step between kernels and memory.
/// Does not throw.
[[nodiscard]] Work options_work(const OptionsProblem& problem, double launches, double bytes);

}  // namespace drogue::perf::ladder
