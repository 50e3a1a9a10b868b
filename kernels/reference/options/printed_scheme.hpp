#pragma once

#include <vector>

#include "kernels/reference/options/levy.hpp"

namespace drogue::reference {

/// Put of strike 1 in x = ln(spot/strike) on the nodes x_i = (2 i/mesh - 1) half_width. Rates and variance
/// per year, maturity in years.
struct PrintedPut {
  double rate, dividend, maturity, variance;
  GeneralizedHyperbolic jumps;
  bool american;
  double half_width;
  int mesh, steps;
};

/// Current values, in strikes, on all nodes by the scheme of [Shi], section 4.6.2, with epsilon = dx. The
/// integrals over |y| > epsilon are sums of dx g(k dx), half of it at k = -1 and 1; jumps by more than `mesh`
/// and a half nodes, and those to below the grid, are integrated exactly. Equal steps; early exercise as f =
/// max(payoff, f) after each. The boundary values are strike - spot, discounted if European, and 0.
[[nodiscard]] std::vector<double> solve_printed_put(const PrintedPut& put);

}  // namespace drogue::reference
