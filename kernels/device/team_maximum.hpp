#pragma once

#include <cstdint>

#include <Kokkos_Core.hpp>

#include "kernels/device/relaxed_access.hpp"

namespace drogue::device {

#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
/// Largest value of the lanes in the mask `lanes`, by two integer reductions: high words, then low words.
/// Does not throw.
__device__ inline std::uint64_t warp_maximum(unsigned lanes, std::uint64_t own) {
  const auto own_high = static_cast<unsigned>(own >> 32U);
  const unsigned high = __reduce_max_sync(lanes, own_high);
  const unsigned low = __reduce_max_sync(lanes, own_high == high ? static_cast<unsigned>(own) : 0U);
  return static_cast<std::uint64_t>(high) << 32U | low;
}
#endif

/// Raises `slot` to the largest `mine` of a team, atomically. All threads of the team call it with
/// non-negative values. The bits of non-negative doubles order like their values, so the result does not
/// depend on the order of the teams.
///
/// On CUDA each warp reduces and updates the slot: a reduction of the team through shared memory takes 2 us.
template <class Member>
KOKKOS_INLINE_FUNCTION void raise_to_team_maximum(const Member& member, std::uint64_t& slot, double mine) {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
  // The lanes are computed and not read from __activemask: a diverged warp may not have reconverged here.
  const int after = member.team_size() - member.team_rank() / 32 * 32;
  const unsigned lanes = after >= 32 ? ~0U : (1U << static_cast<unsigned>(after)) - 1U;
  const std::uint64_t bits = warp_maximum(lanes, Kokkos::bit_cast<std::uint64_t>(mine));
  if (member.team_rank() % 32 != 0) return;
#else
  double largest = mine;
  // Members of persistent kernels lack team_reduce; on the host they are compiled but never run.
  if constexpr (requires { member.team_reduce(Kokkos::Max<double>(largest)); })
    member.team_reduce(Kokkos::Max<double>(largest));
  if (member.team_rank() != 0) return;
  const auto bits = Kokkos::bit_cast<std::uint64_t>(largest);
#endif
  // With many teams a load before the atomic reduces contention; with few it only adds latency.
  if (member.league_size() < 1024 || bits > relaxed_load(&slot)) Kokkos::atomic_max(&slot, bits);
}

}  // namespace drogue::device
