#pragma once

#include <array>
#include <vector>

namespace drogue::reference {

/// Condition at an end of an axis of cells, at the face of the outermost cell.
enum class End {
  periodic,
  neumann,    ///< zero normal derivative
  dirichlet,  ///< zero value
};

/// Box of cells, x fastest.
struct CellBox {
  std::array<int, 3> cells;
  std::array<double, 3> spacing;           ///< m
  std::array<std::array<End, 2>, 3> ends;  ///< low and high end of each axis
  /// Of the cells along each axis, m; empty: all of `spacing`.
  std::array<std::vector<double>, 3> widths = {};
  /// The values along an axis are at the low faces of cells of a periodic axis, or at the inner faces of a
  /// bounded one, which has one cell more than values; those on its ends are zero.
  std::array<bool, 3> on_faces = {};
};

/// Second-order finite-volume Laplacian of values, in their unit per m^2: the fluxes through the sides of the
/// control volume of a value, between the centres of cells if it is at a face, over its length. An axis with
/// one value at cells contributes nothing. Does not throw but std::bad_alloc.
[[nodiscard]] std::vector<double> laplacian(const CellBox& box, const std::vector<double>& values);

}  // namespace drogue::reference
