#pragma once

#include "perf/ladders/springs/fabric_rung.hpp"

namespace drogue::perf::ladder {

/// Rung 7, GPU only: one launch takes all steps. Patches of vertices stay in shared memory and exchange their
/// halos by messages of value and tag, without a barrier (kernels/fabric/stepping/persistent_steps.hpp).
///
/// Prediction: one launch for all steps, no memory traffic to speak of; arithmetic remains.
template <class ExecutionSpace>
Rung packets_rung(const Shared<SpringProblem>& problem) {
  Work work = ring_work(*problem, 0.25 / static_cast<double>(problem->steps));
  work.bytes = 0.0;
  return on_gpu<ExecutionSpace>(make_rung<FabricRung<ExecutionSpace>>(
      RungText{"packets", "One launch for all steps; patches exchange tagged messages.",
               "Left over is the latency of messages between patches, which the model omits "
               "(docs/springs-notebook.md). On an H100 8.38 us where the model has 1.44 us "
               "(docs/lessons/tables.md)."},
      work, problem, fabric::Driver::persistent));
}

}  // namespace drogue::perf::ladder
