#pragma once

#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/linear/poisson/axis_basis.hpp"
#include "kernels/linear/poisson/diagonalization.hpp"
#include "kernels/linear/poisson/fourier.hpp"
#include "kernels/linear/poisson/slab_lines.hpp"

namespace drogue::linear {

/// Shape of `planes` planes of a problem. Does not throw.
[[nodiscard]] inline std::array<int, 3> cells_of_planes(const PoissonProblem& problem, int planes) {
  return {problem.cells[0], problem.cells[1], planes};
}

/// Coefficients of planes in x and y by products with the matrices of eigenvectors.
template <class ExecutionSpace>
class PlaneProducts {
 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Allocates one work array; blocks. Throws std::invalid_argument for wrong widths and std::runtime_error
  /// if memory runs out or cuBLAS fails.
  PlaneProducts(const ExecutionSpace& space, const PoissonProblem& problem, int planes, bool /*in_place*/)
      : _space(space), _cells(cells_of_planes(problem, planes)), _product(space) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const AxisModes modes = axis_modes(problem, axis);
      (axis == 0 ? _modes.x : _modes.y) = to_device(space, "drogue::linear::eigenvalues", modes.eigenvalues);
      if (!problem.varies_along(axis)) continue;
      _bases.emplace_back(axis, to_device(space, modes));
    }
    _work = allocate_list(space, "drogue::linear::work",
                          static_cast<std::int64_t>(_cells[0]) * _cells[1] * _cells[2]);
  }

  /// Eigenvalues of the coefficients, 1/m^2. Does not throw.
  [[nodiscard]] const PlaneModes<ExecutionSpace>& modes() const { return _modes; }

  /// Coefficients of values, in their unit: in an array of this object or in `solution`, which may be that of
  /// the values. Asynchronous. Throws std::runtime_error if cuBLAS fails.
  [[nodiscard]] List forward(const List& values, const List& solution) const {
    if (_bases.empty() && values.data() != solution.data()) device::copy(_space, solution, values);
    if (_bases.size() < 2) return _bases.empty() ? solution : multiply(0, true, values, _work);
    return multiply(1, true, multiply(0, true, values, _work), solution);
  }
  /// Values in `solution` from the coefficients that `forward` returned. Asynchronous. Throws as `forward`.
  void backward(const List& coefficients, const List& solution) const {
    if (_bases.size() == 1) multiply(0, false, coefficients, solution);
    if (_bases.size() == 2) multiply(1, false, multiply(0, false, coefficients, _work), solution);
  }

 private:
  /// Product number `which` of `from` in `to`, which it returns.
  List multiply(std::size_t which, bool is_forward, const List& from, const List& to) const {
    const auto& [axis, basis] = _bases[which];
    _product.along_axis(_cells, axis, is_forward ? basis.forward : basis.backward, is_forward, from, to);
    return to;
  }

  ExecutionSpace _space;
  std::array<int, 3> _cells;
  DenseProduct<ExecutionSpace> _product;
  PlaneModes<ExecutionSpace> _modes;
  std::vector<std::pair<std::size_t, AxisBasis<ExecutionSpace>>> _bases;  ///< of axes of several cells
  List _work;
};

/// Coefficients of planes in x and y by fast transforms, on a host by `AxisTransforms`.
template <class ExecutionSpace>
class PlaneTransforms {
 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Whether the cells along x and along y have equal widths. Does not throw.
  static bool supports(const PoissonProblem& problem) {
    return !problem.is_stretched(0) && !problem.is_stretched(1);
  }

  /// Makes the plans; blocks. `in_place`: the values to transform are always in the array of the solution, or
  /// never. Throws std::invalid_argument for an unsupported problem and std::runtime_error if FFTW cannot
  /// plan.
  PlaneTransforms(const ExecutionSpace& space, const PoissonProblem& problem, int planes, bool in_place)
      : _space(space) {
    if (!supports(problem)) throw std::invalid_argument("fast transforms need cells of equal widths");
    for (std::size_t axis = 0; axis < 2; ++axis) {
      (axis == 0 ? _modes.x : _modes.y) =
          to_device(space, "drogue::linear::eigenvalues", transform_eigenvalues(problem, axis));
      if (!problem.varies_along(axis)) continue;
      // The first transform reads the values.
      _transforms.emplace_back(cells_of_planes(problem, planes), axis, problem.axes[axis],
                               !in_place && _transforms.empty());
      _modes.normalisation *= _transforms.back().normalisation();
    }
  }

  /// As those of `PlaneProducts`; they do not throw.
  [[nodiscard]] const PlaneModes<ExecutionSpace>& modes() const { return _modes; }
  [[nodiscard]] List forward(const List& values, const List& solution) const {
    if (_transforms.empty() && values.data() != solution.data()) device::copy(_space, solution, values);
    const double* from = values.data();
    for (const AxisTransforms<ExecutionSpace>& transforms : _transforms) {
      transforms.forward(_space, from, solution.data());
      from = solution.data();
    }
    return solution;
  }
  void backward(const List& /*coefficients*/, const List& solution) const {
    for (const AxisTransforms<ExecutionSpace>& transforms : _transforms)
      transforms.backward(_space, solution.data());
  }

 private:
  ExecutionSpace _space;
  PlaneModes<ExecutionSpace> _modes;
  std::vector<AxisTransforms<ExecutionSpace>> _transforms;  ///< of axes of several cells
};

/// On a device without a library of transforms: products with matrices serve all problems there
/// (`PlaneProducts`).
template <class ExecutionSpace>
requires(!device::is_host<ExecutionSpace>) class PlaneTransforms<ExecutionSpace>
    : public PlaneProducts<ExecutionSpace> {
 public:
  /// Supports no problem. Does not throw.
  static bool supports(const PoissonProblem& /*problem*/) { return false; }

  /// Throws std::invalid_argument.
  PlaneTransforms(const ExecutionSpace& space, const PoissonProblem& problem, int planes, bool in_place)
      : PlaneProducts<ExecutionSpace>(space, problem, planes, in_place) {
    throw std::invalid_argument("this backend has no fast transforms");
  }
};

#if defined(KOKKOS_ENABLE_CUDA)
/// By cuFFT, for problems that are periodic along x and y: a batch of real transforms in up to two
/// dimensions.
template <>
class PlaneTransforms<Kokkos::Cuda> {
 public:
  using List = Kokkos::View<double*, Kokkos::CudaSpace>;

  /// Whether x and y are periodic or have one cell, and their cells have equal widths. Does not throw.
  static bool supports(const PoissonProblem& problem) {
    for (std::size_t axis = 0; axis < 2; ++axis)
      if (problem.is_stretched(axis) || (problem.varies_along(axis) && !problem.axes[axis].periodic))
        return false;
    return true;
  }

  /// Makes the plans and allocates the spectrum; blocks. Throws std::invalid_argument for an unsupported
  /// problem and std::runtime_error if cuFFT cannot plan or memory runs out.
  PlaneTransforms(const Kokkos::Cuda& space, const PoissonProblem& problem, int planes, bool /*in_place*/) {
    if (!supports(problem))
      throw std::invalid_argument("fast transforms on CUDA need periodic axes and cells of equal widths");
    _modes.parts = 2;
    std::vector<int> lengths;
    std::int64_t numbers = 2 * static_cast<std::int64_t>(planes);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const int n = problem.cells[axis];
      std::vector<double> values = axis_eigenvalues(problem, axis);
      if (problem.varies_along(axis)) {
        if (lengths.empty()) values.resize(static_cast<std::size_t>(n / 2 + 1));
        lengths.insert(lengths.begin(), n);
        _modes.normalisation /= n;
      }
      numbers *= static_cast<std::int64_t>(values.size());
      (axis == 0 ? _modes.x : _modes.y) = to_device(space, "drogue::linear::eigenvalues", values);
    }
    if (lengths.empty()) lengths.push_back(1);
    _spectrum = allocate_list(space, "drogue::linear::spectrum", numbers);
    _forward = make_cufft_plan(space, lengths, CUFFT_D2Z, planes);
    _backward = make_cufft_plan(space, lengths, CUFFT_Z2D, planes);
  }

  /// As those of `PlaneProducts`. Throw std::runtime_error if cuFFT fails.
  [[nodiscard]] const PlaneModes<Kokkos::Cuda>& modes() const { return _modes; }
  [[nodiscard]] List forward(const List& values, const List& /*solution*/) const {
    // cuFFT keeps the input of an out-of-place forward transform, though its interface lacks const.
    check_cufft(cufftExecD2Z(*_forward, values.data(), as_complex(_spectrum)));
    return _spectrum;
  }
  void backward(const List& coefficients, const List& solution) const {
    check_cufft(cufftExecZ2D(*_backward, as_complex(coefficients), solution.data()));
  }

 private:
  static cufftDoubleComplex* as_complex(const List& list) {
    return reinterpret_cast<cufftDoubleComplex*>(list.data());
  }

  PlaneModes<Kokkos::Cuda> _modes;
  List _spectrum;
  CufftPlan _forward, _backward;
};
#endif

}  // namespace drogue::linear
