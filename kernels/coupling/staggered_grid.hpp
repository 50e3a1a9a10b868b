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

/// Faces of a grid that a rank holds: a box for each component, by the indices of the whole grid. Every face
/// belongs to one rank.
struct FaceWindow {
  // By component, along its own axis and along the two axes after it, cyclically.
  int begin[3][3];  ///< first faces
  int count[3][3];  ///< numbers of faces

  /// Place of an axis in the rows of a component. Does not throw.
  [[nodiscard]] static constexpr int order(int component, int axis) { return (axis - component + 3) % 3; }
  /// First face of a component along an axis. Does not throw.
  [[nodiscard]] constexpr int first(int component, int axis) const {
    return begin[component][order(component, axis)];
  }
  /// Number of faces of a component along an axis. Does not throw.
  [[nodiscard]] constexpr int faces(int component, int axis) const {
    return count[component][order(component, axis)];
  }
  /// Sets both. Does not throw.
  constexpr void set(int component, int axis, int first_face, int number) {
    begin[component][order(component, axis)] = first_face;
    count[component][order(component, axis)] = number;
  }
  [[nodiscard]] bool operator==(const FaceWindow&) const = default;
};

/// Throws std::invalid_argument for cell counts outside 1 to 2^30, spacings (m) that are not positive, and
/// origins that are not finite.
void check(const StaggeredGrid& grid);

/// Axes of a checked grid; lengths in m. Does not throw.
[[nodiscard]] GridAxes grid_axes(const StaggeredGrid& grid);

/// Number of faces of velocity component `component` along `axis`. Does not throw.
[[nodiscard]] int faces_along(const StaggeredGrid& grid, int component, int axis);

/// All faces of a grid. Does not throw.
[[nodiscard]] FaceWindow whole_window(const StaggeredGrid& grid);

/// Volume of a cell, m^3. Does not throw.
[[nodiscard]] double cell_volume(const StaggeredGrid& grid);

}  // namespace drogue::coupling
