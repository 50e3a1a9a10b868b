#pragma once

#include <Kokkos_Core.hpp>

/// What the lanes of a warp, all of which call these functions together, tell one another without memory. On
/// the host, where no warps are, a lane is alone.
namespace drogue::device {

inline constexpr int warp_lanes = 32;

/// What any lane has written before is seen by all after it.
KOKKOS_INLINE_FUNCTION void warp_sync() { KOKKOS_IF_ON_DEVICE((__syncwarp();)) }

/// The value of the lane `reach` below in a group of `width` lanes; of the lowest lanes their own.
template <int width = warp_lanes>
KOKKOS_INLINE_FUNCTION double shuffle_up(double value, int reach) {
  KOKKOS_IF_ON_DEVICE((return __shfl_up_sync(~0U, value, static_cast<unsigned>(reach), width);))
  KOKKOS_IF_ON_HOST(((void)reach; return value;))
}

/// The value of the lane `reach` above in a group of `width` lanes; of the highest lanes their own.
template <int width = warp_lanes>
KOKKOS_INLINE_FUNCTION double shuffle_down(double value, int reach) {
  KOKKOS_IF_ON_DEVICE((return __shfl_down_sync(~0U, value, static_cast<unsigned>(reach), width);))
  KOKKOS_IF_ON_HOST(((void)reach; return value;))
}

/// The value of a lane, whose number counts modulo those of a warp.
KOKKOS_INLINE_FUNCTION double shuffle(double value, int lane) {
  KOKKOS_IF_ON_DEVICE((return __shfl_sync(~0U, value, lane);))
  KOKKOS_IF_ON_HOST(((void)lane; return value;))
}

/// The value of the lane whose number differs in the bit `reach`.
KOKKOS_INLINE_FUNCTION double shuffle_xor(double value, int reach) {
  KOKKOS_IF_ON_DEVICE((return __shfl_xor_sync(~0U, value, reach);))
  KOKKOS_IF_ON_HOST(((void)reach; return value;))
}

/// Whether a condition holds on all lanes of a warp.
KOKKOS_INLINE_FUNCTION bool warp_all(bool condition) {
  KOKKOS_IF_ON_DEVICE((return __all_sync(~0U, condition ? 1 : 0) != 0;))
  KOKKOS_IF_ON_HOST((return condition;))
}

/// The largest of the numbers of a group of `width` lanes.
template <int width = warp_lanes>
KOKKOS_INLINE_FUNCTION int warp_max(int value) {
  KOKKOS_IF_ON_DEVICE((for (int reach = width / 2; reach > 0; reach /= 2) {
    const int other = __shfl_xor_sync(~0U, value, reach);
    value = other > value ? other : value;
  }))
  return value;
}

/// Tells the compiler what holds.
KOKKOS_INLINE_FUNCTION void assume(bool condition) {
  KOKKOS_IF_ON_DEVICE((__builtin_assume(condition);))
  KOKKOS_IF_ON_HOST(((void)condition;))
}

/// Tells the compiler that `place` is in shared memory, which Kokkos' scratch handles hide from it.
template <class T>
KOKKOS_INLINE_FUNCTION T* in_shared_memory(T* place) {
  KOKKOS_IF_ON_DEVICE((__builtin_assume(__isShared(place));))
  return place;
}

}  // namespace drogue::device
