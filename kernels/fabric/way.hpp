#pragma once

#include <cmath>

#include "kernels/fabric/parameters.hpp"
#include "kernels/fabric/vector3.hpp"

namespace drogue::fabric {

/// From one vertex to another at rest, m.
[[nodiscard]] inline Vector3<double> way(const Mesh& mesh, int from, int to) {
  const Vector &a = mesh.rest[static_cast<std::size_t>(from)], &b = mesh.rest[static_cast<std::size_t>(to)];
  return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

/// The length of a vector, however large or small.
[[nodiscard]] inline double size_of(const Vector3<double>& v) { return std::hypot(v.x, v.y, v.z); }

}  // namespace drogue::fabric
