#include "perf/ladders/transfers/crumbs.hpp"
#include "perf/ladders/transfers/one_upload.hpp"
#include "perf/ladders/transfers/overlapped.hpp"
#include "perf/ladders/transfers/pageable.hpp"
#include "perf/ladders/transfers/pinned.hpp"

namespace drogue::perf::ladder {

/// Rungs of the transfer ladder in order. Throws std::bad_alloc.
template <class ExecutionSpace>
Ladder make_transfers(bool small) {
  const bool host = device::is_host<ExecutionSpace>;
  // Not a multiple of the numbers of chunks.
  const std::size_t values = small ? 5003 : host ? 300'007 : 4'000'103;
  const long steps = small ? 3 : 10;
  const auto problem = std::make_shared<const TransferProblem>(make_transfer_problem(values, steps));
  return {
      .name = "transfers",
      .unit = "step",
      .problem = host ? "x <- 1 / (1 + x); copies within the host are memcpy, and all of its memory is alike"
                      : "x <- 1 / (1 + x) of values that the host owns",
      .size = static_cast<std::int64_t>(values),
      .units = steps,
      .rungs = {pageable_rung<ExecutionSpace>(problem), pinned_rung<ExecutionSpace>(problem),
                overlapped_rung<ExecutionSpace>(problem), crumbs_rung<ExecutionSpace>(problem),
                one_upload_rung<ExecutionSpace>(problem)}};
}

Ladder transfers_ladder(device::Backend backend, bool small) {
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return make_transfers<ExecutionSpace>(small); });
}

}  // namespace drogue::perf::ladder
