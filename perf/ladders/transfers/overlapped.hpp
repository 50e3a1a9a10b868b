#pragma once

#include <algorithm>

#include "perf/ladders/transfers/transfer_rung.hpp"

namespace drogue::perf::ladder {

/// Division of values into contiguous chunks of nearly equal length.
struct Chunks {
  /// Calls `enqueue(chunk, first, count)` for at most `chunks` parts of `values` values.
  template <class Enqueue>
  static void for_each(std::size_t values, std::size_t chunks, const Enqueue& enqueue) {
    const std::size_t most = (values + chunks - 1) / chunks;
    for (std::size_t chunk = 0; chunk * most < values; ++chunk)
      enqueue(chunk, chunk * most, std::min(most, values - chunk * most));
  }
};

/// Runs by chunks on two streams in turn.
template <class ExecutionSpace, class Division = Chunks>
class OverlappedRung final : public TransferRung<ExecutionSpace> {
 public:
  OverlappedRung(const TransferProblem& problem, std::size_t chunks)
      : TransferRung<ExecutionSpace>(problem), _chunks(chunks) {}

 protected:
  void step() override {
    const ExecutionSpace* const streams[] = {&this->_instance.space(), &_second.space()};
    Division::for_each(this->_host.size(), _chunks,
                       [&](std::size_t chunk, std::size_t first, std::size_t count) {
                         this->enqueue(*streams[chunk % 2], first, count);
                       });
    for (const ExecutionSpace* stream : streams)
      stream->fence("drogue::perf::ladder: chunks are on the host");
  }

 private:
  std::size_t _chunks;
  device::Instance<ExecutionSpace> _second{std::numeric_limits<int>::max()};
};

/// Work per step in so many chunks. Does not throw.
inline Work overlapped_work(const TransferProblem& problem, int chunks) {
  Work work = transfer_work(problem, chunks, 2 * chunks, 2);
  work.pinned = work.overlapped = true;
  return work;
}

/// Rung 3. Chunks on two streams in turn: while one is computed, another is copied, in both directions at
/// once.
///
/// Prediction: the longer one of copies and kernels. The copies of a step still move all values twice.
template <class ExecutionSpace, class Division = Chunks>
Rung overlapped_rung(const Shared<TransferProblem>& problem) {
  constexpr int chunks = 8;
  return make_rung<OverlappedRung<ExecutionSpace, Division>>(
      RungText{"overlapped", "Eight chunks on two streams: copies beside kernels.",
               "On a host nothing overlaps: a chunk is copied, computed and copied back by the same "
               "core. On one core it gains by caches, which hold a chunk but not all values: 1.25 times "
               "as fast; on two threads nothing changes. On an H100 809 us, after 1207 us, where the "
               "model has 1301 us and no gain: it adds copies up to copies down, which run at once "
               "(docs/lessons/tables.md)."},
      overlapped_work(*problem, chunks), problem, chunks);
}

}  // namespace drogue::perf::ladder
