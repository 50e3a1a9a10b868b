#pragma once

#include "kernels/fabric/parameters.hpp"

namespace drogue::fabric {

/// The triangles one after the other, for what is asked of a triangle and not of a vertex.
struct TriangleList {
  std::array<std::vector<int>, 3> vertex;
  std::array<std::vector<double>, 3> rest;  ///< squared lengths of the edges opposite the vertices, m^2
  /// Of the springs along those edges, N/m, where the model has such; an edge of two triangles is half
  /// each's.
  std::array<std::vector<double>, 3> stiffness;
  std::vector<double> inverse_area;  ///< at rest, 1/m^2
  std::vector<int> first, around;    ///< triangles of vertex i: around[first[i]] .. around[first[i + 1] - 1]
};

[[nodiscard]] TriangleList triangle_list(const Mesh& mesh, const Material& material);

}  // namespace drogue::fabric
