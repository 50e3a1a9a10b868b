#pragma once

#include <vector>

#include "kernels/reference/gas/euler.hpp"

namespace drogue::reference {

/// Work arrays of a dense step. Reused between steps to avoid allocations.
struct DenseWorkspace {
  std::vector<Conserved> start, padded, physical, flux;
  std::vector<std::array<double, 3>> speeds;
};

/// Reference for timings: one SSP-RK3 step of WENO5-JS in dense characteristic form, with alpha of each field
/// over the stencil, arithmetic average and outflow ends. It is a straightforward implementation: a loop over
/// the faces, full projections, the scheme fixed at compile time. Advances `state` (SI units) in place by dt
/// = cfl dx / max(|u|+c), `dx` in m; returns dt in s. Throws `std::bad_alloc`.
double dense_step(std::vector<Conserved>& state, DenseWorkspace& workspace, double gamma, double dx,
                  double cfl);

}  // namespace drogue::reference
