#pragma once

#include <memory>
#include <memory_resource>

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

}  // namespace drogue::perf
