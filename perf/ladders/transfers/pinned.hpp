#pragma once

#include "perf/ladders/transfers/transfer_rung.hpp"

namespace drogue::perf::ladder {

/// Rung 2. The same in page-locked memory, which the device reads and writes directly.
///
/// Prediction: two copies at the bandwidth of page-locked memory. A host backend has one kind of memory.
template <class ExecutionSpace>
Rung pinned_rung(const Shared<TransferProblem>& problem) {
  Work work = transfer_work(*problem, 1, 2, 2);
  work.pinned = true;
  return make_rung<TransferRung<ExecutionSpace>>(
      RungText{"pinned", "Page-locked memory, which the device reads without a staging copy.",
               "On a host nothing changes but the order in which the rungs are measured: a difference "
               "here is noise, and a measure of it. On an H100 the prediction holds: 1207 us, after 6229 "
               "us, where the model has 1238 us (docs/lessons/tables.md)."},
      work, problem, ValueMemory::pinned);
}

}  // namespace drogue::perf::ladder
