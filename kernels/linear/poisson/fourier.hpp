#pragma once

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

/// Direct solver by fast transforms, on a host by FFTW: sine and cosine transforms serve all boundary
/// conditions.
///
/// Each line is transformed by a serial plan, so that the result does not depend on the number of threads.
/// Plans are estimated: measured ones could differ from run to run, and with them the last bits.
template <class ExecutionSpace>
class FourierSolver {
  static_assert(device::is_host<ExecutionSpace>);

 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Whether the solver can treat the problem: always on a host. Does not throw.
  static bool supports(const PoissonProblem& /*problem*/) { return true; }

  /// Makes the plans; blocks. Throws std::runtime_error if FFTW cannot plan.
  FourierSolver(const ExecutionSpace& space, const PoissonProblem& problem)
      : _space(space), _problem(problem) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int n = problem.cells[axis];
      std::vector<double> values(static_cast<std::size_t>(n), 0.0);
      if (problem.varies_along(axis)) {
        const AxisTransform transform = axis_transform(problem.axes[axis], n);
        _normalisation *= transform.normalisation;
        for (int k = 0; k < n; ++k) {
          // Half-complex order: real parts of the wave numbers 0 .. n/2, then imaginary parts downwards.
          const int wave = problem.axes[axis].periodic ? std::min(k, n - k) : k;
          values[static_cast<std::size_t>(k)] =
              axis_eigenvalue(problem.axes[axis], n, problem.spacing[axis], wave);
        }
        make_plans(axis, transform);
      }
      _eigenvalues[axis] = to_device(space, "drogue::linear::eigenvalues", values);
    }
  }

  /// Applies the inverse of the operator to the right-hand side, which it keeps. For the Laplacian that is in
  /// the unit of the solution per m^2. Asynchronous where the execution space is. Throws
  /// std::invalid_argument for an array of the wrong size.
  void enqueue_solve(const List& right_hand_side, const List& solution,
                     const SpectralOperator& spectral_operator = {}) const {
    if (right_hand_side.extent(0) != _problem.size() || solution.extent(0) != _problem.size())
      throw std::invalid_argument("Poisson solver: the arrays must hold one value per cell");
    const double* from = right_hand_side.data();
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (_plans[axis][0]) {
        transform(axis, 0, from, solution.data());
        from = solution.data();
      }
    scale_spectrum(_space, SpectralScalingFunctor<ExecutionSpace>{solution.data(), _eigenvalues[0],
                                                                  _eigenvalues[1], _eigenvalues[2], 1,
                                                                  _normalisation, spectral_operator});
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (_plans[axis][1]) transform(axis, 1, solution.data(), solution.data());
  }

 private:
  using Plan = std::shared_ptr<fftw_plan_s>;

  /// The planes of one transform: their number, the distance of their first numbers, and the lines of each.
  struct Planes {
    int count = 0;
    std::int64_t distance = 0;
    int lines = 0, line_distance = 0, stride = 0;
  };

  [[nodiscard]] Planes planes(std::size_t axis) const {
    const int nx = _problem.cells[0], ny = _problem.cells[1], nz = _problem.cells[2];
    if (axis == 0) return {nz, static_cast<std::int64_t>(nx) * ny, ny, nx, 1};
    if (axis == 1) return {nz, static_cast<std::int64_t>(nx) * ny, nx, 1, nx};
    return {ny, nx, nx, 1, nx * ny};
  }

  /// Plans of an axis. The forward plan of the first axis with more than one cell reads the right-hand side.
  void make_plans(std::size_t axis, const AxisTransform& transform) {
    const Planes p = planes(axis);
    const int n = _problem.cells[axis];
    bool is_first = true;
    for (std::size_t a = 0; a < axis; ++a) is_first = is_first && !_problem.varies_along(a);
    std::vector<double> scratch(_problem.size()), other(is_first ? _problem.size() : 0);
    const fftw_r2r_kind kinds[2] = {transform.forward, transform.backward};
    for (std::size_t direction = 0; direction < 2; ++direction) {
      double* from = is_first && direction == 0 ? other.data() : scratch.data();
      const fftw_plan plan = fftw_plan_many_r2r(1, &n, p.lines, from, nullptr, p.stride, p.line_distance,
                                                scratch.data(), nullptr, p.stride, p.line_distance,
                                                &kinds[direction], FFTW_ESTIMATE | FFTW_UNALIGNED);
      if (plan == nullptr)
        throw std::runtime_error("FFTW cannot plan a transform of length " + std::to_string(n));
      _plans[axis][direction] = Plan(plan, fftw_destroy_plan);
    }
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

  void transform(std::size_t axis, std::size_t direction, const double* from, double* to) const {
    const Planes p = planes(axis);
    Kokkos::parallel_for("drogue::linear::transform", Kokkos::RangePolicy<ExecutionSpace>(_space, 0, p.count),
                         TransformFunctor{_plans[axis][direction].get(), from, to, p.distance});
  }

  ExecutionSpace _space;
  PoissonProblem _problem;
  double _normalisation = 1.0;
  Plan _plans[3][2];
  List _eigenvalues[3];
};

#if defined(KOKKOS_ENABLE_CUDA)
/// By cuFFT, for problems that are periodic along all axes: one real transform in up to three dimensions.
template <>
class FourierSolver<Kokkos::Cuda> {
 public:
  using List = Kokkos::View<double*, Kokkos::CudaSpace>;

  /// Whether all axes are periodic or have one cell. Does not throw.
  static bool supports(const PoissonProblem& problem) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (problem.varies_along(axis) && !problem.axes[axis].periodic) return false;
    return true;
  }

  /// Makes the plans; blocks. Throws std::invalid_argument for an unsupported problem and std::runtime_error
  /// if cuFFT cannot plan.
  FourierSolver(const Kokkos::Cuda& space, const PoissonProblem& problem) : _space(space) {
    if (!supports(problem)) throw std::invalid_argument("the Fourier solver on CUDA needs periodic axes");
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
    _forward = make_plan(lengths, CUFFT_D2Z);
    _backward = make_plan(lengths, CUFFT_Z2D);
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
    check(cufftExecD2Z(*_forward, right_hand_side.data(), spectrum));
    scale_spectrum(
        _space, SpectralScalingFunctor<Kokkos::Cuda>{_spectrum.data(), _eigenvalues[0], _eigenvalues[1],
                                                     _eigenvalues[2], 2, _normalisation, spectral_operator});
    check(cufftExecZ2D(*_backward, spectrum, solution.data()));
  }

 private:
  using Plan = std::shared_ptr<cufftHandle>;

  static void check(cufftResult result) {
    if (result != CUFFT_SUCCESS) throw std::runtime_error("cuFFT: error " + std::to_string(result));
  }
  [[nodiscard]] Plan make_plan(std::vector<int>& lengths, cufftType type) const {
    cufftHandle handle = 0;
    check(cufftPlanMany(&handle, static_cast<int>(lengths.size()), lengths.data(), nullptr, 1, 0, nullptr, 1,
                        0, type, 1));
    check(cufftSetStream(handle, _space.cuda_stream()));
    return {new cufftHandle(handle), [](cufftHandle* owned) {
              cufftDestroy(*owned);
              delete owned;
            }};
  }

  Kokkos::Cuda _space;
  std::size_t _cells = 0;
  double _normalisation = 1.0;
  List _eigenvalues[3], _spectrum;
  Plan _forward, _backward;
};
#endif

}  // namespace drogue::linear
