#pragma once

#include "perf/clocks/gpu_clocks.hpp"

namespace drogue::perf {

/// Clocks of the GPU of this process; without readings where there is none. Requires an initialised runtime.
/// Does not throw.
[[nodiscard]] const GpuClocks& device_clocks();

}  // namespace drogue::perf
