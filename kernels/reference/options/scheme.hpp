#pragma once

#include <vector>

namespace drogue::reference {

/// Jumps on a grid, all weights and tails 1/year.
struct JumpTable {
  std::vector<double> up, down;                       ///< weights of jumps by d nodes at index d = 1 .. mesh
  double tail_up = 0.0, tail_down = 0.0;              ///< integral of g over longer jumps
  double tail_up_price = 0.0, tail_down_price = 0.0;  ///< integral of e^y g over longer jumps
  /// sigma^2 and the variance of the jumps, less the variance of the weights and tails above.
  double remaining_variance = 0.0;
  double moved = 0.0;  ///< half the part of `remaining_variance` that jumps to the next node had at first
};

/// Put of strike 1 in x = ln(spot/strike) on the nodes x_i = (i - strike) h. Rates per year, maturity in
/// years.
struct PutProblem {
  double rate, dividend, maturity;
  bool american;
  int mesh, strike, steps;
  double h;
};

/// Current values, in strikes, on all nodes: the scheme of docs/options.md for the equation of [Shi], section
/// 4.6.1, in long double, with sums over all jumps and one sequential elimination per step.
///
/// IMEX-BDF2 with time levels T (n/steps)^1.5; early exercise as Brennan and Schwartz (1977). Valid if the
/// exercise region is a half line and values beyond the last node vanish.
[[nodiscard]] std::vector<double> solve_put(const PutProblem& problem, const JumpTable& jumps);

}  // namespace drogue::reference
