#pragma once

#include <cstddef>

namespace drogue::framework {

/// Cells in which the initial state of a scene is checked; of large grids a program may take fewer. Grids of
/// a study differ in their number of cells from that of its scene, which is checked in all of them: some
/// cells suffice there, however many there are.
enum class InitialCheck { all_cells, some_cells };

/// Distance of the checked ones among `cells`: less than 65536 of some.
[[nodiscard]] constexpr std::size_t check_stride(InitialCheck check, std::size_t cells) {
  return check == InitialCheck::all_cells ? 1 : 1 + cells / 65536;
}

}  // namespace drogue::framework
