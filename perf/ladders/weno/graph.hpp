#pragma once

#include "perf/ladders/weno/library_rung.hpp"

namespace drogue::perf::ladder {

/// Rung 8, GPU only: the kernels of a step are captured once into a CUDA graph, which is launched per step.
///
/// Prediction: one launch per step instead of two.
template <class ExecutionSpace>
Rung graph_rung(const Shared<WenoProblem>& problem) {
  return on_gpu<ExecutionSpace>(make_rung<LibraryRung<ExecutionSpace>>(
      RungText{"graph", "The kernels of a step as one CUDA graph.",
               "On an H100 at 8192 cells a step takes 9.97 us where the model has 5.10 us, for it has "
               "launches but neither the latency of loads nor chains of operations. The graph takes 1.90 "
               "times as long as the persistent kernel, 5.25 us (docs/lessons/tables.md)."},
      library_work(*problem, 1), problem, gas::Driver::graph));
}

}  // namespace drogue::perf::ladder
