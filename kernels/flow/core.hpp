#pragma once

#include <array>

namespace drogue::flow {

/// Cells of a grid that have one width along each axis: a box that sheets and bodies may lie in.
struct Core {
  std::array<int, 3> begin = {0, 0, 0}, cells = {0, 0, 0};
  std::array<double, 3> low{}, high{};  ///< corners, m
  std::array<double, 3> spacing{};      ///< m

  friend bool operator==(const Core&, const Core&) = default;
};

}  // namespace drogue::flow
