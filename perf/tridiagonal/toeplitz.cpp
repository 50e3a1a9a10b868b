#include "perf/tridiagonal/toeplitz.hpp"

#include <cmath>
#include <stdexcept>

namespace drogue::perf::tridiagonal {

double limit_pivot(const ToeplitzSystem& system) {
  return 0.5 *
         (system.diagonal + std::sqrt(system.diagonal * system.diagonal - 4.0 * system.lower * system.upper));
}

// Defined in toeplitz_impl.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
std::unique_ptr<BatchSolver> make_toeplitz_solver(const ToeplitzBatch& batch);

std::unique_ptr<BatchSolver> create_toeplitz_solver(device::Backend backend, const ToeplitzBatch& batch) {
  if (batch.nodes < 33 || batch.nodes > 4096)
    throw std::invalid_argument("Toeplitz systems: the number of nodes must be from 33 to 4096");
  if (batch.systems.empty() ||
      batch.right.size() != batch.systems.size() * static_cast<std::size_t>(batch.nodes))
    throw std::invalid_argument("Toeplitz systems: each system needs one right-hand side value per node");
  return device::dispatch(
      backend, [&]<class ExecutionSpace>() { return make_toeplitz_solver<ExecutionSpace>(batch); });
}

}  // namespace drogue::perf::tridiagonal
