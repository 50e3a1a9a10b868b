#pragma once

#include <functional>
#include <vector>

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Positions of the vertices of a surface in one piece at x, of which those within b of its open edges have
/// moved on the surface: by min(shift, b / 2) (1 - d / b) away from the nearest edge, at the distance d at
/// rest. b is the lesser of `band` and the largest d. Lengths in one unit. Edges with `is_left_out(inward)`
/// are none, for their unit vectors into the surface. Searches all edges and triangles. Vertices without
/// triangles stay.
[[nodiscard]] std::vector<Vector> inset_positions(const Mesh& mesh,
                                                  const std::function<bool(const Vector&)>& is_left_out,
                                                  double shift, double band, const std::vector<Vector>& x);

}  // namespace drogue::reference
