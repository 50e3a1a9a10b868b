#pragma once

#include "perf/ladders/options/problem.hpp"

#include <Kokkos_Core.hpp>

namespace drogue::perf::ladder {

/// Exercise `jumps`, a fault in rung 5 of the options ladder: sums w_{j-i} v_j over jumps from node i to all
/// nodes j, four at once. Prices of jumps of either sign alike would be right.
struct JumpsExercise {
  static constexpr int block = 4;

  template <class Weights, class V>
  KOKKOS_FUNCTION static void sum(const Weights& weights, const V& v, int i, double (&jumped)[block]) {
    for (double& node : jumped) node = 0.0;
    for (int j = 0; j < option_nodes; ++j)
      for (int b = 0; b < block; ++b) jumped[b] += weights(i + b - j + option_nodes - 1) * v(j);
  }
};

}  // namespace drogue::perf::ladder
