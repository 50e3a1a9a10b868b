#pragma once

#include <memory>
#include <vector>

#include "kernels/device/backend.hpp"

namespace drogue::perf::tridiagonal {

/// Batch of tridiagonal systems of one size on a backend. The numbers are dimensionless. Requires an
/// initialised runtime. No function throws, but std::runtime_error for a CUDA error.
class BatchSolver {
 public:
  virtual ~BatchSolver() = default;

  /// Restores the equations if `solve` overwrote them. Blocking.
  virtual void reset() = 0;

  /// Solves all systems. Blocking.
  virtual void solve() = 0;

  /// Solves all systems and returns the time on the device (`device_time`), s; 0 on a host, which does not
  /// solve. Blocking.
  virtual double timed_solve() = 0;

  /// Unknowns (batch, unknowns), row by row. Blocking.
  [[nodiscard]] virtual std::vector<double> solution() = 0;
};

/// Batch of symmetric positive definite tridiagonal systems; the arrays are row-major.
struct SpdBatch {
  int batch = 0, unknowns = 0;
  std::vector<double> diagonal;      ///< (batch, unknowns)
  std::vector<double> off_diagonal;  ///< (batch, unknowns - 1): elements (i, i + 1) and (i + 1, i)
  std::vector<double> right;         ///< (batch, unknowns)
};

/// Solver by the batched Pttrf and Pttrs of Kokkos Kernels (L D L^T without pivoting), one thread per system.
/// Throws std::invalid_argument for arrays of the wrong size and for a backend that is not compiled in.
[[nodiscard]] std::unique_ptr<BatchSolver> create_spd_solver(device::Backend backend,
                                                             const SpdBatch& systems);

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
