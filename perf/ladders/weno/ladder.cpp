#include "perf/ladders/weno/fused_stages.hpp"
#include "perf/ladders/weno/fused_step.hpp"
#include "perf/ladders/weno/graph.hpp"
#include "perf/ladders/weno/on_device.hpp"
#include "perf/ladders/weno/one_division.hpp"
#include "perf/ladders/weno/persistent.hpp"
#include "perf/ladders/weno/port.hpp"
#include "perf/ladders/weno/registers.hpp"
#include "perf/ladders/weno/split_precision.hpp"

namespace drogue::perf::ladder {

/// Rungs of the WENO ladder in order. Throws std::bad_alloc.
template <class ExecutionSpace>
Ladder make_weno(bool small) {
  const bool host = device::is_host<ExecutionSpace>;
  const std::int64_t cells = small ? 512 : host ? 4096 : 8192;
  const long steps = small ? 6 : host ? 10 : 50;
  const auto problem = std::make_shared<const WenoProblem>(make_weno_problem(cells, steps));
  return {.name = "weno",
          .unit = "step",
          .problem = "Sod's shock tube by WENO5-JS and SSP-RK3 with steps of one size",
          .size = cells,
          .units = steps,
          .rungs = {port_rung<ExecutionSpace>(problem), on_device_rung<ExecutionSpace>(problem),
                    fused_stages_rung<ExecutionSpace>(problem), differences_rung<ExecutionSpace>(problem),
                    one_division_rung<ExecutionSpace>(problem), registers_rung<ExecutionSpace>(problem),
                    fused_step_rung<ExecutionSpace>(problem), graph_rung<ExecutionSpace>(problem),
                    persistent_rung<ExecutionSpace>(problem), split_precision_rung<ExecutionSpace>(problem)}};
}

Ladder weno_ladder(device::Backend backend, bool small) {
  return device::dispatch(backend, [&]<class ExecutionSpace>() { return make_weno<ExecutionSpace>(small); });
}

}  // namespace drogue::perf::ladder
