#pragma once

#include "kernels/reference/coupling/grid_transfer.hpp"

namespace drogue::reference {

/// Sheet that acts as a pressure jump between the cells that it separates.
struct SharpSheet {
  std::vector<Vector> positions, velocities;  ///< of the vertices, m and m/s
  std::vector<std::array<int, 3>> triangles;
  double alpha = 0.0, beta = 0.0;  ///< porous law, Pa s/m and Pa s^2/m^2
};

/// Forces of a sharp sheet on the air.
struct SharpForces {
  FaceField density;             ///< at the faces, N/m^3
  std::vector<Vector> vertices;  ///< N
  int crossings = 0;
};

/// Forces during dt, s, in air of a density, kg/m^3, that has the velocity `air` at the faces, m/s: tests the
/// line between each pair of neighbouring centres against each triangle by the signs of volumes, in extended
/// precision. Without periodic images beyond those of the faces.
[[nodiscard]] SharpForces sharp_forces(const coupling::StaggeredGrid& grid, const SharpSheet& sheet,
                                       const FaceField& air, double density, double dt);

}  // namespace drogue::reference
