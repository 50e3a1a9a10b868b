#pragma once

#include <array>
#include <stdexcept>
#include <vector>

#include "kernels/linear/poisson/axis_basis.hpp"

namespace drogue::linear {

/// Laplacian by second-order differences on a box of unknowns at the centres or faces of cells. Arrays hold
/// one value per unknown, x fastest.
struct PoissonProblem {
  std::array<int, 3> cells = {1, 1, 1};             ///< unknowns per axis
  std::array<double, 3> spacing = {1.0, 1.0, 1.0};  ///< m
  std::array<AxisConditions, 3> axes;
  /// Of the cells along each axis, m, one more than the unknowns on the inner faces of a bounded axis; empty:
  /// all of `spacing`. Not used along axes of one cell.
  std::array<std::vector<double>, 3> widths = {};

  friend bool operator==(const PoissonProblem&, const PoissonProblem&) = default;

  /// Number of unknowns. Does not throw.
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) *
           static_cast<std::size_t>(cells[2]);
  }

  /// False if the solution does not vary along an axis: one cell. Does not throw.
  [[nodiscard]] bool varies_along(std::size_t axis) const {
    return cells[axis] > 1 || axes[axis].on_inner_faces();
  }

  /// Whether the cells along an axis have widths of their own. Does not throw.
  [[nodiscard]] bool is_stretched(std::size_t axis) const {
    return varies_along(axis) && !widths[axis].empty();
  }
  /// Whether the cells along some axis have. Does not throw.
  [[nodiscard]] bool is_stretched() const { return is_stretched(0) || is_stretched(1) || is_stretched(2); }

  /// True if the solution of Poisson's equation is determined up to a constant only. The solvers then return
  /// the solution of mean zero of the equation whose right-hand side has its mean subtracted; the volumes of
  /// the cells weigh both means. Does not throw.
  [[nodiscard]] bool is_singular() const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (varies_along(axis) && !axes[axis].periodic &&
          (axes[axis].on_faces || axes[axis].low == EndCondition::dirichlet ||
           axes[axis].high == EndCondition::dirichlet))
        return false;
    return true;
  }
};

/// Throws std::invalid_argument for a problem with cells of different widths.
inline void refuse_stretched(const PoissonProblem& problem) {
  if (problem.is_stretched()) throw std::invalid_argument("this Poisson solver needs cells of equal widths");
}

/// Eigenvalues along one axis, 1/m^2; a single zero for an axis of one cell. Does not throw but
/// std::bad_alloc.
inline std::vector<double> axis_eigenvalues(const PoissonProblem& problem, std::size_t axis) {
  const int n = problem.cells[axis];
  std::vector<double> values(static_cast<std::size_t>(n), 0.0);
  if (problem.varies_along(axis))
    for (int k = 0; k < n; ++k)
      values[static_cast<std::size_t>(k)] = axis_eigenvalue(problem.axes[axis], n, problem.spacing[axis], k);
  return values;
}

/// True if the solves of a solver neither block nor allocate, as all do that say nothing else. Does not
/// throw.
template <class Solver>
[[nodiscard]] bool is_asynchronous(const Solver& solver) {
  if constexpr (requires { solver.is_asynchronous(); })
    return solver.is_asynchronous();
  else
    return true;
}

}  // namespace drogue::linear
