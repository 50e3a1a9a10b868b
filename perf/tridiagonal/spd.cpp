#include "perf/tridiagonal/spd.hpp"

#include <stdexcept>

namespace drogue::perf::tridiagonal {

// Defined in spd_impl.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
std::unique_ptr<BatchSolver> make_spd_solver(const SpdBatch& systems);

std::unique_ptr<BatchSolver> create_spd_solver(device::Backend backend, const SpdBatch& systems) {
  const auto batch = static_cast<std::size_t>(systems.batch), n = static_cast<std::size_t>(systems.unknowns);
  if (systems.batch < 1 || systems.unknowns < 1 || systems.diagonal.size() != batch * n ||
      systems.off_diagonal.size() != batch * (n - 1) || systems.right.size() != batch * n)
    throw std::invalid_argument("SPD systems: the sizes of the arrays do not match the number of unknowns");
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return make_spd_solver<ExecutionSpace>(systems); });
}

}  // namespace drogue::perf::tridiagonal
