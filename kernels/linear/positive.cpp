#include "kernels/linear/positive.hpp"

#include <stdexcept>

namespace drogue::linear {

// Defined in positive_on.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
std::unique_ptr<BatchSolve> make_positive_solve(const PositiveSystems& systems);

std::unique_ptr<BatchSolve> create_positive_solve(device::Backend backend, const PositiveSystems& systems) {
  const auto batch = static_cast<std::size_t>(systems.batch), n = static_cast<std::size_t>(systems.unknowns);
  if (systems.batch < 1 || systems.unknowns < 1 || systems.diagonal.size() != batch * n ||
      systems.beside.size() != batch * (n - 1) || systems.right.size() != batch * n)
    throw std::invalid_argument("positive systems: the arrays are not those of so many unknowns");
  return device::dispatch(
      backend, [&]<class ExecutionSpace>() { return make_positive_solve<ExecutionSpace>(systems); });
}

}  // namespace drogue::linear
