#include "perf/ceilings/ceilings.hpp"

namespace drogue::perf {

// Defined in ceilings_impl.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
bool supports_ceiling(Ceiling ceiling);
template <class ExecutionSpace>
std::unique_ptr<CeilingKernel> make_ceiling(Ceiling ceiling);

bool has_ceiling(device::Backend backend, Ceiling ceiling) {
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return supports_ceiling<ExecutionSpace>(ceiling); });
}

std::unique_ptr<CeilingKernel> create_ceiling(device::Backend backend, Ceiling ceiling) {
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return make_ceiling<ExecutionSpace>(ceiling); });
}

}  // namespace drogue::perf
