#include "perf/ladders/options/interleaved.hpp"
#include "perf/ladders/options/matrix_product.hpp"
#include "perf/ladders/options/one_team.hpp"
#include "perf/ladders/options/one_thread.hpp"
#include "perf/ladders/options/registers.hpp"
#include "perf/ladders/options/scratch.hpp"

namespace drogue::perf::ladder {

/// Rungs of the options ladder in order. Throws std::bad_alloc.
template <class ExecutionSpace>
Ladder make_options(bool small) {
  const int options = small ? 5 : device::is_host<ExecutionSpace> ? 64 : 4096;
  const auto problem = std::make_shared<const OptionsProblem>(make_options_problem(options));
  return {.name = "options",
          .unit = "batch",
          .problem = "European puts under jumps of normal logarithms, 128 nodes and 32 implicit steps",
          .size = options,
          .units = 1,
          .rungs = {one_thread_rung<ExecutionSpace>(problem), interleaved_rung<ExecutionSpace>(problem),
                    one_team_rung<ExecutionSpace>(problem), scratch_rung<ExecutionSpace>(problem),
                    registers_rung<ExecutionSpace>(problem), matrix_product_rung<ExecutionSpace>(problem)}};
}

Ladder options_ladder(device::Backend backend, bool small) {
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return make_options<ExecutionSpace>(small); });
}

}  // namespace drogue::perf::ladder
