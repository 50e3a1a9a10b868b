#include "perf/pressure/pressure.hpp"

namespace drogue::perf::pressure {

// Defined in pressure_impl.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
bool supports(const linear::PoissonProblem& problem, flow::PressureSolver method);
template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const linear::PoissonProblem& problem, flow::PressureSolver method,
                                    double tolerance);

bool is_available(device::Backend backend, const linear::PoissonProblem& problem,
                  flow::PressureSolver method) {
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return supports<ExecutionSpace>(problem, method); });
}

std::unique_ptr<Solver> create_solver(device::Backend backend, const linear::PoissonProblem& problem,
                                      flow::PressureSolver method, double tolerance) {
  return device::dispatch(backend, [&]<class ExecutionSpace>() {
    return make_solver<ExecutionSpace>(problem, method, tolerance);
  });
}

}  // namespace drogue::perf::pressure
