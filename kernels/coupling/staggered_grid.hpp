#pragma once

#include "kernels/coupling/parameters.hpp"

namespace drogue::coupling {

/// One axis of a grid as kernels read it.
struct GridAxis {
  double origin;           ///< m
  double inverse_spacing;  ///< 1/m
  int cells;
  bool periodic;
};

/// All axes of a grid as kernels read them.
struct GridAxes {
  GridAxis axis[3];
};

/// Throws std::invalid_argument for cell counts outside 1 to 2^30, spacings (m) that are not positive, and
/// origins that are not finite.
void check(const StaggeredGrid& grid);

/// Axes of a checked grid; lengths in m. Does not throw.
[[nodiscard]] GridAxes grid_axes(const StaggeredGrid& grid);

/// Number of faces of velocity component `component` along `axis`. Does not throw.
[[nodiscard]] int faces_along(const StaggeredGrid& grid, int component, int axis);

/// Volume of a cell, m^3. Does not throw.
[[nodiscard]] double cell_volume(const StaggeredGrid& grid);

}  // namespace drogue::coupling
