#pragma once

#include <Kokkos_Core.hpp>
#include <type_traits>

namespace drogue::device {

/// True for Serial and OpenMP, where a team is one thread and a thread computes packs of values.
template <class ExecutionSpace>
inline constexpr bool is_host = Kokkos::SpaceAccessibility<Kokkos::DefaultHostExecutionSpace,
                                                           typename ExecutionSpace::memory_space>::accessible;

/// Host memory that kernels of `ExecutionSpace` write directly; page-locked for a GPU. Running kernels report
/// their progress through it.
#if defined(KOKKOS_ENABLE_CUDA)
template <class ExecutionSpace>
using HostPinnedSpace =
    std::conditional_t<is_host<ExecutionSpace>, Kokkos::HostSpace, Kokkos::CudaHostPinnedSpace>;
#elif defined(KOKKOS_ENABLE_HIP)
template <class ExecutionSpace>
using HostPinnedSpace =
    std::conditional_t<is_host<ExecutionSpace>, Kokkos::HostSpace, Kokkos::HIPHostPinnedSpace>;
#else
template <class ExecutionSpace>
using HostPinnedSpace = Kokkos::HostSpace;
#endif

/// Value at `pointer` in memory that no thread writes while the kernel runs. On CUDA the load may then
/// precede stores before it. Does not throw.
KOKKOS_INLINE_FUNCTION double load_constant(const double* pointer) {
#if defined(__CUDA_ARCH__)
  return __ldg(pointer);
#else
  return *pointer;
#endif
}

}  // namespace drogue::device
