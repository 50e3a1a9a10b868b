#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::device {

// On CUDA, Kokkos::atomic_load and atomic_store compare and exchange: threads that read or write one address
// take turns. These accesses are plain instructions there, which neither a compiler nor a cache may elide.

/// Value that other threads may change atomically at the same time, not ordered with other accesses. Does not
/// throw.
template <class T>
KOKKOS_INLINE_FUNCTION T relaxed_load(const T* from) {
  KOKKOS_IF_ON_DEVICE((return *static_cast<const volatile T*>(from);))
  KOKKOS_IF_ON_HOST((return Kokkos::atomic_load(from);))
}

/// Sets a value that other threads may access atomically at the same time, not ordered with other accesses.
/// Does not throw.
template <class T>
KOKKOS_INLINE_FUNCTION void relaxed_store(T* to, T value) {
  KOKKOS_IF_ON_DEVICE((*static_cast<volatile T*>(to) = value;))
  KOKKOS_IF_ON_HOST((Kokkos::atomic_store(to, value);))
}

}  // namespace drogue::device
