#include "kernels/flow/axis_lines.hpp"

#include <algorithm>
#include <limits>

namespace drogue::flow {

Core core_of(const Parameters& p) {
  constexpr double tolerance = 1e-9;
  Core core;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int n = p.cells[axis];
    if (!is_stretched(p, axis)) {
      core.cells[axis] = n;
      core.low[axis] = p.low[axis];
      core.high[axis] = p.high[axis];
      core.spacing[axis] = cell_width(p, axis, 0);
      continue;
    }
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < n; ++i) least = std::min(least, cell_width(p, axis, i));
    for (int begin = 0, end = 0; begin < n; begin = end + 1) {
      for (end = begin; end < n && cell_width(p, axis, end) <= (1.0 + tolerance) * least;) ++end;
      if (end - begin <= core.cells[axis]) continue;
      core.begin[axis] = begin;
      core.cells[axis] = end - begin;
    }
    core.low[axis] = face_coordinate(p, axis, core.begin[axis]);
    core.high[axis] = face_coordinate(p, axis, core.begin[axis] + core.cells[axis]);
    core.spacing[axis] = (core.high[axis] - core.low[axis]) / core.cells[axis];
  }
  return core;
}

Core force_box(const Parameters& p) {
  Core box = core_of(p);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Beyond a periodic side lies the cell at the other end.
    const bool repeats = is_stretched(p, axis) && p.boundary[2 * axis].kind == BoundaryKind::periodic;
    const int begin = box.begin[axis] + (repeats || box.begin[axis] > 0 ? 1 : 0),
              core_end = box.begin[axis] + box.cells[axis],
              end = core_end - (repeats || core_end < p.cells[axis] ? 1 : 0);
    if (end - begin == box.cells[axis]) continue;
    box.begin[axis] = begin;
    box.cells[axis] = end - begin;
    box.low[axis] = face_coordinate(p, axis, begin);
    box.high[axis] = face_coordinate(p, axis, end);
  }
  return box;
}

}  // namespace drogue::flow
