#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::device {

/// True for Serial and OpenMP: one thread a team, packs of values a thread.
template <class ExecutionSpace>
inline constexpr bool is_host = Kokkos::SpaceAccessibility<Kokkos::DefaultHostExecutionSpace,
                                                           typename ExecutionSpace::memory_space>::accessible;

/// Host memory that kernels of `ExecutionSpace` write without a copy, on CUDA page-locked; how a running
/// device reports to the host.
#if defined(KOKKOS_ENABLE_CUDA)
template <class ExecutionSpace>
using HostPinnedSpace =
    std::conditional_t<is_host<ExecutionSpace>, Kokkos::HostSpace, Kokkos::CudaHostPinnedSpace>;
#else
template <class ExecutionSpace>
using HostPinnedSpace = Kokkos::HostSpace;
#endif

}  // namespace drogue::device
