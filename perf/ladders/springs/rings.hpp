#pragma once

#include "perf/ladders/springs/fabric_rung.hpp"

namespace drogue::perf::ladder {

/// Rung 5. The solver of the library (kernels/fabric/stepping/rk4.hpp): rings of neighbours share the edges
/// of their triangles, in sliced ELLPACK rows. It also tests the state for divergence.
///
/// Prediction: one number less per triangle, a third of the edges less to compute, and packs on a host.
template <class ExecutionSpace>
Rung rings_rung(const Shared<SpringProblem>& problem) {
  return make_rung<FabricRung<ExecutionSpace>>(
      RungText{"rings", "Triangles around a vertex share their edges: the library's kernel.",
               "By far the largest gain, on a host to 1.12 to 1.25 times the prediction: the library "
               "computes packs of vertices from sliced rows, so that a host reads neighbouring numbers "
               "at once, as the arrays of rung 2 were meant to be read."},
      ring_work(*problem, 1), problem, fabric::Driver::plain);
}

}  // namespace drogue::perf::ladder
