#pragma once

#include <algorithm>
#include <cstdint>

// Launch configuration and shared memory of the step kernels. Free of Kokkos, so that the occupancy model can
// include it.

namespace drogue::gas {

/// Threads of a default device team. Three teams per multiprocessor leave 168 registers per thread, four
/// leave 128. The fused step fits into 128 registers, which is faster if a thread has several slots. One team
/// of the largest size has 128 registers per thread, too.
inline constexpr int default_team = 128, largest_team = 512;
inline constexpr int default_teams = 3, dense_teams = 4, largest_teams = 1;

/// Slots per tile of a large mesh, tuned on an H200 (perf, gas step cases): three per thread of a default
/// team, so that few of them are halo.
inline constexpr int largest_tile = 384;
inline constexpr std::int64_t large_mesh = 65'536;

/// Threads per device team. Small meshes use more and smaller teams to occupy more multiprocessors. Does not
/// throw.
inline int device_team(int block, std::int64_t cells) {
  if (block > 0) return block;
  return cells < 32'768 ? 96 : default_team;
}

/// Scratch rows of a tile: cell values, face fluxes, and U^n.
inline constexpr int cell_rows = 9, flux_rows = 3, start_rows = 3;
inline constexpr int device_rows = cell_rows + flux_rows + start_rows;

inline constexpr int scratch_margin = 64;           ///< bytes for the alignment of a tile's scratch
inline constexpr int max_shared_bytes = 48 * 1024;  ///< limit of Kokkos per team

/// Shared memory of a device team, bytes: `rows` of `slots` doubles, and the reduction buffer of Kokkos. Does
/// not throw.
constexpr int shared_bytes(int rows, int slots, int team) {
  return 8 * rows * slots + scratch_margin + 8 * (team + 2);
}

/// Number of slots per row, at most `wanted` and limited by shared memory. The largest teams have more
/// threads than slots. Does not throw.
constexpr int fitting_slots(int rows, int wanted, int team) {
  return std::min(wanted, (max_shared_bytes - shared_bytes(rows, 0, team)) / (8 * rows));
}

}  // namespace drogue::gas
