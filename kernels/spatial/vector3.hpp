#pragma once

#include "kernels/device/pack.hpp"

namespace drogue::spatial {

/// Vector of three Cartesian components in any unit. R is a double, a dual number or a pack of lanes.
template <class R>
struct Vector3 {
  R x, y, z;

  friend KOKKOS_INLINE_FUNCTION Vector3 operator+(const Vector3& a, const Vector3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend KOKKOS_INLINE_FUNCTION Vector3 operator-(const Vector3& a, const Vector3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  template <class S>
  friend KOKKOS_INLINE_FUNCTION Vector3 operator*(S s, const Vector3& a) {
    return {s * a.x, s * a.y, s * a.z};
  }
  /// Scalar product, in the product of the units of a and b.
  friend KOKKOS_INLINE_FUNCTION R dot(const Vector3& a, const Vector3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
};

/// Position or difference of positions, m.
using Point = Vector3<double>;

/// Cross product, in the product of the units of a and b.
template <class R>
KOKKOS_INLINE_FUNCTION Vector3<R> cross(const Vector3<R>& a, const Vector3<R>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Euclidean norm, m. Squares overflow beyond 1e154.
KOKKOS_INLINE_FUNCTION double length(const Point& a) { return Kokkos::sqrt(dot(a, a)); }

/// Inverse area of the triangle that two edges (m) span, 1/m^2; 0 for a degenerate triangle.
/// For slivers it has less round-off than `fabric::inverse_area` of scalar products; the bits differ.
template <class R>
KOKKOS_INLINE_FUNCTION R inverse_area(const Vector3<R>& a, const Vector3<R>& b) {
  const Vector3<R> normal = cross(a, b);
  const R squared = dot(normal, normal);
  return device::select(squared > R(0.0), 2.0 * device::root(squared).inverse, R(0.0));
}

}  // namespace drogue::spatial
