#pragma once

#include <algorithm>
#include <cstdint>

// What the kernels of a step ask of a device's multiprocessor. Without Kokkos, so that a model of occupancy
// may read it too.

namespace drogue::gas {

/// Threads of a usual device team. Three teams a multiprocessor have 168 registers a thread. Four have 128,
/// which the fused step just lives in; where a thread has several slots that is the faster. One of the
/// largest has 128, too.
inline constexpr int usual_team = 128, largest_team = 512;
inline constexpr int usual_teams = 3, dense_teams = 4, largest_teams = 1;

/// Slots of a large mesh's tile, by measurement on an H200: three for each thread of a usual team, so that
/// few of them are halo.
inline constexpr int largest_tile = 384;
inline constexpr std::int64_t large_mesh = 65'536;

/// Threads of a device team: small meshes have more of smaller ones, so that more multiprocessors work.
inline int device_team(int block, std::int64_t cells) {
  if (block > 0) return block;
  return cells < 32'768 ? 96 : usual_team;
}

/// Rows of a tile's scratch memory: what faces need of a cell, fluxes, and U^n.
inline constexpr int cell_rows = 9, flux_rows = 3, start_rows = 3;
inline constexpr int device_rows = cell_rows + flux_rows + start_rows;

inline constexpr int scratch_margin = 64;            ///< bytes, to align what a tile asks for
inline constexpr int most_shared_bytes = 48 * 1024;  ///< that Kokkos lets a team have

/// Shared memory of a device team: `rows` of `slots` doubles, and what Kokkos keeps for team reductions.
constexpr int shared_bytes(int rows, int slots, int team) {
  return 8 * rows * slots + scratch_margin + 8 * (team + 2);
}

/// As many slots as wanted, or as there is memory for; the largest teams have more threads than slots.
constexpr int fitting_slots(int rows, int wanted, int team) {
  return std::min(wanted, (most_shared_bytes - shared_bytes(rows, 0, team)) / (8 * rows));
}

}  // namespace drogue::gas
