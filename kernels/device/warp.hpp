#pragma once

#include <Kokkos_Core.hpp>

/// Warp-level operations without shared memory; all lanes of a warp call them together. On the host a warp
/// has one lane, and the operations return its value.
namespace drogue::device {

inline constexpr int warp_lanes = 32;

/// Barrier and memory fence of a warp.
KOKKOS_INLINE_FUNCTION void warp_sync() { KOKKOS_IF_ON_DEVICE((__syncwarp();)) }

/// Value of the lane `lane_offset` below in each group of `width` lanes; the lowest lanes keep their own.
template <int width = warp_lanes>
KOKKOS_INLINE_FUNCTION double shuffle_up(double value, int lane_offset) {
  KOKKOS_IF_ON_DEVICE((return __shfl_up_sync(~0U, value, static_cast<unsigned>(lane_offset), width);))
  KOKKOS_IF_ON_HOST(((void)lane_offset; return value;))
}

/// Value of the lane `lane_offset` above in each group of `width` lanes; the highest lanes keep their own.
template <int width = warp_lanes>
KOKKOS_INLINE_FUNCTION double shuffle_down(double value, int lane_offset) {
  KOKKOS_IF_ON_DEVICE((return __shfl_down_sync(~0U, value, static_cast<unsigned>(lane_offset), width);))
  KOKKOS_IF_ON_HOST(((void)lane_offset; return value;))
}

/// Value of lane `lane`, modulo the size of a warp.
KOKKOS_INLINE_FUNCTION double shuffle(double value, int lane) {
  KOKKOS_IF_ON_DEVICE((return __shfl_sync(~0U, value, lane);))
  KOKKOS_IF_ON_HOST(((void)lane; return value;))
}

/// Value of the lane whose index differs in the bits of `lane_mask`.
KOKKOS_INLINE_FUNCTION double shuffle_xor(double value, int lane_mask) {
  KOKKOS_IF_ON_DEVICE((return __shfl_xor_sync(~0U, value, lane_mask);))
  KOKKOS_IF_ON_HOST(((void)lane_mask; return value;))
}

/// True if the condition holds on all lanes of a warp.
KOKKOS_INLINE_FUNCTION bool warp_all(bool condition) {
  KOKKOS_IF_ON_DEVICE((return __all_sync(~0U, condition ? 1 : 0) != 0;))
  KOKKOS_IF_ON_HOST((return condition;))
}

/// Bit n is set if the condition holds on lane n. On the host a warp has one lane.
KOKKOS_INLINE_FUNCTION unsigned warp_ballot(bool condition) {
  KOKKOS_IF_ON_DEVICE((return __ballot_sync(~0U, condition ? 1 : 0);))
  KOKKOS_IF_ON_HOST((return condition ? 1U : 0U;))
}

/// Largest value of each group of `width` lanes.
template <int width = warp_lanes>
KOKKOS_INLINE_FUNCTION int warp_maximum(int value) {
  KOKKOS_IF_ON_DEVICE((for (int lane_offset = width / 2; lane_offset > 0; lane_offset /= 2) {
    const int other = __shfl_xor_sync(~0U, value, lane_offset);
    value = other > value ? other : value;
  }))
  return value;
}

/// Lets the compiler assume `condition`; undefined behaviour if it does not hold.
KOKKOS_INLINE_FUNCTION void assume(bool condition) {
  KOKKOS_IF_ON_DEVICE((__builtin_assume(condition);))
  KOKKOS_IF_ON_HOST(((void)condition;))
}

/// Pointer that the compiler may assume to point to shared memory, which Kokkos scratch handles do not state.
template <class T>
KOKKOS_INLINE_FUNCTION T* in_shared_memory(T* pointer) {
  KOKKOS_IF_ON_DEVICE((__builtin_assume(__isShared(pointer));))
  return pointer;
}

}  // namespace drogue::device
