#pragma once

#include "perf/ladders/weno/direct_flux.hpp"
#include "perf/ladders/weno/stage_kernel.hpp"

namespace drogue::perf::ladder {

/// Rung 3. Fluxes and update of a stage in one kernel. A team keeps the fluxes of its tile in scratch memory;
/// two tiles compute their common face twice.
///
/// Prediction: three launches per step instead of six, and 9 numbers per cell and stage instead of 18: state
/// and U^n in, state out. One face in 128 is computed twice.
template <class ExecutionSpace>
Rung fused_stages_rung(const Shared<WenoProblem>& problem) {
  return make_rung<StageRung<ExecutionSpace, DirectFlux>>(
      RungText{"fused-stages", "Fluxes stay in scratch memory: one kernel per stage.",
               "On a host less traffic gains little, as predicted, where arithmetic is the bound. On a "
               "GPU half of the launches go, which decides below 100 000 cells."},
      stage_work(*problem, 1, 9, DirectFlux::arithmetic), problem, "drogue::perf::ladder::fused_stages");
}

}  // namespace drogue::perf::ladder
