#pragma once

#include <vector>

namespace drogue::grid {

/// An axis with cells of one width in its core, and cells that grow from there to the ends of the domain.
struct StretchedAxis {
  double low = 0.0, high = 1.0;            ///< ends of the domain, m
  double core_low = 0.0, core_high = 1.0;  ///< ends of the core, m, within the domain
  double spacing = 0.1;                    ///< largest width of a cell in the core, m
  double growth = 1.06;                    ///< largest ratio of the widths of neighbouring cells, above 1
};

/// Coordinates of the faces of an axis, m, ascending from `low` to `high`. The core has the fewest cells that
/// are no wider than `spacing`. Outside of it, each side has the fewest cells whose widths grow by one ratio
/// of at least 1 and at most `growth`, in a geometric series; where there is none, since the core ends a few
/// cells before the side, the core reaches the side instead. Symmetric about 0 to the bit where the axis is.
/// Throws std::invalid_argument for parameters out of range, and for more than 2^20 cells.
[[nodiscard]] std::vector<double> stretched_faces(const StretchedAxis& axis);

}  // namespace drogue::grid
