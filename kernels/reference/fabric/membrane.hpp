#pragma once

#include <array>
#include <complex>
#include <vector>

#include "kernels/fabric/parameters.hpp"

namespace drogue::reference {

using fabric::Mesh;
using fabric::Vector;

/// Energies as a text book writes them, of real or complex coordinates: forces are their derivatives by
/// complex steps. Every vector of vertices holds the coordinates of one vertex after the other.

/// Area of a triangle at rest, m^2.
[[nodiscard]] double area(const Vector& a, const Vector& b, const Vector& c);

/// Energy of one triangle, J, `rest` its vertices at rest: plane-stress St Venant-Kirchhoff from the
/// deformation gradient for Model::biquadratic; tensile and angular springs (Delingette 2008, eq. 8) for
/// Model::quadratic. With `tension_only` the relaxed energy of either strain (Pipkin 1986).
template <class T>
[[nodiscard]] T triangle_energy(const fabric::Material& material, const std::array<Vector, 3>& rest,
                                const std::array<std::array<T, 3>, 3>& now);

/// Energy of one spring of stiffness k, J: of its length, or for Model::linear_vector of its vector;
/// none of a short one with `tension_only`.
template <class T>
[[nodiscard]] T spring_energy(fabric::Model model, bool tension_only, double k,
                              const std::array<Vector, 2>& rest, const std::array<std::array<T, 3>, 2>& now);

/// Energy of everything, J. Edges of triangles are springs in the models that have such; an edge of two
/// triangles is one.
[[nodiscard]] double energy(const fabric::Material& material, const Mesh& mesh,
                            const std::vector<Vector>& now);

/// -dW/dx of every vertex, N.
[[nodiscard]] std::vector<Vector> forces(const fabric::Material& material, const Mesh& mesh,
                                         const std::vector<Vector>& now);

/// The edges of the triangles, each once, its lower vertex first.
[[nodiscard]] std::vector<std::array<int, 2>> triangle_edges(const Mesh& mesh);

}  // namespace drogue::reference
