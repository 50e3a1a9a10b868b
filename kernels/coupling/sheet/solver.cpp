#include "kernels/coupling/sheet/solver.hpp"

#include "kernels/device/allocate.hpp"
#include "kernels/device/backend_list.hpp"

namespace drogue::coupling {

// Solver on an execution-space instance of its own: instances/solver.cpp, for each backend.
template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& parameters, const linear::RankGroup& group);

std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters,
                                      const linear::RankGroup& group) {
  return device::allocate([&] {
    return device::dispatch(
        backend, [&]<class ExecutionSpace>() { return make_solver<ExecutionSpace>(parameters, group); });
  });
}

}  // namespace drogue::coupling
