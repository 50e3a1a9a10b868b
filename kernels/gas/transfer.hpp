#pragma once

#include <span>
#include <utility>

#include "kernels/device/copy.hpp"
#include "kernels/gas/tile/tile.hpp"

namespace drogue::gas {

/// Copies a range of cells of one field between a device View and host memory. Blocks until the copy is
/// complete.
template <class ExecutionSpace, class Device, class Value>
void copy_range(const ExecutionSpace& space, const Device& device, std::int64_t first, std::span<Value> host,
                bool to_device) {
  using Element = std::remove_const_t<Value>;
  const auto range = std::make_pair(first, first + static_cast<std::int64_t>(host.size()));
  auto part = Kokkos::subview(device, range);
  const Kokkos::View<Value*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>> mine(host.data(),
                                                                                              host.size());
  if constexpr (std::is_same_v<Element, Value>) {
    if (to_device)
      device::copy(space, part, mine);
    else
      device::copy(space, mine, part);
  } else {
    device::copy(space, part, mine);
  }
  space.fence("drogue::gas::transfer");
}

template <class View>
auto field(const View& fields, int index) {
  return Kokkos::subview(fields, Kokkos::ALL, index);
}

}  // namespace drogue::gas
