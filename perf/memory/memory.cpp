#include "perf/memory/memory.hpp"

#include <Kokkos_Core.hpp>
#include <stdexcept>

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

std::int64_t used_device_memory() {
#if defined(KOKKOS_ENABLE_CUDA)
  std::size_t free = 0, total = 0;
  if (const cudaError_t error = cudaMemGetInfo(&free, &total); error != cudaSuccess)
    throw std::runtime_error(cudaGetErrorString(error));
  return static_cast<std::int64_t>(total - free);
#else
  return 0;
#endif
}

int device_count() {
#if defined(KOKKOS_ENABLE_CUDA)
  int count = 0;
  if (cudaGetDeviceCount(&count) == cudaSuccess) return count;
#endif
  return 0;
}

std::string device_address() {
#if defined(KOKKOS_ENABLE_CUDA)
  int device = 0;
  char address[32] = "";
  if (cudaGetDevice(&device) == cudaSuccess &&
      cudaDeviceGetPCIBusId(address, static_cast<int>(sizeof address), device) == cudaSuccess)
    return address;
#endif
  return "";
}

}  // namespace drogue::perf
