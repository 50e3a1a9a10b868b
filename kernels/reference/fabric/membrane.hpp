#pragma once

#include <array>
#include <complex>
#include <vector>

#include "kernels/fabric/material.hpp"

namespace drogue::reference {

using fabric::Mesh;
using fabric::Vector;

/// Elastic energies as functions of real or complex coordinates, m. Forces are their derivatives by complex
/// steps.

/// Area of a triangle at rest, m^2.
[[nodiscard]] double area(const Vector& a, const Vector& b, const Vector& c);

/// Energy of one triangle, J; `rest`: its vertices at rest. Plane-stress St Venant-Kirchhoff from the
/// deformation gradient for Model::biquadratic; tensile and angular springs (Delingette 2008, eq. 8) for
/// Model::quadratic. With `tension_only`, the relaxed energy of either strain (Pipkin 1986).
template <class T>
[[nodiscard]] T triangle_energy(const fabric::Material& material, const std::array<Vector, 3>& rest,
                                const std::array<std::array<T, 3>, 3>& now);

/// Energy of one spring of stiffness k, N/m, in J. Depends on the change of the length, or for
/// Model::linear_vector on the change of the edge vector. Zero in compression with `tension_only`.
template <class T>
[[nodiscard]] T spring_energy(fabric::Model model, bool tension_only, double k,
                              const std::array<Vector, 2>& rest, const std::array<std::array<T, 3>, 2>& now);

/// Elastic energy of a fabric, J. Models of springs have one spring per edge of the triangles.
[[nodiscard]] double energy(const fabric::Material& material, const Mesh& mesh,
                            const std::vector<Vector>& now);

/// Forces -dW/dx of all vertices, N.
[[nodiscard]] std::vector<Vector> forces(const fabric::Material& material, const Mesh& mesh,
                                         const std::vector<Vector>& now);

/// Edges of the triangles without repetition; the vertex with the lower index comes first.
[[nodiscard]] std::vector<std::array<int, 2>> triangle_edges(const Mesh& mesh);

}  // namespace drogue::reference
