#pragma once

#include "perf/ladders/springs/fabric_rung.hpp"

namespace drogue::perf::ladder {

/// Rung 6, GPU only: the kernels of a step are captured once into a CUDA graph.
///
/// Prediction: one launch per step instead of four.
template <class ExecutionSpace>
Rung graph_rung(const Shared<SpringProblem>& problem) {
  return on_gpu<ExecutionSpace>(make_rung<FabricRung<ExecutionSpace>>(
      RungText{"graph", "The kernels of a step as one CUDA graph.",
               "On an H100 the graph gains little: 13.8 us, after 14.4 us without it, where the model "
               "has 22.2 us, after 35.6 us. The model counts a launch at the time of an empty one alone, "
               "and has no caches, which hold this mesh (docs/lessons/tables.md)."},
      ring_work(*problem, 0.25), problem, fabric::Driver::graph));
}

}  // namespace drogue::perf::ladder
