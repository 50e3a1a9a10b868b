#pragma once

#include "kernels/mesh/mesh.hpp"

namespace drogue::fabric {

using mesh::Mesh;
using mesh::Vector;

/// Constitutive models of cloth.
enum class Model {
  linear_vector,  ///< Model I: springs of vectors; not invariant under rotation, for linear analysis only
  edge,           ///< Model II: springs along the edges
  quadratic,      ///< Delingette 2008: tensile and angular springs; energy quadratic in the lengths
  biquadratic,    ///< Delingette 2008: energy quadratic in squared lengths; equals St Venant-Kirchhoff
};

/// True if triangles have an energy as a whole, false if only their edges have one. Does not throw.
[[nodiscard]] constexpr bool has_triangles(Model model) {
  return model == Model::quadratic || model == Model::biquadratic;
}

/// Material of cloth and strings. `membrane_modulus` is Young's modulus times thickness.
struct Material {
  Model model = Model::biquadratic;
  double membrane_modulus = 1000.0;  ///< N/m; quadratic and biquadratic
  double poisson = 0.3;              ///< -1 .. 1/2, quadratic and biquadratic
  double stiffness = 1000.0;         ///< N/m per edge; linear_vector and edge
  double axial_stiffness = 0.0;      ///< E A of strings, N, for lines without their own stiffness
  double bending_stiffness = 0.0;    ///< N m, across inner edges; requires cloth that is flat at rest
  /// No compressive stress: the relaxed energy of triangles, and lines and edges without compression. Not for
  /// linear_vector.
  bool tension_only = false;
};

}  // namespace drogue::fabric
