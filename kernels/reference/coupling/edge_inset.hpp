#pragma once

#include <array>
#include <vector>

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Positions, m, of the vertices of a surface at x, m, of which those within `band`, m, of an edge have
/// moved on the surface: by shift (1 - d / band) at a distance d at rest, away from the nearest edge.
/// Searches all edges and triangles.
[[nodiscard]] std::vector<Vector> inset_positions(const Mesh& mesh,
                                                  const std::vector<std::array<int, 2>>& edges, double shift,
                                                  double band, const std::vector<Vector>& x);

}  // namespace drogue::reference
