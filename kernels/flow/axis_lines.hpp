#pragma once

#include <cstddef>
#include <vector>

#include "kernels/flow/core.hpp"
#include "kernels/flow/parameters.hpp"

namespace drogue::flow {

/// True if the cells of an axis have widths of their own. Does not throw.
[[nodiscard]] inline bool is_stretched(const Parameters& p, std::size_t axis) {
  return !p.faces[axis].empty();
}

/// Coordinate of face `i` of an axis, 0 to the number of cells, m. Does not throw.
[[nodiscard]] inline double face_coordinate(const Parameters& p, std::size_t axis, int i) {
  if (is_stretched(p, axis)) return p.faces[axis][static_cast<std::size_t>(i)];
  return p.low[axis] + i * ((p.high[axis] - p.low[axis]) / p.cells[axis]);
}

/// Width of cell `i` of an axis, m. Does not throw.
[[nodiscard]] inline double cell_width(const Parameters& p, std::size_t axis, int i) {
  if (!is_stretched(p, axis)) return (p.high[axis] - p.low[axis]) / p.cells[axis];
  return face_coordinate(p, axis, i + 1) - face_coordinate(p, axis, i);
}

/// Coordinate of the centre of cell `i` of an axis, m. Does not throw.
[[nodiscard]] inline double centre_coordinate(const Parameters& p, std::size_t axis, int i) {
  if (is_stretched(p, axis)) return 0.5 * (face_coordinate(p, axis, i) + face_coordinate(p, axis, i + 1));
  const double width = cell_width(p, axis, i);
  return (p.low[axis] + 0.5 * width) + i * width;
}

/// Widths of all cells of an axis, m; none if they have one width. Throws std::bad_alloc.
[[nodiscard]] inline std::vector<double> widths(const Parameters& p, std::size_t axis) {
  std::vector<double> result;
  for (int i = 0; is_stretched(p, axis) && i < p.cells[axis]; ++i) result.push_back(cell_width(p, axis, i));
  return result;
}

/// Along each axis the longest run of cells whose widths are the least one to 1e-9 of it; of a uniform axis
/// all cells. Does not throw.
[[nodiscard]] Core core_of(const Parameters& p);

/// Part of the core whose faces may bear forces: their control volumes are those of a grid of one width. Of a
/// uniform axis all cells, else those of the core without the first and the last one, unless they lie at a
/// side of the domain that is not periodic. Does not throw.
[[nodiscard]] Core force_box(const Parameters& p);

}  // namespace drogue::flow
