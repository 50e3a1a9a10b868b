#pragma once

#include "perf/ladders/weno/library_rung.hpp"

namespace drogue::perf::ladder {

/// Rung 7. All stages of a step in one kernel (kernels/gas/stepping/step.hpp): a tile loads nine ghosts per
/// side and recomputes what its neighbours compute. From here on rungs run the library's solver, which also
/// chooses tiles, tests every state for admissibility and reduces wave speeds for the next step.
///
/// Prediction: memory traffic falls from 27 to 6 numbers per cell and step, three launches become two (a
/// step, and the kernel that accepts it), for 5 % more faces.
template <class ExecutionSpace>
Rung fused_step_rung(const Shared<WenoProblem>& problem) {
  return make_rung<LibraryRung<ExecutionSpace>>(
      RungText{"fused-step", "All stages of a step in one kernel; ghosts are recomputed.",
               "On a host 1.05 to 1.18 times as fast although it does more than the rungs before (it "
               "tests every state and reduces wave speeds): it computes roots and divisions of many "
               "faces first, so that they overlap, and differences once for all faces that share them."},
      library_work(*problem, 2), problem, gas::Driver::plain);
}

}  // namespace drogue::perf::ladder
