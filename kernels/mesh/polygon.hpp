#pragma once

#include <array>
#include <vector>

#include "kernels/mesh/mesh.hpp"

namespace drogue::mesh {

/// Triangles of a polygon of points, m, with three corners or more, which turn as it does: ears are cut off
/// along the shortest diagonal that lies inside, so that a convex quadrilateral is divided by its shorter
/// one, or by that of its first corner. Empty for a polygon that crosses itself or has no area. Throws only
/// std::bad_alloc.
[[nodiscard]] std::vector<std::array<int, 3>> triangulate(const std::vector<Vector>& points,
                                                          std::vector<int> polygon);

}  // namespace drogue::mesh
