#pragma once

#include "perf/ladders/options/one_thread.hpp"

namespace drogue::perf::ladder {

/// Rung 2. The same with the options of a node side by side: neighbouring threads of a GPU read neighbouring
/// numbers. A thread of a host now jumps through memory.
///
/// Prediction: none, since the model counts the bytes that are used, and these are the same.
template <class ExecutionSpace>
Rung interleaved_rung(const Shared<OptionsProblem>& problem) {
  return make_rung<OneThreadRung<ExecutionSpace, Kokkos::LayoutLeft>>(
      RungText{"interleaved", "The options of a node side by side, for neighbouring threads.",
               "On a host this rung loses, since a thread fetches a line of memory per node and uses one "
               "number of it. On a GPU it is the layout that neighbouring threads need. On an H100 it "
               "takes 11302 us, after 43454 us; the model has 227 us for both (docs/lessons/tables.md)."},
      options_work(*problem, 1, 40), problem);
}

}  // namespace drogue::perf::ladder
