#pragma once

#include "kernels/spatial/vector3.hpp"

namespace drogue::spatial {

/// Bounding sphere of a geometric primitive, and its entry in a hash grid.
struct BoundingSphere {
  Point centre;        ///< m
  double radius;       ///< m
  std::uint64_t cell;  ///< key of the cell that holds the centre
  int next;            ///< next primitive in the chain of its bucket; -1 at the end

  /// True if the sphere comes within `distance` (m) of p.
  [[nodiscard]] KOKKOS_FUNCTION bool is_near(const Point& p, double distance) const {
    const Point r = p - centre;
    return dot(r, r) <= (distance + radius) * (distance + radius);
  }
};

/// Sphere about the centroid of some points (m), outside every grid.
template <int size>
KOKKOS_INLINE_FUNCTION BoundingSphere bounding_sphere(const Point (&points)[size]) {
  BoundingSphere sphere{{0.0, 0.0, 0.0}, 0.0, 0, -1};
  for (const Point& p : points) sphere.centre = sphere.centre + (1.0 / size) * p;
  for (const Point& p : points) {
    const double distance = length(p - sphere.centre);
    sphere.radius = distance > sphere.radius ? distance : sphere.radius;
  }
  sphere.radius *= 1.0 + 1e-12;  // margin for round-off
  return sphere;
}

}  // namespace drogue::spatial
