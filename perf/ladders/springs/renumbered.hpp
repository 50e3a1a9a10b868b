#pragma once

#include "perf/ladders/springs/recomputed.hpp"

namespace drogue::perf::ladder {

/// Rung 4. Vertices in the order of Cuthill and McKee: those of neighbours lie beside one another, so that a
/// line of memory that one thread fetched serves the next.
///
/// Prediction: none, since the model takes loads of neighbours for free.
template <class ExecutionSpace>
Rung renumbered_rung(const Shared<SpringProblem>& problem) {
  return make_rung<RecomputedRung<ExecutionSpace, RecomputedTension>>(
      RungText{"renumbered", "Neighbours lie beside one another in memory.",
               "A gain that the model does not predict, on a host 1.24 to 1.29 times as fast: neighbours "
               "share lines of memory, so that fewer loads wait. The larger the mesh, the more it is."},
      recomputed_rung<ExecutionSpace>(problem).work, problem, &SpringProblem::renumbered);
}

}  // namespace drogue::perf::ladder
