#pragma once

namespace drogue::device {

/// Largest number of threads of a team that parameters may select: larger ones leave less than 128 registers
/// to a thread of a GPU.
inline constexpr int largest_block = 512;

/// True for a number of threads of a team, a multiple of 32 up to `largest_block`, and for 0, the default of
/// a kernel. Does not throw.
constexpr bool is_block_size(int block) { return block >= 0 && block <= largest_block && block % 32 == 0; }

}  // namespace drogue::device
