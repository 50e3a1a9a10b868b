#pragma once

#include "kernels/fabric/material.hpp"

namespace drogue::fabric {

/// Triangles in the order of the mesh, for quantities per triangle.
struct TriangleList {
  std::array<std::vector<int>, 3> vertex;
  std::array<std::vector<double>, 3> rest;  ///< squared lengths of the edges opposite the vertices, m^2
  /// Stiffness of the springs along these edges, N/m, in Model::edge; triangles share a common edge equally.
  std::array<std::vector<double>, 3> stiffness;
  std::vector<double> inverse_area;  ///< at rest, 1/m^2
  std::vector<int> first, around;    ///< triangles of vertex i: around[first[i]] .. around[first[i + 1] - 1]
};

/// Triangle list of a mesh. Throws only std::bad_alloc.
[[nodiscard]] TriangleList triangle_list(const Mesh& mesh, const Material& material);

}  // namespace drogue::fabric
