#include "perf/ladders/springs/arrays.hpp"
#include "perf/ladders/springs/graph.hpp"
#include "perf/ladders/springs/packets.hpp"
#include "perf/ladders/springs/recomputed.hpp"
#include "perf/ladders/springs/renumbered.hpp"
#include "perf/ladders/springs/rings.hpp"
#include "perf/ladders/springs/structs.hpp"

namespace drogue::perf::ladder {

/// Rungs of the spring ladder in order. Throws std::bad_alloc.
template <class ExecutionSpace>
Ladder make_springs(bool small) {
  const bool host = device::is_host<ExecutionSpace>;
  const int vertices = small ? 400 : host ? 20'000 : 30'000;
  const long steps = small ? 8 : host ? 4 : 20;
  const auto problem = std::make_shared<const SpringProblem>(make_spring_problem(vertices, steps));
  return {.name = "springs",
          .unit = "step",
          .problem = "a stretched sheet of biquadratic springs by Runge-Kutta steps",
          .size = static_cast<std::int64_t>(problem->renumbered.vertices()),
          .units = steps,
          .rungs = {structs_rung<ExecutionSpace>(problem), arrays_rung<ExecutionSpace>(problem),
                    recomputed_rung<ExecutionSpace>(problem), renumbered_rung<ExecutionSpace>(problem),
                    rings_rung<ExecutionSpace>(problem), graph_rung<ExecutionSpace>(problem),
                    packets_rung<ExecutionSpace>(problem)}};
}

Ladder springs_ladder(device::Backend backend, bool small) {
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return make_springs<ExecutionSpace>(small); });
}

}  // namespace drogue::perf::ladder
