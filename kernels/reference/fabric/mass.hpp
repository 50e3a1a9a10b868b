#pragma once

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Sums of the rows of the consistent mass matrix of linear elements, kg: the integrals of density times
/// shape functions, by the rule of the edges' midpoints, which is exact here. A density that the mesh has of
/// each line counts in place of `line_density`.
[[nodiscard]] std::vector<double> row_sum_masses(const Mesh& mesh, double area_density, double line_density);

}  // namespace drogue::reference
