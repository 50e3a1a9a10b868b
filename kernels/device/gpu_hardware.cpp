#include "kernels/device/gpu_hardware.hpp"

#include <Kokkos_Core.hpp>

namespace drogue::device {

GpuHardware gpu_hardware() {
  GpuHardware hardware;
#if defined(KOKKOS_ENABLE_CUDA)
  const int device = Kokkos::Cuda().cuda_device();
  cudaDeviceProp properties;
  if (cudaGetDeviceProperties(&properties, device) == cudaSuccess) {
    hardware.multiprocessors = properties.multiProcessorCount;
    hardware.registers = properties.regsPerMultiprocessor;
    hardware.memory = static_cast<std::int64_t>(properties.totalGlobalMem);
    hardware.constant = static_cast<std::int64_t>(properties.totalConstMem);
    hardware.shared = static_cast<std::int64_t>(properties.sharedMemPerMultiprocessor);
    hardware.l2 = properties.l2CacheSize;
  }
  cudaDeviceGetAttribute(&hardware.clock_khz, cudaDevAttrClockRate, device);
#endif
#if defined(KOKKOS_ENABLE_HIP)
  hipDeviceProp_t properties;
  if (hipGetDeviceProperties(&properties, Kokkos::HIP().hip_device()) == hipSuccess) {
    hardware.multiprocessors = properties.multiProcessorCount;
    hardware.memory = static_cast<std::int64_t>(properties.totalGlobalMem);
    hardware.constant = static_cast<std::int64_t>(properties.totalConstMem);
    hardware.shared = static_cast<std::int64_t>(properties.maxSharedMemoryPerMultiProcessor);
    hardware.l2 = properties.l2CacheSize;
    hardware.clock_khz = properties.clockRate;
  }
#endif
  return hardware;
}

}  // namespace drogue::device
