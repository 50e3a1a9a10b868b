#pragma once

#include <stdexcept>
#include <string>

#include "kernels/device/copy.hpp"
#include "kernels/device/memory.hpp"

namespace drogue::device {

/// Throws std::runtime_error if a GPU rejected a kernel since the last call: Kokkos does not report that, and
/// the arrays would keep their old values.
inline void check_launches() {
#if defined(KOKKOS_ENABLE_CUDA)
  const cudaError_t error = cudaGetLastError();
  if (error != cudaSuccess)
    throw std::runtime_error(std::string("CUDA could not launch a kernel: ") + cudaGetErrorString(error));
#elif defined(KOKKOS_ENABLE_HIP)
  const hipError_t error = hipGetLastError();
  if (error != hipSuccess)
    throw std::runtime_error(std::string("HIP could not launch a kernel: ") + hipGetErrorString(error));
#endif
}

/// Copies bytes from memory space `From` to memory space `To`. Asynchronous.
template <class To, class From, class ExecutionSpace>
void copy_between(const ExecutionSpace& space, void* to, const void* from, std::size_t bytes) {
  using Bytes = Kokkos::View<char*, To, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
  using ConstBytes = Kokkos::View<const char*, From, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
  Kokkos::deep_copy(space, Bytes(static_cast<char*>(to), bytes),
                    ConstBytes(static_cast<const char*>(from), bytes));
}

template <class ExecutionSpace>
void copy_bytes(const ExecutionSpace& space, CopyKind kind, void* to, const void* from, std::size_t bytes) {
  using Host = Kokkos::HostSpace;
  using Device = typename ExecutionSpace::memory_space;
  if constexpr (!is_host<ExecutionSpace>) check_launches();
  switch (kind) {
    case CopyKind::to_device:
      return copy_between<Device, Host>(space, to, from, bytes);
    case CopyKind::to_host:
      return copy_between<Host, Device>(space, to, from, bytes);
    case CopyKind::to_host_pinned:
      return copy_between<HostPinnedSpace<ExecutionSpace>, Device>(space, to, from, bytes);
    case CopyKind::within:
      return copy_between<Device, Device>(space, to, from, bytes);
  }
}

}  // namespace drogue::device
