#pragma once

#include "perf/ladders/options/problem.hpp"

#include <Kokkos_Core.hpp>

namespace drogue::perf::ladder {

/// Exercise `sums`, from rung 4 to rung 5 of the options ladder: sums w_{j-i} v_j over jumps from node i to
/// all nodes j, of one node at a time. Each sum is a chain of additions that wait for one another, and each
/// v_j is loaded for one product. Sum for a block of nodes i, i + 1, ... at once; `block` divides 128, and on
/// a GPU, on which 32 threads share the nodes, it is at most 4.
struct SumsExercise {
  static constexpr int block = 1;

  /// `jumped[b]`: the sum of node i + b.
  template <class Weights, class V>
  KOKKOS_FUNCTION static void sum(const Weights& weights, const V& v, int i, double (&jumped)[block]) {
    jumped[0] = 0.0;
    for (int j = 0; j < option_nodes; ++j) jumped[0] += weights(j - i + option_nodes - 1) * v(j);
  }
};

}  // namespace drogue::perf::ladder
