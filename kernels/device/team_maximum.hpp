#pragma once

#include <cstdint>

#include <Kokkos_Core.hpp>

namespace drogue::device {

#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
/// The largest of the lanes in `lanes`, by the integer unit, high words first.
__device__ inline std::uint64_t warp_maximum(unsigned lanes, std::uint64_t own) {
  const auto own_high = static_cast<unsigned>(own >> 32U);
  const unsigned high = __reduce_max_sync(lanes, own_high);
  const unsigned low = __reduce_max_sync(lanes, own_high == high ? static_cast<unsigned>(own) : 0U);
  return static_cast<std::uint64_t>(high) << 32U | low;
}
#endif

/// Raises `slot` to the largest `mine` of the team's threads, all of which call this. Non-negative doubles
/// compare as their bits do, so the result does not depend on the order in which teams arrive.
///
/// On CUDA each warp reduces and raises the slot itself: a team's
/// reduction through shared memory costs a small kernel two microseconds.
template <class Member>
KOKKOS_INLINE_FUNCTION void raise_to_team_maximum(const Member& member, std::uint64_t& slot, double mine) {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
  // Named, not asked for: a warp that has parted on its way here need not have come together again.
  const int after = member.team_size() - member.team_rank() / 32 * 32;
  const unsigned lanes = after >= 32 ? ~0U : (1U << static_cast<unsigned>(after)) - 1U;
  const std::uint64_t bits = warp_maximum(lanes, Kokkos::bit_cast<std::uint64_t>(mine));
  if (member.team_rank() % 32 != 0) return;
#else
  double largest = mine;
  // Nothing for a persistent kernel's teams: these lines are their host side, which never runs.
  if constexpr (requires { member.team_reduce(Kokkos::Max<double>(largest)); })
    member.team_reduce(Kokkos::Max<double>(largest));
  if (member.team_rank() != 0) return;
  const auto bits = Kokkos::bit_cast<std::uint64_t>(largest);
#endif
  // Many teams ask first, a few would only wait for the answer.
  if (member.league_size() < 1024 || bits > Kokkos::atomic_load(&slot)) Kokkos::atomic_max(&slot, bits);
}

}  // namespace drogue::device
