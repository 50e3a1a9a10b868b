#pragma once

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

using Tensor = std::array<Vector, 3>;

/// Deformation gradient F of a triangle: images of two orthonormal vectors in its plane at rest. The first
/// vector points along the edge from vertex 0 to vertex 1.
[[nodiscard]] std::array<Vector, 2> deformation(const std::array<Vector, 3>& rest,
                                                const std::array<Vector, 3>& now);

/// Cauchy stress F S F^T / J of the St Venant-Kirchhoff material in plane stress, N/m.
[[nodiscard]] Tensor cauchy_stress(const fabric::Material& material, const std::array<Vector, 3>& rest,
                                   const std::array<Vector, 3>& now);

/// Virial stress, N/m: minus the sum of forces, N, times positions, m, over the current area. Equals the
/// Cauchy stress for any forces of the triangle.
[[nodiscard]] Tensor virial_stress(const std::array<Vector, 3>& forces, const std::array<Vector, 3>& now);

/// Biot stress sym(R^T P), rotated by R, N/m at rest. P = J sigma F^-T is the first Piola-Kirchhoff stress,
/// and R the rotation in F = R U, with U from the eigenvectors of C.
[[nodiscard]] Tensor nominal_stress(const Tensor& cauchy, const std::array<Vector, 3>& rest,
                                    const std::array<Vector, 3>& now);

}  // namespace drogue::reference
