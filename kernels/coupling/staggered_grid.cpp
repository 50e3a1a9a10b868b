#include "kernels/coupling/staggered_grid.hpp"

#include <cmath>
#include <stdexcept>

namespace drogue::coupling {

void check(const StaggeredGrid& grid) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (grid.cells[axis] < 1 || grid.cells[axis] > 1 << 30)
      throw std::invalid_argument("MAC grid: the number of cells of an axis must be 1 to 2^30");
    if (!(grid.spacing[axis] > 0.0) || !std::isfinite(grid.spacing[axis]))
      throw std::invalid_argument("MAC grid: the spacing of an axis must be positive and finite");
    if (!std::isfinite(grid.origin[axis])) throw std::invalid_argument("MAC grid: the origin must be finite");
  }
}

GridAxes grid_axes(const StaggeredGrid& grid) {
  GridAxes axes{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    axes.axis[axis] = {grid.origin[axis], 1.0 / grid.spacing[axis], grid.cells[axis], grid.periodic[axis]};
  return axes;
}

int faces_along(const StaggeredGrid& grid, int component, int axis) {
  const auto k = static_cast<std::size_t>(axis);
  return grid.cells[k] + (component == axis && !grid.periodic[k] ? 1 : 0);
}

FaceWindow whole_window(const StaggeredGrid& grid) {
  FaceWindow window{};
  for (int component = 0; component < 3; ++component)
    for (int axis = 0; axis < 3; ++axis) window.set(component, axis, 0, faces_along(grid, component, axis));
  return window;
}

double cell_volume(const StaggeredGrid& grid) { return grid.spacing[0] * grid.spacing[1] * grid.spacing[2]; }

}  // namespace drogue::coupling
