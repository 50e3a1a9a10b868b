#pragma once

#include "perf/ladders/options/scratch.hpp"

namespace drogue::perf::ladder {

/// Sums of jumps to several nodes at once: each value is loaded once and multiplied by as many weights, whose
/// sums stay in registers. On a host the sums of a block fill vector registers.
template <int size>
struct BlockedJumps {
  static constexpr int block = size;

  template <class Weights, class V>
  KOKKOS_FUNCTION static void sum(const Weights& weights, const V& v, int i, double (&jumped)[block]) {
    double sums[block] = {};  // the last node first: neighbouring sums take neighbouring weights
    for (int j = 0; j < option_nodes; ++j) {
      const double value = v(j);
      const int first = j - (i + block - 1) + option_nodes - 1;
      for (int b = 0; b < block; ++b) sums[b] += weights(first + b) * value;
    }
    for (int b = 0; b < block; ++b) jumped[b] = sums[block - 1 - b];
  }
};

/// Rung 5. A warp per option with four nodes per thread in registers; 32 nodes per block on a host.
///
/// Prediction: on a host divided by the lanes of a pack, since the sums of a block are independent. On a GPU
/// none: the model has no loads from shared memory.
template <class ExecutionSpace,
          class Jumps = BlockedJumps<device::is_host<ExecutionSpace> ? 32 : option_nodes / 32>>
Rung registers_rung(const Shared<OptionsProblem>& problem) {
  Work work = scratch_rung<ExecutionSpace>(problem).work;
  work.packed = true;
  return make_rung<TeamRung<ExecutionSpace, Jumps, true>>(
      RungText{"registers", "Sums of several nodes in registers: a load serves them all.",
               "On a host 3.60 to 3.72 times as fast, 6.71 to 6.72 predicted: independent sums end the "
               "chains of additions and fill packs, but the solve, one chain of divisions per option, "
               "stays and is now a large part of the time. On an H100 1133 us, after 1536 us, though the "
               "model has 148 us for both: it does not count the loads from shared memory that registers "
               "save (docs/lessons/tables.md)."},
      work, problem, "drogue::perf::ladder::registers", 32);
}

}  // namespace drogue::perf::ladder
