#pragma once

#include <memory>
#include <vector>

#include "kernels/device/backend.hpp"
#include "perf/tridiagonal/batch_solver.hpp"

namespace drogue::perf::tridiagonal {

/// Tridiagonal Toeplitz system of an implicit time step of an option:
/// -lower x_{i-1} + diagonal x_i - upper x_{i+1} = right_i on the nodes i = 1 .. n - 1, x_0 = boundary_value.
/// Requires lower * upper >= 0 and diagonal > |lower| + |upper|. The grid continues beyond its last node with
/// a right-hand side of zero; elimination from there gives the last node the diagonal `limit_pivot`.
struct ToeplitzSystem {
  double lower, diagonal, upper, boundary_value;
};

/// (d + sqrt(d^2 - 4 l u))/2: limit of the pivots of Gaussian elimination on a semi-infinite grid. Does not
/// throw.
[[nodiscard]] double limit_pivot(const ToeplitzSystem& system);

/// Batch of Toeplitz systems on grids of one size.
struct ToeplitzBatch {
  int nodes = 0;  ///< n, 33 to 4096
  std::vector<ToeplitzSystem> systems;
  std::vector<double> right;  ///< (systems, n), row-major; the value at node 0 is ignored
};

/// Solver by the two recurrences with constant coefficients of the option solver
/// (`kernels/options/pide/thread_group.hpp`, on a device with 128 or 256 nodes `register_march.hpp`), without
/// an exercise constraint. Its `solution` is (systems, n). Throws std::invalid_argument for a number of nodes
/// out of range, a right-hand side of the wrong size, and a backend that is not compiled in.
[[nodiscard]] std::unique_ptr<BatchSolver> create_toeplitz_solver(device::Backend backend,
                                                                  const ToeplitzBatch& batch);

}  // namespace drogue::perf::tridiagonal
