#pragma once

#include <functional>
#include <vector>

namespace drogue::reference {

/// What jumps do on a grid: nodal weights and what goes beyond it.
struct JumpTable {
  std::vector<double> up, down;  ///< [d]: weight of a jump by d nodes, d = 1 .. mesh
  double beyond_up = 0.0, beyond_down = 0.0, beyond_up_price = 0.0, beyond_down_price = 0.0;
  double variance_left = 0.0;  ///< sigma^2 and the jumps' variance, less that of all above
};

/// A put of strike 1 in x = ln(spot/strike), nodes x_i = (i - strike) h.
struct PutProblem {
  double rate, dividend, maturity;
  bool american;
  int mesh, strike, steps;
  double h;
};

/// Values at maturity on all nodes: IMEX-BDF2 on steps that end at maturity (n/steps)^1.5, early exercise by
/// Brennan and Schwartz, as docs/options.md derives it; dense sums and one pass of Gauss for each step.
/// Valid where exercise pays on a half line and nodes beyond the last have no value.
[[nodiscard]] std::vector<double> solve_put(const PutProblem& problem, const JumpTable& jumps);

}  // namespace drogue::reference
