#pragma once

#include "kernels/spatial/vector3.hpp"

namespace drogue::fabric {

/// Doubled area vector (b - a) x (c - a) of a triangle, m^2. Its length is twice the area; it points to the
/// side from which a, b, c turn counter-clockwise.
template <class R>
KOKKOS_INLINE_FUNCTION spatial::Vector3<R> doubled_area_vector(const spatial::Vector3<R>& a,
                                                               const spatial::Vector3<R>& b,
                                                               const spatial::Vector3<R>& c) {
  return cross(b - a, c - a);
}

/// Area and unit normal of a triangle, or of a patch of triangles.
template <class R>
struct AreaAndNormal {
  R area;                      ///< m^2
  spatial::Vector3<R> normal;  ///< dimensionless; zero for a degenerate triangle
};

/// Area (m^2) and unit normal from a doubled area vector. Below a square of 1e-300 m^4 both are zero.
template <class R>
KOKKOS_INLINE_FUNCTION AreaAndNormal<R> area_and_normal(const spatial::Vector3<R>& doubled) {
  const R squared = dot(doubled, doubled);
  const device::Root<R> size = device::root(squared);
  const auto has_area = squared > R(1e-300);
  return {device::select(has_area, 0.5 * size.value, R(0.0)),
          device::select(has_area, size.inverse, R(0.0)) * doubled};
}

}  // namespace drogue::fabric
