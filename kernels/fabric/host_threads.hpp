#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/device/host_cores.hpp"

namespace drogue::fabric {

/// Number of host threads for that many vertices. Does not throw.
inline int host_threads(std::size_t vertices) {
  return device::useful_threads(static_cast<std::int64_t>(vertices), 512);
}

}  // namespace drogue::fabric
