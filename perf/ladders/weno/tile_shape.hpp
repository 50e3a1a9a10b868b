#pragma once

namespace drogue::perf::ladder {

/// Cells that a team updates; cells that it reads, with three ghosts on either side; threads of a team on a
/// device.
inline constexpr int tile_cells = 128, tile_ghosts = 3, tile_slots = tile_cells + 2 * tile_ghosts,
                     tile_threads = 128;

/// Length of a row of scratch memory: the widest pack of a host may read beyond the last slot.
inline constexpr int tile_stride = tile_slots + 10;

}  // namespace drogue::perf::ladder
