#pragma once

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Row sums of the consistent mass matrix of linear elements, kg. Quadrature at the midpoints of the edges,
/// which is exact for products of linear shape functions. Densities in kg/m^2 and kg/m; those of single lines
/// in the mesh replace `line_density`.
[[nodiscard]] std::vector<double> row_sum_masses(const Mesh& mesh, double area_density, double line_density);

}  // namespace drogue::reference
