#pragma once

#include "perf/ladders/transfers/transfer_rung.hpp"

namespace drogue::perf::ladder {

/// Page-locked memory, a base that outlives the values in it.
template <class ExecutionSpace>
struct PinnedValues {
  device::PinnedMemory<ExecutionSpace> pinned;
};

/// Rung 2. The same in page-locked memory, which the device reads and writes directly.
///
/// Prediction: two copies at the bandwidth of page-locked memory. A host backend has one kind of memory.
template <class ExecutionSpace>
class PinnedRung : private PinnedValues<ExecutionSpace>, public TransferRung<ExecutionSpace> {
 public:
  static constexpr RungText text{
      "pinned", "Page-locked memory, which the device reads without a staging copy.",
      "On a host nothing changes but the order in which the rungs are measured: a difference "
      "here is noise, and a measure of it. On an H100 the prediction holds: 1207 us, after 6229 "
      "us, where the model has 1238 us (docs/lessons/tables.md)."};

  static Work work(const TransferProblem& problem) {
    Work work = transfer_work(problem, 1, 2, 2);
    work.pinned = true;
    return work;
  }

  explicit PinnedRung(const TransferProblem& problem)
      : TransferRung<ExecutionSpace>(problem, &this->pinned) {}
};

}  // namespace drogue::perf::ladder
