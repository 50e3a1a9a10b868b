#pragma once

#include "perf/ladders/springs/arrays.hpp"

namespace drogue::perf::ladder {

/// The inverse area alone is kept besides the lengths at rest; `Tension` computes tensions from them.
template <class Tension>
struct RecomputedSprings {
  static constexpr int numbers = 1;

  static void set(const SpringProblem&, const VertexTriangle& t, double* w) { *w = inverse_area(t); }
  KOKKOS_FUNCTION static Tensions tensions(const EdgeChanges& change, const double* rest, const double* w,
                                           double two_lambda_mu, double mu) {
    return Tension::tensions(change, rest, *w, two_lambda_mu, mu);
  }
};

template <class ExecutionSpace, class Tension>
using RecomputedRung = SpringRung<ExecutionSpace, SheetOfArrays<ExecutionSpace, RecomputedSprings<Tension>>>;

/// Rung 3. Arithmetic is cheaper than memory: four stored numbers per triangle instead of eight.
///
/// Prediction: two thirds of the bytes, two fifths more operations.
template <class ExecutionSpace, class Tension = RecomputedTension>
Rung recomputed_rung(const Shared<SpringProblem>& problem) {
  return make_rung<RecomputedRung<ExecutionSpace, Tension>>(
      RungText{"recomputed", "Stiffnesses are recomputed from lengths and area at rest.",
               "The model weighs bytes against operations, but neither is the bound: the time is that of "
               "waiting for loads, of which there are fewer. On a host 1.05 to 1.07 times as fast, 1.39 "
               "predicted. At a million vertices on a GPU bytes are the bound, and fewer stored numbers "
               "decide (docs/springs-notebook.md)."},
      spring_work(*problem, 1, 4, recomputed_operations), problem, &SpringProblem::scattered);
}

}  // namespace drogue::perf::ladder
