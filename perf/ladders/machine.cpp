#include "perf/ladders/ladder.hpp"

namespace drogue::perf::ladder {

// Defined in machine.hpp, instantiated for each backend in instances/.
template <class ExecutionSpace>
Ceilings make_ceilings();

Ceilings measure_ceilings(device::Backend backend) {
  return device::dispatch(backend, []<class ExecutionSpace>() { return make_ceilings<ExecutionSpace>(); });
}

}  // namespace drogue::perf::ladder
