#pragma once

#include <span>

#include "kernels/fabric/parameters.hpp"

namespace drogue::fabric {

/// Point mass on suspension lines.
struct Payload {
  Vector rest{};      ///< position at rest, m; its distances to the attachments are the rest lengths
  double mass = 0.0;  ///< kg, > 0
  double axial_stiffness = 0.0;  ///< E A of each suspension line, N, >= 0
};

/// Adds a payload to `parameters`: a vertex without triangles, which has three translational degrees of
/// freedom, and one massless line from it to each vertex of `attachments`. Returns the number of the vertex:
/// its row in all Views and vectors of a solver. Loads and pressures given per vertex do not act on it.
/// Throws std::invalid_argument if `Parameters::mass` does not cover the mesh, for a mass that is not
/// positive, a negative stiffness, a position that is not finite, no attachments and vertices out of range.
int add_payload(Parameters& parameters, const Payload& payload, std::span<const int> attachments);

}  // namespace drogue::fabric
