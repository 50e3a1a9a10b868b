#include "kernels/fabric/elastic/elongation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/mesh/edge_vector.hpp"

namespace drogue::fabric {

double largest_elongation(const Mesh& mesh, std::span<const std::array<int, 3>> triangles,
                          std::span<const Vector> positions) {
  const auto from_to = [&](int from, int to) {
    const Vector &a = positions[static_cast<std::size_t>(from)], &b = positions[static_cast<std::size_t>(to)];
    return spatial::Vector3<double>{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  };
  double largest = 0.0;
  for (const auto& [a, b, c] : triangles) {
    const auto first = edge_vector(mesh, a, b), second = edge_vector(mesh, a, c);
    const double base = mesh::stable_norm(first), along = dot(first, second) / base,
                 height = mesh::stable_norm(cross(first, second)) / base;
    // Derivatives of the place along two orthonormal directions in the plane at rest, and the larger
    // eigenvalue of their products.
    const auto u = (1.0 / base) * from_to(a, b), v = (1.0 / height) * (from_to(a, c) - along * u);
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
    const double squared = 0.5 * (uu + vv) + std::hypot(0.5 * (uu - vv), uv);
    largest = std::max(largest, std::sqrt(squared) - 1.0);
  }
  return largest;
}

}  // namespace drogue::fabric
