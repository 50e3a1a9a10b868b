#include "perf/memory/device_memory.hpp"

#include <Kokkos_Core.hpp>
#include <stdexcept>

namespace drogue::perf {

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
