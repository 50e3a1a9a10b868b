#pragma once

#include "perf/ladders/transfers/overlapped.hpp"

namespace drogue::perf::ladder {

/// Rung 4, which loses on a GPU: more overlap by 512 chunks. Each copy has a latency that its bytes must
/// outlast.
///
/// Prediction: 1024 copies per step, each at the latency of a copy of a few bytes.
template <class ExecutionSpace>
Rung crumbs_rung(const Shared<TransferProblem>& problem) {
  constexpr int chunks = 512;
  return make_rung<OverlappedRung<ExecutionSpace>>(
      RungText{"crumbs", "512 chunks: the latency of copies.",
               "This rung loses on a host as well: hundreds of launches and small copies cost more than "
               "the bytes. The model has their latency and predicts the loss. On an H100 it loses: 5304 "
               "us, after 809 us, but less than pageable memory takes, 6229 us. The model has 7634 us: "
               "it waits for the end of each copy, which this rung does not (docs/lessons/tables.md)."},
      overlapped_work(*problem, chunks), problem, chunks);
}

}  // namespace drogue::perf::ladder
