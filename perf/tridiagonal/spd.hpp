#pragma once

#include <memory>
#include <vector>

#include "kernels/device/backend.hpp"
#include "perf/tridiagonal/batch_solver.hpp"

namespace drogue::perf::tridiagonal {

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

}  // namespace drogue::perf::tridiagonal
