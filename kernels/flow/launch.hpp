#pragma once

#include "kernels/device/block_size.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/flow/schemes.hpp"

namespace drogue::flow {

/// Threads of a team on a device, as columns of a tile of 32 x 4 cells.
inline constexpr int tile_x = 32, tile_y = 4;

/// Rows of the tile of a team of `block` threads on a device; 0: of the default. Does not throw.
constexpr int tile_rows(int block) { return block > 0 ? block / tile_x : tile_y; }

using device::launch_cells;

/// Planes of a march along z of a tile of columns on a device: at most `longest`, a power of two, and fewer
/// if there would be less than `enough_teams` teams; the default is about two waves of a large device. Does
/// not throw.
inline int march_planes(int tiles, int nz, int longest, int enough_teams = 1024) {
  int planes = longest;
  while (planes > 2 && tiles * ((nz + planes - 1) / planes) < enough_teams) planes /= 2;
  return planes;
}

/// Planes of a march of the momentum stage. Long marches evaluate fewer fluxes twice; of short ones more
/// teams are under way, on a small grid and at the end. Central fluxes cost less than that. Does not throw.
inline int momentum_planes(Advection scheme, int tiles, int nz) {
  return march_planes(tiles, nz, is_upwind(scheme) ? 8 : 2, 4096);
}

}  // namespace drogue::flow
