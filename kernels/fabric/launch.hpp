#pragma once

#include "kernels/device/launch.hpp"
#include "kernels/fabric/fabric_views.hpp"

namespace drogue::fabric {

using device::launch_each;

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
