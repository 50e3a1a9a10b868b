#pragma once

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Of pressures felt by vertices, Pa, across the triangles where they are now: each triangle, one after the
/// other, gives a third of its area to each corner, N.
[[nodiscard]] std::vector<Vector> pressure_forces(const Mesh& mesh, const std::vector<double>& pressure,
                                                  const std::vector<Vector>& now);

/// Volume that a closed surface encloses, m^3, by the divergence theorem.
[[nodiscard]] double enclosed_volume(const Mesh& mesh, const std::vector<Vector>& now);

/// Of dashpots along edges and lines, each pair of vertices once, N: rate, 1/s, times the reduced mass of the
/// two ends times the rate at which the edge lengthens.
[[nodiscard]] std::vector<Vector> dashpot_forces(const Mesh& mesh, const std::vector<double>& mass,
                                                 double rate, const std::vector<Vector>& x,
                                                 const std::vector<Vector>& v);

}  // namespace drogue::reference
