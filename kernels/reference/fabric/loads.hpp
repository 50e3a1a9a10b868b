#pragma once

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Forces of the pressures at vertices, Pa, on the current triangles, N. Each triangle contributes a third of
/// its vector area to each corner.
[[nodiscard]] std::vector<Vector> pressure_forces(const Mesh& mesh, const std::vector<double>& pressure,
                                                  const std::vector<Vector>& now);

/// Volume enclosed by a closed surface, m^3, by the divergence theorem.
[[nodiscard]] double enclosed_volume(const Mesh& mesh, const std::vector<Vector>& now);

/// Forces of dashpots along edges and lines, N, with one dashpot per pair of vertices. The magnitude is
/// `rate`, 1/s, times the reduced mass of both ends, kg, times the rate of elongation, m/s.
[[nodiscard]] std::vector<Vector> dashpot_forces(const Mesh& mesh, const std::vector<double>& mass,
                                                 double rate, const std::vector<Vector>& x,
                                                 const std::vector<Vector>& v);

}  // namespace drogue::reference
