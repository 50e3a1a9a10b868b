#pragma once

#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::fabric {

/// How the mass of cloth and strings is given to their vertices.
enum class Lumping {
  area,   ///< a third of each triangle and half of each line: of second order in the length of edges
  equal,  ///< the same to every vertex, as the dissertation does: of first order
};

/// Mass of every vertex, kg; `area_density` kg/m^2 of the triangles, `line_density` kg/m of the lines unless
/// the mesh has one for each. Their sum is the same for either way. With Lumping::area a vertex that is part
/// of nothing has none. Densities that are negative or not finite, or not one a line, throw
/// std::invalid_argument.
[[nodiscard]] std::vector<double> lumped_masses(const Mesh& mesh, double area_density, double line_density,
                                                Lumping lumping);

}  // namespace drogue::fabric
