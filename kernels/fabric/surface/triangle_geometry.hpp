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

/// Unit normal from a doubled area vector, m^2, of a triangle or of a patch of triangles. Zero below a square
/// of 1e-300 m^4.
template <class R>
KOKKOS_INLINE_FUNCTION spatial::Vector3<R> unit_normal(const spatial::Vector3<R>& doubled) {
  const R squared = dot(doubled, doubled);
  return device::select(squared > R(1e-300), device::root(squared).inverse, R(0.0)) * doubled;
}

}  // namespace drogue::fabric
