#pragma once

#include "perf/ladders/weno/differences.hpp"

namespace drogue::perf::ladder {

/// Rung 4 of the WENO ladder on packs of cells on a host, in which a division takes several times as long as
/// in numbers.
template <class ExecutionSpace, class Flux = DifferenceFlux>
Rung packed_differences_rung(const Shared<WenoProblem>& problem) {
  Rung rung = differences_rung<ExecutionSpace>(problem);
  rung.work.packed = true;
  rung.make = run_of<StageRung<ExecutionSpace, Flux, Packed<ExecutionSpace>>>(
      problem, "drogue::perf::ladder::packed_differences");
  return rung;
}

}  // namespace drogue::perf::ladder
