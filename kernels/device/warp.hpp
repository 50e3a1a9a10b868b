#pragma once

#include <Kokkos_Core.hpp>
#include <cstdint>

/// Operations of a warp, 32 consecutive threads of a team, without shared memory; all lanes of a warp call
/// them together. A wave of 64 lanes of an AMD GPU holds two warps, which may take different branches and
/// round as two warps of an NVIDIA GPU do. On the host a warp has one lane, and the operations return its
/// value.
namespace drogue::device {

inline constexpr int warp_lanes = 32;

/// Operations of warps as each language of devices names them.
namespace lanes {

#if defined(KOKKOS_ENABLE_CUDA)

__device__ inline void sync() { __syncwarp(); }
template <class T>
__device__ T shuffle_up(T value, int lane_offset, int width) {
  return __shfl_up_sync(~0U, value, static_cast<unsigned>(lane_offset), width);
}
template <class T>
__device__ T shuffle_down(T value, int lane_offset, int width) {
  return __shfl_down_sync(~0U, value, static_cast<unsigned>(lane_offset), width);
}
template <class T>
__device__ T shuffle(T value, int lane) {
  return __shfl_sync(~0U, value, lane);
}
template <class T>
__device__ T shuffle_xor(T value, int lane_mask) {
  return __shfl_xor_sync(~0U, value, lane_mask);
}
__device__ inline bool all(bool condition) { return __all_sync(~0U, condition ? 1 : 0) != 0; }
__device__ inline unsigned ballot(bool condition) { return __ballot_sync(~0U, condition ? 1 : 0); }

#elif defined(KOKKOS_ENABLE_HIP)

// The lanes of a wave run in step, so that a barrier only has to keep the compiler from moving accesses.
__device__ inline void sync() {
  __builtin_amdgcn_fence(__ATOMIC_ACQ_REL, "wavefront");
  __builtin_amdgcn_wave_barrier();
}
template <class T>
__device__ T shuffle_up(T value, int lane_offset, int width) {
  return __shfl_up(value, static_cast<unsigned>(lane_offset), width);
}
template <class T>
__device__ T shuffle_down(T value, int lane_offset, int width) {
  return __shfl_down(value, static_cast<unsigned>(lane_offset), width);
}
template <class T>
__device__ T shuffle(T value, int lane) {
  return __shfl(value, lane & (warp_lanes - 1), warp_lanes);
}
template <class T>
__device__ T shuffle_xor(T value, int lane_mask) {
  return __shfl_xor(value, lane_mask, warp_lanes);
}
// The mask of a wave has up to 64 bits; lanes in another branch are clear.
__device__ inline unsigned ballot(bool condition) {
  const std::uint64_t of_wave = __ballot(condition ? 1 : 0);
  return static_cast<unsigned>(of_wave >> (__lane_id() / warp_lanes * warp_lanes));
}
__device__ inline bool all(bool condition) { return ballot(condition) == ~0U; }

#endif

}  // namespace lanes

/// Barrier and memory fence of a warp.
KOKKOS_INLINE_FUNCTION void warp_sync() { KOKKOS_IF_ON_DEVICE((lanes::sync();)) }

/// Value of the lane `lane_offset` below in each group of `width` lanes; the lowest lanes keep their own.
template <int width = warp_lanes>
KOKKOS_INLINE_FUNCTION double shuffle_up(double value, int lane_offset) {
  KOKKOS_IF_ON_DEVICE((return lanes::shuffle_up(value, lane_offset, width);))
  KOKKOS_IF_ON_HOST(((void)lane_offset; return value;))
}

/// Value of the lane `lane_offset` above in each group of `width` lanes; the highest lanes keep their own.
template <int width = warp_lanes>
KOKKOS_INLINE_FUNCTION double shuffle_down(double value, int lane_offset) {
  KOKKOS_IF_ON_DEVICE((return lanes::shuffle_down(value, lane_offset, width);))
  KOKKOS_IF_ON_HOST(((void)lane_offset; return value;))
}

/// Value of lane `lane`, modulo the size of a warp.
KOKKOS_INLINE_FUNCTION double shuffle(double value, int lane) {
  KOKKOS_IF_ON_DEVICE((return lanes::shuffle(value, lane);))
  KOKKOS_IF_ON_HOST(((void)lane; return value;))
}

/// Value of the lane whose index differs in the bits of `lane_mask`.
KOKKOS_INLINE_FUNCTION double shuffle_xor(double value, int lane_mask) {
  KOKKOS_IF_ON_DEVICE((return lanes::shuffle_xor(value, lane_mask);))
  KOKKOS_IF_ON_HOST(((void)lane_mask; return value;))
}

/// True if the condition holds on all lanes of a warp.
KOKKOS_INLINE_FUNCTION bool warp_all(bool condition) {
  KOKKOS_IF_ON_DEVICE((return lanes::all(condition);))
  KOKKOS_IF_ON_HOST((return condition;))
}

/// Bit n is set if the condition holds on lane n. On the host a warp has one lane.
KOKKOS_INLINE_FUNCTION unsigned warp_ballot(bool condition) {
  KOKKOS_IF_ON_DEVICE((return lanes::ballot(condition);))
  KOKKOS_IF_ON_HOST((return condition ? 1U : 0U;))
}

/// Largest value of each group of `width` lanes.
template <int width = warp_lanes>
KOKKOS_INLINE_FUNCTION int warp_maximum(int value) {
  KOKKOS_IF_ON_DEVICE((for (int lane_offset = width / 2; lane_offset > 0; lane_offset /= 2) {
    const int other = lanes::shuffle_xor(value, lane_offset);
    value = other > value ? other : value;
  }))
  return value;
}

/// Lets the compiler assume `condition`; undefined behaviour if it does not hold.
KOKKOS_INLINE_FUNCTION void assume(bool condition) {
  KOKKOS_IF_ON_DEVICE((__builtin_assume(condition);))
  KOKKOS_IF_ON_HOST(((void)condition;))
}

/// Pointer that the compiler of CUDA may assume to point to shared memory, which Kokkos scratch handles do
/// not state.
template <class T>
KOKKOS_INLINE_FUNCTION T* in_shared_memory(T* pointer) {
#if defined(KOKKOS_ENABLE_CUDA)
  KOKKOS_IF_ON_DEVICE((__builtin_assume(__isShared(pointer));))
#endif
  return pointer;
}

}  // namespace drogue::device
