#pragma once

#include "perf/ladders/weno/library_rung.hpp"

namespace drogue::perf::ladder {

/// Rung 9, GPU only: one launch takes all steps. The state stays in shared memory; tiles exchange halos by
/// messages that carry their step (kernels/gas/stepping/persistent_step.hpp).
///
/// Prediction: one launch for all steps, and no memory traffic to speak of; arithmetic remains.
template <class ExecutionSpace>
Rung persistent_rung(const Shared<WenoProblem>& problem) {
  return on_gpu<ExecutionSpace>(make_rung<LibraryRung<ExecutionSpace>>(
      RungText{"persistent", "One launch for all steps; the state stays in shared memory.",
               "The model omits waiting: on an H200 two of five microseconds per step pass until the "
               "fastest signal of all teams has arrived (docs/gas-notebook.md). On an H100 at 8192 cells "
               "a step takes 5.25 us where the model has 0.612 us (docs/lessons/tables.md)."},
      library_work(*problem, 1.0 / static_cast<double>(problem->steps)), problem, gas::Driver::persistent));
}

}  // namespace drogue::perf::ladder
