#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fftw3.h>

#include "kernels/device/memory.hpp"
#include "kernels/linear/poisson/spectral_scaling.hpp"

#if defined(KOKKOS_ENABLE_CUDA)
#include <cufft.h>
#endif

namespace drogue::linear {

/// Real transforms of FFTW along one axis: forward, backward, and the product of their normalisations.
struct AxisTransform {
  fftw_r2r_kind forward, backward;
  double normalisation;
};

/// Transform whose basis diagonalises the second difference with the given conditions, for n unknowns. Does
/// not throw.
inline AxisTransform axis_transform(const AxisConditions& axis, int n) {
  if (axis.periodic) return {FFTW_R2HC, FFTW_HC2R, 1.0 / n};
  if (axis.on_faces) return {FFTW_RODFT00, FFTW_RODFT00, 0.5 / (n + 1)};
  const bool low = axis.low == EndCondition::neumann, high = axis.high == EndCondition::neumann;
  if (low && high) return {FFTW_REDFT10, FFTW_REDFT01, 0.5 / n};
  if (low) return {FFTW_REDFT11, FFTW_REDFT11, 0.5 / n};
  if (high) return {FFTW_RODFT11, FFTW_RODFT11, 0.5 / n};
  return {FFTW_RODFT10, FFTW_RODFT01, 0.5 / n};
}

/// Eigenvalues along an axis, 1/m^2, in the order of the coefficients of `axis_transform`. Does not throw but
/// std::bad_alloc.
inline std::vector<double> transform_eigenvalues(const PoissonProblem& problem, std::size_t axis) {
  const int n = problem.cells[axis];
  std::vector<double> values(static_cast<std::size_t>(n), 0.0);
  if (!problem.varies_along(axis)) return values;
  for (int k = 0; k < n; ++k) {
    // Half-complex order: real parts of the wave numbers 0 .. n/2, then imaginary parts downwards.
    const int wave = problem.axes[axis].periodic ? std::min(k, n - k) : k;
    values[static_cast<std::size_t>(k)] = axis_eigenvalue(problem.axes[axis], n, problem.spacing[axis], wave);
  }
  return values;
}

/// Transforms of all lines of an array along one axis, on a host by FFTW: sine and cosine transforms serve
/// all boundary conditions.
///
/// Each line is transformed by a serial plan, so that the result does not depend on the number of threads.
/// Plans are estimated: measured ones could differ from run to run, and with them the last bits.
template <class ExecutionSpace>
class AxisTransforms {
  static_assert(device::is_host<ExecutionSpace>);

 public:
  AxisTransforms() = default;

  /// Makes the plans for an array of `cells`, x fastest. The forward transform works out of place if
  /// `keeps_input`; otherwise both work in place. Throws std::runtime_error if FFTW cannot plan.
  AxisTransforms(const std::array<int, 3>& cells, std::size_t axis, const AxisConditions& conditions,
                 bool keeps_input)
      : _planes(planes(cells, axis)) {
    const int n = cells[axis];
    const AxisTransform transform = axis_transform(conditions, n);
    _normalisation = transform.normalisation;
    const std::size_t size = static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) *
                             static_cast<std::size_t>(cells[2]);
    if (size == 0) return;
    std::vector<double> scratch(size), other(keeps_input ? size : 0);
    const fftw_r2r_kind kinds[2] = {transform.forward, transform.backward};
    for (std::size_t direction = 0; direction < 2; ++direction) {
      double* from = keeps_input && direction == 0 ? other.data() : scratch.data();
      const fftw_plan plan = fftw_plan_many_r2r(
          1, &n, _planes.lines, from, nullptr, _planes.stride, _planes.line_distance, scratch.data(), nullptr,
          _planes.stride, _planes.line_distance, &kinds[direction], FFTW_ESTIMATE | FFTW_UNALIGNED);
      if (plan == nullptr)
        throw std::runtime_error("FFTW cannot plan a transform of length " + std::to_string(n));
      _plans[direction] = Plan(plan, fftw_destroy_plan);
    }
  }

  /// Dimensionless factor that undoes the growth by a forward and a backward transform. Does not throw.
  [[nodiscard]] double normalisation() const { return _normalisation; }

  /// Forward transform, in the unit of the input; `from` equals `to` unless the input is kept. Asynchronous
  /// where the execution space is. Does nothing for an object or array without cells. Does not throw.
  void forward(const ExecutionSpace& space, const double* from, double* to) const {
    transform(space, 0, from, to);
  }
  /// Backward transform in place, in the unit of the values, as `forward`. Does not throw.
  void backward(const ExecutionSpace& space, double* values) const { transform(space, 1, values, values); }

  /// False for an object without plans. Does not throw.
  explicit operator bool() const { return _plans[0] != nullptr; }

 private:
  using Plan = std::shared_ptr<fftw_plan_s>;

  /// The planes of one transform: their number, the distance of their first numbers, and the lines of each.
  struct Planes {
    int count = 0;
    std::int64_t distance = 0;
    int lines = 0, line_distance = 0, stride = 0;
  };

  [[nodiscard]] static Planes planes(const std::array<int, 3>& cells, std::size_t axis) {
    const int nx = cells[0], ny = cells[1], nz = cells[2];
    if (axis == 0)
      return {.count = nz,
              .distance = static_cast<std::int64_t>(nx) * ny,
              .lines = ny,
              .line_distance = nx,
              .stride = 1};
    if (axis == 1)
      return {.count = nz,
              .distance = static_cast<std::int64_t>(nx) * ny,
              .lines = nx,
              .line_distance = 1,
              .stride = nx};
    return {.count = ny, .distance = nx, .lines = nx, .line_distance = 1, .stride = nx * ny};
  }

  struct TransformFunctor {
    fftw_plan plan;
    const double* from;
    double* to;
    std::int64_t distance;
    void operator()(const int plane) const {
      // FFTW's interface lacks const; plans of one dimension and this kind keep their input.
      fftw_execute_r2r(plan, const_cast<double*>(from + plane * distance), to + plane * distance);
    }
  };

  void transform(const ExecutionSpace& space, std::size_t direction, const double* from, double* to) const {
    if (!_plans[direction]) return;
    Kokkos::parallel_for("drogue::linear::transform",
                         Kokkos::RangePolicy<ExecutionSpace>(space, 0, _planes.count),
                         TransformFunctor{_plans[direction].get(), from, to, _planes.distance});
  }

  Planes _planes;
  double _normalisation = 1.0;
  Plan _plans[2];
};

/// Direct solver by fast transforms, on a host by `AxisTransforms`.
template <class ExecutionSpace>
class FourierSolver {
 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Whether the cells along each axis have equal widths. Does not throw.
  static bool supports(const PoissonProblem& problem) { return !problem.is_stretched(); }

  /// Makes the plans; blocks. `in_place`: right-hand side and solution are always the same array, or never.
  /// Throws std::invalid_argument for an unsupported problem and std::runtime_error if FFTW cannot plan.
  FourierSolver(const ExecutionSpace& space, const PoissonProblem& problem, bool in_place = false)
      : _space(space), _problem(problem) {
    refuse_stretched(problem);
    // The transform of the first axis with more than one cell reads the right-hand side.
    bool is_first = !in_place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (problem.varies_along(axis)) {
        _transforms[axis] = AxisTransforms<ExecutionSpace>(problem.cells, axis, problem.axes[axis], is_first);
        _normalisation *= _transforms[axis].normalisation();
        is_first = false;
      }
      _eigenvalues[axis] =
          to_device(space, "drogue::linear::eigenvalues", transform_eigenvalues(problem, axis));
    }
  }

  /// Applies the inverse of the operator to the right-hand side, which it keeps unless it is in place. For
  /// the Laplacian that is in the unit of the solution per m^2. Asynchronous where the execution space is.
  /// Throws std::invalid_argument for an array of the wrong size.
  void enqueue_solve(const List& right_hand_side, const List& solution,
                     const SpectralOperator& spectral_operator = {}) const {
    if (right_hand_side.extent(0) != _problem.size() || solution.extent(0) != _problem.size())
      throw std::invalid_argument("Poisson solver: the arrays must hold one value per cell");
    const double* from = right_hand_side.data();
    for (const AxisTransforms<ExecutionSpace>& transforms : _transforms)
      if (transforms) {
        transforms.forward(_space, from, solution.data());
        from = solution.data();
      }
    scale_spectrum(_space, SpectralScalingFunctor<ExecutionSpace>{.coefficients = solution.data(),
                                                                  .x = _eigenvalues[0],
                                                                  .y = _eigenvalues[1],
                                                                  .z = _eigenvalues[2],
                                                                  .parts = 1,
                                                                  .normalisation = _normalisation,
                                                                  .spectral_operator = spectral_operator});
    for (const AxisTransforms<ExecutionSpace>& transforms : _transforms)
      transforms.backward(_space, solution.data());
  }

 private:
  ExecutionSpace _space;
  PoissonProblem _problem;
  double _normalisation = 1.0;
  AxisTransforms<ExecutionSpace> _transforms[3];
  List _eigenvalues[3];
};

/// On a device without a library of transforms: products with matrices solve all problems there
/// (`DiagonalizationSolver`).
template <class ExecutionSpace>
requires(!device::is_host<ExecutionSpace>) class FourierSolver<ExecutionSpace> {
 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Supports no problem. Does not throw.
  static bool supports(const PoissonProblem& /*problem*/) { return false; }

  /// Throws std::invalid_argument.
  FourierSolver(const ExecutionSpace& /*space*/, const PoissonProblem& /*problem*/,
                bool /*in_place*/ = false) {
    throw std::invalid_argument("this backend has no fast transforms");
  }

  /// Never called: there is no object.
  void enqueue_solve(const List& /*right_hand_side*/, const List& /*solution*/,
                     const SpectralOperator& /*spectral_operator*/ = {}) const {}
};

#if defined(KOKKOS_ENABLE_CUDA)
using CufftPlan = std::shared_ptr<cufftHandle>;

/// Throws std::runtime_error for an error of cuFFT.
inline void check_cufft(cufftResult result) {
  if (result != CUFFT_SUCCESS) throw std::runtime_error("cuFFT: error " + std::to_string(result));
}

/// Plan of `batch` contiguous transforms, the slowest axis first, enqueued on `space`. Throws as
/// `check_cufft`.
[[nodiscard]] inline CufftPlan make_cufft_plan(const Kokkos::Cuda& space, std::vector<int> lengths,
                                               cufftType type, int batch) {
  cufftHandle handle = 0;
  check_cufft(cufftPlanMany(&handle, static_cast<int>(lengths.size()), lengths.data(), nullptr, 1, 0, nullptr,
                            1, 0, type, batch));
  check_cufft(cufftSetStream(handle, space.cuda_stream()));
  return {new cufftHandle(handle), [](cufftHandle* owned) {
            cufftDestroy(*owned);
            delete owned;
          }};
}

/// By cuFFT, for problems that are periodic along all axes: one real transform in up to three dimensions.
template <>
class FourierSolver<Kokkos::Cuda> {
 public:
  using List = Kokkos::View<double*, Kokkos::CudaSpace>;

  /// Whether all axes are periodic or have one cell, and all cells have equal widths. Does not throw.
  static bool supports(const PoissonProblem& problem) {
    if (problem.is_stretched()) return false;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (problem.varies_along(axis) && !problem.axes[axis].periodic) return false;
    return true;
  }

  /// Makes the plans; blocks. Throws std::invalid_argument for an unsupported problem and std::runtime_error
  /// if cuFFT cannot plan. The solution may always be in the array of the right-hand side.
  FourierSolver(const Kokkos::Cuda& space, const PoissonProblem& problem, bool /*in_place*/ = false)
      : _space(space) {
    if (!supports(problem))
      throw std::invalid_argument("the Fourier solver on CUDA needs periodic axes and cells of equal widths");
    // The order of cuFFT is the slowest axis first; axes of one cell have no transform.
    std::vector<int> lengths;
    std::size_t modes = 1;
    bool halved = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int n = problem.cells[axis];
      std::vector<double> values = axis_eigenvalues(problem, axis);
      if (n > 1) {
        lengths.insert(lengths.begin(), n);
        _normalisation /= n;
        if (!halved) values.resize(static_cast<std::size_t>(n / 2 + 1));
        halved = true;
      }
      modes *= values.size();
      _eigenvalues[axis] = to_device(space, "drogue::linear::eigenvalues", values);
    }
    _cells = problem.size();
    if (lengths.empty()) lengths.push_back(1);
    _spectrum =
        List(Kokkos::view_alloc(space, Kokkos::WithoutInitializing, "drogue::linear::spectrum"), 2 * modes);
    _forward = make_cufft_plan(space, lengths, CUFFT_D2Z, 1);
    _backward = make_cufft_plan(space, lengths, CUFFT_Z2D, 1);
  }

  /// Applies the inverse of the operator to the right-hand side, which it keeps. For the Laplacian that is in
  /// the unit of the solution per m^2. Asynchronous; neither fences nor allocates. Throws
  /// std::invalid_argument for an array of the wrong size.
  void enqueue_solve(const List& right_hand_side, const List& solution,
                     const SpectralOperator& spectral_operator = {}) const {
    if (right_hand_side.extent(0) != _cells || solution.extent(0) != _cells)
      throw std::invalid_argument("Poisson solver: the arrays must hold one value per cell");
    auto* spectrum = reinterpret_cast<cufftDoubleComplex*>(_spectrum.data());
    // cuFFT keeps the input of an out-of-place forward transform, though its interface lacks const.
    check_cufft(cufftExecD2Z(*_forward, right_hand_side.data(), spectrum));
    scale_spectrum(_space, SpectralScalingFunctor<Kokkos::Cuda>{.coefficients = _spectrum.data(),
                                                                .x = _eigenvalues[0],
                                                                .y = _eigenvalues[1],
                                                                .z = _eigenvalues[2],
                                                                .parts = 2,
                                                                .normalisation = _normalisation,
                                                                .spectral_operator = spectral_operator});
    check_cufft(cufftExecZ2D(*_backward, spectrum, solution.data()));
  }

 private:
  Kokkos::Cuda _space;
  std::size_t _cells = 0;
  double _normalisation = 1.0;
  List _eigenvalues[3], _spectrum;
  CufftPlan _forward, _backward;
};
#endif

}  // namespace drogue::linear
