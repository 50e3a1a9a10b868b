#pragma once

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Bending energy of all edges shared by two triangles, J (Bergou et al. 2006). `stiffness` in N m. A hinge
/// has the energy stiffness / 2 * |e|^2 / (A_0 + A_1) * |u_0 + u_1|^2, with u = (x_t - x_f) / h. Here t is
/// the vertex of a triangle opposite the edge e, h its height at rest, and f the foot of the height, which
/// keeps its barycentric coordinates on the edge.
[[nodiscard]] double bending_energy(double stiffness, const Mesh& mesh, const std::vector<Vector>& now);

/// Forces -dW/dx, N, by central differences, which are exact for this quadratic energy.
[[nodiscard]] std::vector<Vector> bending_forces(double stiffness, const Mesh& mesh,
                                                 const std::vector<Vector>& now);

}  // namespace drogue::reference
