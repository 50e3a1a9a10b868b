#pragma once

#include "kernels/device/profiling_counters.hpp"

namespace drogue::testing {

/// Counters of a test program. The first call in the program starts them: the callbacks are installed once.
inline device::ProfilingCounters profiled() {
  static const bool started = (device::start_profiling(), true);
  static_cast<void>(started);
  return device::profiling_counters();
}

}  // namespace drogue::testing
