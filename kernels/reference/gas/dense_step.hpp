#pragma once

#include <vector>

#include "kernels/reference/gas/euler.hpp"

namespace drogue::reference {

/// Arrays that a dense step needs besides the state; kept between steps so that a step allocates nothing.
struct DenseWorkspace {
  std::vector<Conserved> start, padded, physical, flux;
  std::vector<std::array<double, 3>> speeds;
};

/// The yardstick of speed: one SSP-RK3 step of WENO5-JS, dense characteristic form, alpha of each field over
/// the stencil, arithmetic mean, outflow ends, written as one would write it first: a loop over the faces,
/// full projections, the scheme known at compile time. Advances `state` in place by dt = cfl dx / max(|u|+c);
/// returns dt.
double dense_step(std::vector<Conserved>& state, DenseWorkspace& workspace, double gamma, double dx,
                  double cfl);

}  // namespace drogue::reference
