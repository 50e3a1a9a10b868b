#pragma once

#include <memory>
#include <vector>

#include "kernels/device/backend.hpp"
#include "kernels/linear/batch_solve.hpp"

namespace drogue::linear {

/// Symmetric positive definite tridiagonal systems of one size. What belongs to a system is side by side.
struct PositiveSystems {
  int batch = 0, unknowns = 0;
  std::vector<double> diagonal;  ///< (batch, unknowns)
  std::vector<double> beside;    ///< (batch, unknowns - 1): elements (i, i + 1), and (i + 1, i)
  std::vector<double> right;     ///< (batch, unknowns)
};

/// Factors and solves them by Kokkos Kernels' batched Pttrf and Pttrs (L D L^T without pivots), a thread a
/// system. Throws std::invalid_argument for arrays of other sizes and for a
/// backend that is not compiled in.
[[nodiscard]] std::unique_ptr<BatchSolve> create_positive_solve(device::Backend backend,
                                                                const PositiveSystems& systems);

}  // namespace drogue::linear
