#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kernels/linear/dense_product.hpp"
#include "kernels/linear/poisson/axis_modes.hpp"
#include "kernels/linear/poisson/spectral_scaling.hpp"
#include "kernels/linear/poisson/tridiagonal_lines.hpp"

namespace drogue::linear {

/// Matrices of `AxisModes` on a device; one View twice if they are equal.
template <class ExecutionSpace>
struct AxisBasis {
  Kokkos::View<double*, typename ExecutionSpace::memory_space> forward, backward;
};

/// Copies the matrices to a device; blocks. Throws std::runtime_error if memory runs out.
template <class ExecutionSpace>
AxisBasis<ExecutionSpace> to_device(const ExecutionSpace& space, const AxisModes& modes) {
  AxisBasis<ExecutionSpace> basis;
  basis.forward = basis.backward = to_device(space, "drogue::linear::eigenvectors", modes.forward);
  if (!modes.backward.empty())
    basis.backward = to_device(space, "drogue::linear::eigenvectors", modes.backward);
  return basis;
}

/// Operators that a direct solver can invert.
enum class InvertedOperators {
  any,        ///< the Laplacian and operators of implicit diffusion
  laplacian,  ///< the Laplacian alone, for which more can be prepared
};

/// Direct solver by diagonalization of the second differences along each axis (Lynch, Rice and Thomas 1964):
/// six products with dense matrices of eigenvectors, 4 (nx + ny + nz) floating-point operations per cell, for
/// any combination of boundary conditions and any size. If only the Laplacian is inverted and z has ends,
/// tridiagonal systems along z take the place of two products. The volumes of cells weigh the mean of a
/// singular problem.
template <class ExecutionSpace>
class DiagonalizationSolver {
 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Allocates the matrices and one work array, and one more for the tridiagonal systems; blocks. Throws
  /// std::invalid_argument for a wrong number or value of widths and std::runtime_error if memory runs out.
  DiagonalizationSolver(const ExecutionSpace& space, const PoissonProblem& problem,
                        InvertedOperators operators = InvertedOperators::any)
      : _space(space), _problem(problem), _operators(operators), _product(space) {
    // The first product copies the right-hand side, which a solver of lines overwrites.
    const bool has_lines = operators == InvertedOperators::laplacian &&
                           (problem.varies_along(0) || problem.varies_along(1)) &&
                           TridiagonalLines<ExecutionSpace>::supports(problem);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis == 2 && has_lines) continue;
      const AxisModes modes = axis_modes(problem, axis);
      _eigenvalues[axis] = to_device(space, "drogue::linear::eigenvalues", modes.eigenvalues);
      if (problem.varies_along(axis)) _basis[axis] = to_device(space, modes);
    }
    if (has_lines) _lines.emplace(space, problem, _eigenvalues[0], _eigenvalues[1]);
    _work =
        List(Kokkos::view_alloc(space, Kokkos::WithoutInitializing, "drogue::linear::work"), _problem.size());
  }

  /// Applies the inverse of the operator to the right-hand side, which it keeps. For the Laplacian that is in
  /// the unit of the solution per m^2. Asynchronous; neither fences nor allocates. Throws
  /// std::invalid_argument for an array of the wrong size or an operator that the solver was not made for.
  void enqueue_solve(const List& right_hand_side, const List& solution,
                     const SpectralOperator& spectral_operator = {}) const {
    if (right_hand_side.extent(0) != _problem.size() || solution.extent(0) != _problem.size())
      throw std::invalid_argument("Poisson solver: the arrays must hold one value per cell");
    if (_operators == InvertedOperators::laplacian && spectral_operator.dt != nullptr)
      throw std::invalid_argument("Poisson solver: made for the Laplacian alone");
    // An even number of products leaves the result in the solution.
    List from = right_hand_side, to = _work, other = solution;
    const auto transform = [&](std::size_t axis, bool forward) {
      if (!_problem.varies_along(axis)) return;
      _product.along_axis(_problem.cells, axis, forward ? _basis[axis].forward : _basis[axis].backward,
                          forward, from, to);
      from = to;
      std::swap(to, other);
    };
    transform(0, true);
    transform(1, true);
    if (_lines) {
      _lines->solve(from);
    } else {
      transform(2, true);
      scale_spectrum(_space, SpectralScalingFunctor<ExecutionSpace>{.coefficients = from.data(),
                                                                    .x = _eigenvalues[0],
                                                                    .y = _eigenvalues[1],
                                                                    .z = _eigenvalues[2],
                                                                    .parts = 1,
                                                                    .normalisation = 1.0,
                                                                    .spectral_operator = spectral_operator});
      transform(2, false);
    }
    transform(0, false);
    transform(1, false);
  }

 private:
  ExecutionSpace _space;
  PoissonProblem _problem;
  InvertedOperators _operators;
  DenseProduct<ExecutionSpace> _product;
  std::optional<TridiagonalLines<ExecutionSpace>> _lines;
  AxisBasis<ExecutionSpace> _basis[3];
  List _eigenvalues[3], _work;
};

}  // namespace drogue::linear
