#pragma once

#include <array>

#include "kernels/linear/poisson/axis_basis.hpp"

namespace drogue::linear {

/// Poisson's equation lap p = f by second-order differences on a box of cells of uniform spacing. Arrays hold
/// one value per cell, x fastest.
struct PoissonProblem {
  std::array<int, 3> cells = {1, 1, 1};
  std::array<double, 3> spacing = {1.0, 1.0, 1.0};  ///< m
  std::array<AxisConditions, 3> axes;

  /// True if p is determined up to a constant only. The solvers then return the solution of mean zero of the
  /// equation whose right-hand side has its mean subtracted. Does not throw.
  [[nodiscard]] bool is_singular() const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (cells[axis] > 1 && !axes[axis].periodic &&
          (axes[axis].low == EndCondition::dirichlet || axes[axis].high == EndCondition::dirichlet))
        return false;
    return true;
  }
};

/// Eigenvalues along one axis, 1/m^2; a single zero for an axis of one cell. Does not throw but
/// std::bad_alloc.
inline std::vector<double> axis_eigenvalues(const PoissonProblem& problem, std::size_t axis) {
  const int n = problem.cells[axis];
  std::vector<double> values(static_cast<std::size_t>(n), 0.0);
  if (n > 1)
    for (int k = 0; k < n; ++k)
      values[static_cast<std::size_t>(k)] = axis_eigenvalue(problem.axes[axis], n, problem.spacing[axis], k);
  return values;
}

}  // namespace drogue::linear
