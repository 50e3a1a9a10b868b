#pragma once

#include <cstdint>

namespace drogue::device {

/// What a run asked of the device, counted through Kokkos Tools callbacks from `start_profiling` on.
struct ProfilingCounters {
  std::int64_t kernel_launches = 0;  ///< a replayed graph counts as one
  std::int64_t fences = 0;
  std::int64_t allocations = 0;
  std::int64_t h2d_bytes = 0;  ///< host to device; zero on host backends, where nothing moves
  std::int64_t d2h_bytes = 0;
  std::int64_t copies = 0;        ///< deep copies of any kind
  std::int64_t device_bytes = 0;  ///< allocated now, labelled Views of any space
  std::int64_t peak_device_bytes = 0;
  std::int64_t allocations_after_warmup = 0;
};

/// Installs the callbacks; tools loaded by Kokkos keep theirs and are called first. Call it after
/// `Runtime`; later calls have no effect.
void start_profiling();

/// From here on allocations count as `allocations_after_warmup`.
void end_warmup();

[[nodiscard]] ProfilingCounters profiling_counters();

/// A launch that no callback sees: of a recorded graph, or of a persistent kernel.
void count_launch();

}  // namespace drogue::device
