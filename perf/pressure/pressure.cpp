#include "perf/pressure/pressure.hpp"

#include <random>

#include "kernels/device/instance.hpp"
#include "kernels/linear/poisson/diagonalization.hpp"
#include "kernels/linear/poisson/fourier.hpp"
#include "kernels/linear/poisson/slab_solver.hpp"

#if defined(DROGUE_HAVE_HYPRE)
#include "kernels/linear/poisson/hypre_pfmg.hpp"
#endif

namespace drogue::perf::pressure {

linear::AxisMethod axis_method(flow::PressureSolver method) {
  return method == flow::PressureSolver::fft ? linear::AxisMethod::fourier
                                             : linear::AxisMethod::diagonalization;
}

template <class ExecutionSpace>
bool supports(const linear::PoissonProblem& problem, flow::PressureSolver method, bool in_slabs) {
  if (in_slabs) return linear::SlabSolver<ExecutionSpace>::supports(problem, axis_method(method));
  if (method == flow::PressureSolver::fft) return linear::FourierSolver<ExecutionSpace>::supports(problem);
#if defined(DROGUE_HAVE_HYPRE)
  return true;
#else
  return method != flow::PressureSolver::hypre_pfmg;
#endif
}

/// `Solver` by a solver of `kernels/linear`.
template <class ExecutionSpace, class Poisson>
class SolverOf final : public Solver {
 public:
  template <class... Arguments>
  explicit SolverOf(const linear::PoissonProblem& problem, const Arguments&... arguments)
      : _poisson(_instance.space(), problem, arguments...),
        _solution("drogue::perf::solution", problem.size()) {
    std::mt19937 engine(17);
    for (std::size_t k = 0; k < 2; ++k) {
      double mean = 0.0;
      for (std::size_t i = 0; i < problem.size(); ++i) {
        _values[k].push_back(2.0 * std::generate_canonical<double, 53>(engine) - 1.0);
        mean += _values[k].back() / static_cast<double>(problem.size());
      }
      if (problem.is_singular())
        for (double& value : _values[k]) value -= mean;
      _right_hand_sides[k] =
          linear::to_device(_instance.space(), "drogue::perf::right_hand_side", _values[k]);
    }
  }

  void solve(long count) override {
    for (long k = 0; k < count; ++k) {
      _last = 1 - _last;
      _poisson.enqueue_solve(_right_hand_sides[_last], _solution);
    }
    _instance.space().fence("drogue::perf::pressure");
  }
  [[nodiscard]] const std::vector<double>& right_hand_side() const override { return _values[_last]; }
  [[nodiscard]] std::vector<double> solution() const override {
    std::vector<double> values(_solution.extent(0));
    device::copy_out(_instance.space(), values.data(), _solution, values.size());
    _instance.space().fence("drogue::perf::pressure");
    return values;
  }
  [[nodiscard]] int iterations() const override {
    if constexpr (requires { _poisson.iterations(); })
      return _poisson.iterations();
    else
      return 0;
  }

 private:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;
  device::Instance<ExecutionSpace> _instance{1 << 10};
  Poisson _poisson;
  std::vector<double> _values[2];
  List _right_hand_sides[2], _solution;
  std::size_t _last = 0;
};

template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const linear::PoissonProblem& problem, flow::PressureSolver method,
                                    [[maybe_unused]] double tolerance, bool in_slabs) {
  if (in_slabs)
    return std::make_unique<SolverOf<ExecutionSpace, linear::SlabSolver<ExecutionSpace>>>(
        problem, linear::DeviceCommunicator<ExecutionSpace>(), linear::PencilRanks(), axis_method(method),
        linear::InvertedOperators::laplacian);
  if (method == flow::PressureSolver::fft)
    return std::make_unique<SolverOf<ExecutionSpace, linear::FourierSolver<ExecutionSpace>>>(problem);
#if defined(DROGUE_HAVE_HYPRE)
  if (method == flow::PressureSolver::hypre_pfmg)
    return std::make_unique<SolverOf<ExecutionSpace, linear::HyprePfmgSolver<ExecutionSpace>>>(problem,
                                                                                               tolerance);
#endif
  return std::make_unique<SolverOf<ExecutionSpace, linear::DiagonalizationSolver<ExecutionSpace>>>(
      problem, linear::InvertedOperators::laplacian);
}

bool is_available(device::Backend backend, const linear::PoissonProblem& problem, flow::PressureSolver method,
                  bool in_slabs) {
  return device::dispatch(
      backend, [&]<class ExecutionSpace>() { return supports<ExecutionSpace>(problem, method, in_slabs); });
}

std::unique_ptr<Solver> create_solver(device::Backend backend, const linear::PoissonProblem& problem,
                                      flow::PressureSolver method, double tolerance, bool in_slabs) {
  return device::dispatch(backend, [&]<class ExecutionSpace>() {
    return make_solver<ExecutionSpace>(problem, method, tolerance, in_slabs);
  });
}

}  // namespace drogue::perf::pressure
