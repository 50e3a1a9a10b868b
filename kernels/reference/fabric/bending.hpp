#pragma once

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Energy of bending across every edge of two triangles, J, from the mean curvature that each hinge has by
/// the heights of its triangles at rest (Bergou et al. 2006): with the top t of a triangle and h its height
/// over the point f of the edge at rest, u = (x_t - x_f) / h, a hinge has |e|^2 / (A_0 + A_1) * |u_0 + u_1|^2
/// / 2 times the stiffness. Tops are the vertices across, f is moved with the edge.
[[nodiscard]] double bending_energy(double stiffness, const Mesh& mesh, const std::vector<Vector>& now);

/// -dW/dx by central differences, which are exact for an energy of second degree, N.
[[nodiscard]] std::vector<Vector> bending_forces(double stiffness, const Mesh& mesh,
                                                 const std::vector<Vector>& now);

}  // namespace drogue::reference
