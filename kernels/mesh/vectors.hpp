#pragma once

#include <cstddef>
#include <vector>

#include "kernels/mesh/mesh.hpp"

namespace drogue::mesh {

/// Point of an index, m. Does not throw.
inline const Vector& at(const std::vector<Vector>& points, int i) {
  return points[static_cast<std::size_t>(i)];
}

/// Scalar product. Does not throw.
inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Vector product. Does not throw.
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// a - b. Does not throw.
inline Vector difference(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

}  // namespace drogue::mesh
