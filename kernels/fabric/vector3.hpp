#pragma once

#include "kernels/device/pack.hpp"

namespace drogue::fabric {

/// One vector of `lanes` vertices.
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
  friend KOKKOS_INLINE_FUNCTION R dot(const Vector3& a, const Vector3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
};

template <class R>
KOKKOS_INLINE_FUNCTION Vector3<R> cross(const Vector3<R>& a, const Vector3<R>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Inverse area, 1/m^2, of a triangle between two edges, m, from one corner; 0 for a triangle without area.
/// All callers share it, so that the exact build gives them the same bits.
template <class R>
KOKKOS_INLINE_FUNCTION R inverse_area(const Vector3<R>& a, const Vector3<R>& b) {
  const Vector3<R> normal = cross(a, b);
  const R squared = dot(normal, normal);
  return device::select(squared > R(0.0), 2.0 * device::root(squared).inverse, R(0.0));
}

}  // namespace drogue::fabric
