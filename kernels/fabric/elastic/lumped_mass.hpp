#pragma once

#include <vector>

#include "kernels/fabric/material.hpp"

namespace drogue::fabric {

/// Distribution of the mass of cloth and strings to their vertices.
enum class Lumping {
  area,   ///< a third of each triangle and half of each line: second order in the edge length
  equal,  ///< equal masses, as in [Shi]: first order
};

/// Mass of every vertex, kg, for triangles of `area_density`, kg/m^2, and lines of `line_density`, kg/m, or
/// of their own density in the mesh. The total does not depend on `lumping`. With Lumping::area a vertex
/// without triangles and lines has no mass. Throws std::invalid_argument for densities that are negative or
/// not finite and for a wrong number of densities.
[[nodiscard]] std::vector<double> lumped_masses(const Mesh& mesh, double area_density, double line_density,
                                                Lumping lumping);

}  // namespace drogue::fabric
