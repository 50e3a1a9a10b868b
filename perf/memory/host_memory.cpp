#include "perf/memory/host_memory.hpp"

#include <Kokkos_Core.hpp>

#include "kernels/device/pinned_memory.hpp"

namespace drogue::perf {

std::shared_ptr<std::pmr::memory_resource> host_memory(device::Backend backend, HostMemory memory) {
#if defined(KOKKOS_ENABLE_CUDA)
  if (backend == device::Backend::cuda && memory == HostMemory::pinned)
    return std::make_shared<device::PinnedMemory<Kokkos::Cuda>>();
#else
  static_cast<void>(backend), static_cast<void>(memory);
#endif
  // Not owned: it lives as long as the program.
  return {std::shared_ptr<void>(), std::pmr::new_delete_resource()};
}

}  // namespace drogue::perf
