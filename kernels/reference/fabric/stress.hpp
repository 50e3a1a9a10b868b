#pragma once

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

using Tensor = std::array<Vector, 3>;

/// F of a flat triangle: what it makes of two orthonormal vectors in its plane at rest, the first along the
/// edge from vertex 0 to vertex 1.
[[nodiscard]] std::array<Vector, 2> deformation(const std::array<Vector, 3>& rest,
                                                const std::array<Vector, 3>& now);

/// F S F^T / J of St Venant and Kirchhoff's material in plane stress, N/m.
[[nodiscard]] Tensor cauchy_stress(const fabric::Material& material, const std::array<Vector, 3>& rest,
                                   const std::array<Vector, 3>& now);

/// -sum of force times position over the area now: the Cauchy stress whatever the forces of the triangle come
/// from, N/m.
[[nodiscard]] Tensor virial_stress(const std::array<Vector, 3>& forces, const std::array<Vector, 3>& now);

/// The symmetric part of R^T P, turned by R: R the rotation of F, from the eigenvectors of C, P = J sigma
/// F^-T. N per metre at rest.
[[nodiscard]] Tensor nominal_stress(const Tensor& cauchy, const std::array<Vector, 3>& rest,
                                    const std::array<Vector, 3>& now);

}  // namespace drogue::reference
