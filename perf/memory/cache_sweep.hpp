#pragma once

#include <cstdint>
#include <functional>

namespace drogue::perf {

/// Function that reads a buffer of `bytes`, of the device or by all threads of the host, so that caches of
/// half the size keep no data of other work. The buffer is not written, so that nothing waits to be written
/// back. Blocking; returns the number of sectors of 32 bytes that it has read. Requires an initialised
/// runtime, also when the function is destroyed. Throws std::invalid_argument for a device in builds without
/// CUDA.
[[nodiscard]] std::function<std::int64_t()> create_cache_sweep(bool on_device, std::int64_t bytes);

}  // namespace drogue::perf
