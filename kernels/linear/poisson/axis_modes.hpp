#pragma once

#include <vector>

#include "kernels/linear/poisson/problem.hpp"

namespace drogue::linear {

/// Second difference of the n unknowns along an axis of cells with different widths. That of unknown i is
/// (c[i] (p[i-1] - p[i]) + c[i+1] (p[i+1] - p[i])) / length[i], with zero for the unknown beyond an end.
struct StretchedAxis {
  std::vector<double> lengths;       ///< of the control volumes, m: n
  std::vector<double> conductances;  ///< reciprocal distances of unknowns, 1/m, 0 at a Neumann end: n + 1
};

/// Second difference along an axis with `is_stretched`: between unknowns at centres, half a cell from a
/// Dirichlet end; of unknowns at faces, control volumes end at the centres of cells. Throws
/// std::invalid_argument for a wrong number of widths or one that is not positive and finite.
[[nodiscard]] StretchedAxis stretched_axis(const PoissonProblem& problem, std::size_t axis);

/// Modes of the second difference along an axis. The matrices have n * n numbers, column after column.
struct AxisModes {
  std::vector<double> eigenvalues;  ///< 1/m^2, at most 0, ascending in magnitude unless analytic
  std::vector<double> forward;      ///< its transpose times values gives coefficients
  std::vector<double> backward;     ///< eigenvectors; times coefficients it gives values; empty: `forward`
};

/// Modes along an axis: no matrices if it has one cell; analytic for equal widths, and else those of the
/// symmetric matrix that is similar to the second difference, W^(1/2) A W^(-1/2) = Q L Q^T with the lengths
/// W: `forward` is W^(1/2) Q, and `backward` is W^(-1/2) Q. A mode without end values, of eigenvalue 0, is
/// exact. Throws std::invalid_argument as `stretched_axis`.
[[nodiscard]] AxisModes axis_modes(const PoissonProblem& problem, std::size_t axis);

}  // namespace drogue::linear
