#pragma once

#include <cmath>

#include "kernels/mesh/mesh.hpp"
#include "kernels/spatial/vector3.hpp"

namespace drogue::mesh {

/// Vector from one vertex to another at rest, m. Does not throw.
[[nodiscard]] inline spatial::Vector3<double> edge_vector(const Mesh& mesh, int from, int to) {
  const Vector &a = mesh.rest[static_cast<std::size_t>(from)], &b = mesh.rest[static_cast<std::size_t>(to)];
  return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
}

/// Euclidean norm without overflow or underflow of the squares, in the unit of v. Does not throw.
[[nodiscard]] inline double stable_norm(const spatial::Vector3<double>& v) {
  return std::hypot(v.x, v.y, v.z);
}

}  // namespace drogue::mesh
