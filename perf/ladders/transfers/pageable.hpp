#pragma once

#include "perf/ladders/transfers/transfer_rung.hpp"

namespace drogue::perf::ladder {

/// Rung 1. The host owns the values in ordinary memory: each step copies them to the device, computes, and
/// copies them back. The driver stages ordinary memory, whose pages may move, through a buffer of its own.
///
/// Prediction: two copies of all values at the bandwidth of ordinary memory, then the kernel.
template <class ExecutionSpace>
Rung pageable_rung(const Shared<TransferProblem>& problem) {
  return make_rung<TransferRung<ExecutionSpace>>(
      RungText{"pageable", "Values on the host in ordinary memory: up, compute, down, at every step.",
               "On a host the copies are memcpy, and all takes 0.89 to 0.91 times the prediction, since "
               "the last cache holds the values. On a GPU pageable memory costs 46 % of the time of the "
               "WENO port at 8192 cells (docs/transfers.md). On an H100 this rung takes 6229 us where "
               "the model has 4611 us (docs/lessons/tables.md)."},
      transfer_work(*problem, 1, 2, 2), problem, ValueMemory::pageable);
}

}  // namespace drogue::perf::ladder
