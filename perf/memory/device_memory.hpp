#pragma once

#include <cstdint>

namespace drogue::perf {

/// Bytes of GPU memory that are in use, by this process and others, as the driver counts them: with the work
/// areas of libraries, and in its units of 2 MiB. 0 in builds without CUDA. Requires an initialised runtime.
/// Throws std::runtime_error if the driver fails.
[[nodiscard]] std::int64_t used_device_memory();

}  // namespace drogue::perf
