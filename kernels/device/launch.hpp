#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::device {

/// Calls `functor(i)` for i from 0 to `count` - 1 on `space`. Asynchronous; may be captured into a CUDA
/// graph. `Bounds`: launch bounds of the kernel. Throws std::runtime_error if the launch fails.
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

}  // namespace drogue::device
