#pragma once

#include <functional>
#include <vector>

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Positions of the vertices of a surface at x, of which those within `band` of its open edges have moved on
/// the surface: by shift (1 - d / band) away from the nearest edge, at the distance d at rest, and likewise
/// from the nearest one of those whose normal into the surface deviates from this direction by more than 60
/// degrees. Lengths in one unit. Edges with `is_left_out(inward)` are none, for their unit vectors into the
/// surface. Searches all edges and triangles. Vertices without triangles stay.
[[nodiscard]] std::vector<Vector> inset_positions(const Mesh& mesh,
                                                  const std::function<bool(const Vector&)>& is_left_out,
                                                  double shift, double band, const std::vector<Vector>& x);

}  // namespace drogue::reference
