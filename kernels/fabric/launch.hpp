#pragma once

#include "kernels/fabric/fabric_views.hpp"

namespace drogue::fabric {

/// Calls `functor(i)` for i from 0 to `count` - 1. Asynchronous.
template <class Bounds = Kokkos::LaunchBounds<>, class ExecutionSpace, class Functor>
void launch_each(const ExecutionSpace& space, const char* label, int count, const Functor& functor) {
  static_assert(Kokkos::SpaceAccessibility<ExecutionSpace,
                                           typename PointsView<ExecutionSpace>::memory_space>::accessible);
  const Kokkos::RangePolicy<ExecutionSpace, Bounds> each(space, 0, count);
  // Light-weight functors are kernel arguments. Others are copied to a buffer that orders launches.
  Kokkos::parallel_for(
      label, Kokkos::Experimental::require(each, Kokkos::Experimental::WorkItemProperty::HintLightWeight),
      functor);
}

/// Numbers that a kernel over packs of vertices works on: SIMD packs on a host, single values on a device.
template <class ExecutionSpace>
using PackedReal = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;

/// Calls `functor(pack)` for each pack of `padded` vertices, with the launch bounds of the functor.
/// Asynchronous.
template <class ExecutionSpace, class Functor>
void launch_packs(const ExecutionSpace& space, const char* label, int padded, const Functor& functor) {
  constexpr int lanes = device::Access<PackedReal<ExecutionSpace>>::lanes;
  static_assert(slice % lanes == 0, "lanes must not straddle slices");
  launch_each<typename Functor::Bounds>(space, label, padded / lanes, functor);
}

}  // namespace drogue::fabric
