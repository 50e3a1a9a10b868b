#pragma once

#include <cstdint>

namespace drogue::device {

/// Counts of device operations since `start_profiling`, taken in Kokkos Tools callbacks.
struct ProfilingCounters {
  std::int64_t kernel_launches = 0;  ///< a graph launch counts as one
  std::int64_t fences = 0;
  std::int64_t allocations = 0;
  std::int64_t h2d_bytes = 0;  ///< host to device; zero on host backends
  std::int64_t d2h_bytes = 0;
  std::int64_t copies = 0;        ///< deep copies of any kind
  std::int64_t device_bytes = 0;  ///< currently allocated by labelled Views of any memory space
  std::int64_t peak_device_bytes = 0;
  std::int64_t allocations_after_warmup = 0;
};

/// Installs the callbacks and keeps those of loaded Kokkos Tools, which are called first. Call it after the
/// construction of `Runtime`; later calls have no effect. Does not throw.
void start_profiling();

/// Counts later allocations as `allocations_after_warmup`. Does not throw.
void end_warmup();

/// Current counts. Does not block and does not throw.
[[nodiscard]] ProfilingCounters profiling_counters();

/// Counts a launch without a callback: of a captured graph or a persistent kernel. Does not throw.
void count_launch();

}  // namespace drogue::device
