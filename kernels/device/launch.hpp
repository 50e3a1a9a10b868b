#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/device/memory.hpp"

namespace drogue::device {

/// Calls `functor(i)` for i from 0 to `count` - 1 on `space`. Asynchronous; may be captured into a CUDA
/// graph. `Bounds`: launch bounds of the kernel. Does not throw: the next copy reports a launch that CUDA
/// rejects (`copy_bytes`).
template <class Bounds = Kokkos::LaunchBounds<>, class ExecutionSpace, class Functor>
void launch_each(const ExecutionSpace& space, const char* label, int count, const Functor& functor) {
  // Larger functors are no kernel arguments of CUDA, whatever the hint.
  static_assert(sizeof(Functor) <= 4000, "a functor of launch_each must fit the arguments of a kernel");
  const Kokkos::RangePolicy<ExecutionSpace, Bounds> each(space, 0, count);
  // Light-weight functors are kernel arguments. Others are copied to a buffer that orders launches and that a
  // captured graph cannot hold.
  Kokkos::parallel_for(
      label, Kokkos::Experimental::require(each, Kokkos::Experimental::WorkItemProperty::HintLightWeight),
      functor);
}

/// Calls `functor(member)` in the teams of `policy`, a Kokkos::TeamPolicy. Asynchronous; may be captured into
/// a CUDA graph. Throws std::runtime_error if a team has more threads or scratch memory than the kernel can
/// have; the next copy reports a launch that CUDA rejects (`copy_bytes`).
template <class Policy, class Functor>
void launch_teams(const char* label, const Policy& policy, const Functor& functor) {
  static_assert(sizeof(Functor) <= 3900, "a functor of launch_teams must fit the arguments of a kernel");
  // A team policy of Kokkos::Serial that gets a property loses its instance, and hosts need no hint.
  if constexpr (is_host<typename Policy::execution_space>)
    Kokkos::parallel_for(label, policy, functor);
  else
    Kokkos::parallel_for(
        label, Kokkos::Experimental::require(policy, Kokkos::Experimental::WorkItemProperty::HintLightWeight),
        functor);
}

/// Calls `functor(i, j, k)` for all indices below `extent`, i fastest. Asynchronous; may be captured into a
/// CUDA graph. Does not throw, as `launch_each`.
template <class ExecutionSpace, class Functor>
void launch_cells(const ExecutionSpace& space, const char* label, const int extent[3],
                  const Functor& functor) {
  static_assert(sizeof(Functor) <= 3900, "a functor of launch_cells must fit the arguments of a kernel");
  // 32-bit indices are much cheaper on a device.
  using Policy =
      Kokkos::MDRangePolicy<ExecutionSpace, Kokkos::Rank<3, Kokkos::Iterate::Left, Kokkos::Iterate::Left>,
                            Kokkos::IndexType<int>>;
  using Indices = Kokkos::Array<int, 3>;
  // Warps along i on a device; the defaults of a host are rows.
  const Indices tile = is_host<ExecutionSpace> ? Indices{} : Indices{32, 4, 1};
  Kokkos::parallel_for(
      label,
      Kokkos::Experimental::require(Policy(space, Indices{}, Indices{extent[0], extent[1], extent[2]}, tile),
                                    Kokkos::Experimental::WorkItemProperty::HintLightWeight),
      functor);
}

}  // namespace drogue::device
