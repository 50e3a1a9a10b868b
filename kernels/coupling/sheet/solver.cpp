#include "kernels/coupling/sheet/solver.hpp"

#include <new>
#include <stdexcept>
#include <string_view>

#include "kernels/device/backend_list.hpp"

namespace drogue::coupling {

// Defined in solver_adapter.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& parameters);

std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters) {
  try {
    return device::dispatch(backend,
                            [&]<class ExecutionSpace>() { return make_solver<ExecutionSpace>(parameters); });
  } catch (const std::runtime_error& error) {
    // Kokkos throws this for a failed allocation.
    if (std::string_view(error.what()).find("failed to allocate") != std::string_view::npos)
      throw std::bad_alloc();
    throw;
  }
}

}  // namespace drogue::coupling
