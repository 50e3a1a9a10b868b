#include "perf/measure/device_clocks.hpp"

#include "perf/memory/device_memory.hpp"

namespace drogue::perf {

const GpuClocks& device_clocks() {
  static const GpuClocks clocks(device_address());
  return clocks;
}

}  // namespace drogue::perf
