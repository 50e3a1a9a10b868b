#pragma once

#include <cstdint>
#include <memory>
#include <memory_resource>
#include <string>

#include "kernels/device/backend.hpp"

namespace drogue::perf {

/// Kind of memory of the host from which a device copies.
enum class HostMemory { pageable, pinned };

/// "pageable" or "pinned". Does not throw.
[[nodiscard]] constexpr const char* name(HostMemory memory) {
  return memory == HostMemory::pinned ? "pinned" : "pageable";
}

/// Memory for arrays that are copied to and from a backend; ordinary memory for a host backend. Requires an
/// initialised runtime. Throws std::bad_alloc; its allocations throw what Kokkos::kokkos_malloc throws.
[[nodiscard]] std::shared_ptr<std::pmr::memory_resource> host_memory(device::Backend backend,
                                                                     HostMemory memory);

/// Bytes of GPU memory that are in use, by this process and others, as the driver counts them: with the work
/// areas of libraries, and in its units of 2 MiB. 0 in builds without CUDA. Requires an initialised runtime.
/// Throws std::runtime_error if the driver fails.
[[nodiscard]] std::int64_t used_device_memory();

/// Number of GPUs that this process sees; 0 in builds without CUDA. Does not throw.
[[nodiscard]] int device_count();

/// PCI address of the GPU of this process, such as "0000:19:00.0"; empty in builds without CUDA, or if the
/// driver does not state it. Requires an initialised runtime. Does not throw.
[[nodiscard]] std::string device_address();

}  // namespace drogue::perf
