#pragma once

#include "perf/ladders/weno/one_division.hpp"

namespace drogue::perf::ladder {

/// Rung 6. Use the registers. On a GPU launch bounds cap the registers of a thread (128 threads, five teams
/// per multiprocessor: 96 registers), so that more warps hide each other's latency. A core of a host has one
/// thread: there the wide registers hold a pack of cells, one per lane.
///
/// Prediction: on a host divided by the lanes of a pack. The model of a GPU has no registers: no change.
template <class ExecutionSpace>
Rung registers_rung(const Shared<WenoProblem>& problem) {
  using Run = StageRung<ExecutionSpace, OneDivisionFlux, Packed<ExecutionSpace>,
                        Kokkos::LaunchBounds<tile_threads, 5>>;
  Work work = one_division_rung<ExecutionSpace>(problem).work;
  work.packed = true;
  return make_rung<Run>(
      RungText{"registers", "Launch bounds on a GPU, packs of cells on a host.",
               "On a host 3.28 to 3.61 times as fast with eight lanes, 4.53 to 4.57 predicted: six packs "
               "of seven numbers overlap for every face and are loaded again for the next. The division "
               "of a pack takes longer than that of a number, which the model has. On an H100 this rung "
               "loses: 15.3 us, after 14.2 us, for at 8192 cells no multiprocessor has a second team "
               "that fewer registers could admit (docs/lessons/tables.md)."},
      work, problem, "drogue::perf::ladder::registers");
}

}  // namespace drogue::perf::ladder
