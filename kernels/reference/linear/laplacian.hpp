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
};

/// Second-order Laplacian of values at the cells, in their unit per m^2. An axis with one cell contributes
/// nothing. Does not throw but std::bad_alloc.
[[nodiscard]] std::vector<double> laplacian(const CellBox& box, const std::vector<double>& values);

}  // namespace drogue::reference
