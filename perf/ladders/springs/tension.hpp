#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::perf::ladder {

/// Vector of three numbers. `R` is a real type, of which tests count the operations.
template <class R>
struct PointOf {
  R x, y, z;

  KOKKOS_FUNCTION friend PointOf operator-(const PointOf& a, const PointOf& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  KOKKOS_FUNCTION friend PointOf operator+(const PointOf& a, const PointOf& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  KOKKOS_FUNCTION friend PointOf operator*(R s, const PointOf& a) { return {s * a.x, s * a.y, s * a.z}; }
  [[nodiscard]] KOKKOS_FUNCTION R squared() const { return x * x + y * y + z * z; }
};
using Point = PointOf<double>;

/// Changes of the squared lengths of a triangle's edges, opposite the vertex itself, `a` and `b`, m^2.
template <class R>
struct EdgeChangesOf {
  R q[3];
};
using EdgeChanges = EdgeChangesOf<double>;

/// Force per length along the edges to b and to a, N/m.
template <class R>
struct TensionsOf {
  R along_b, along_a;
};
using Tensions = TensionsOf<double>;

/// Edges of a triangle at its vertex, and the changes of their squared lengths `rest`, m^2.
template <class R>
struct TriangleEdges {
  PointOf<R> to_b, to_a;
  EdgeChangesOf<R> change;

  KOKKOS_FUNCTION TriangleEdges(const PointOf<R>& at, const PointOf<R>& a, const PointOf<R>& b, const R* rest)
      : to_b(b - at),
        to_a(a - at),
        change{{(b - a).squared() - rest[0], to_b.squared() - rest[1], to_a.squared() - rest[2]}} {}

  /// `sum` and the force of the tensions of these edges, N.
  [[nodiscard]] KOKKOS_FUNCTION PointOf<R> add_force(const PointOf<R>& sum,
                                                     const TensionsOf<R>& tension) const {
    return sum + tension.along_b * to_b + tension.along_a * to_a;
  }
};

/// Tensions from stored stiffnesses (Delingette 2008, section 3.2): tensile ones of the edges to b and a,
/// then angular ones at the vertex, a and b, N/m^3.
template <class R>
KOKKOS_INLINE_FUNCTION TensionsOf<R> stored_tensions(const EdgeChangesOf<R>& change, const R* k) {
  const R(&q)[3] = change.q;
  return {k[0] * q[1] + k[2] * q[2] + k[4] * q[0], k[1] * q[2] + k[3] * q[0] + k[2] * q[1]};
}

/// Tensions from the squared lengths at rest, m^2, and the inverse area w, 1/m^2: with n_e, the sum of the
/// other two less that of the edge, S_e = w/16 (2 (lambda + mu) w^2/16 n_e sum(n q) + mu (2 q_e - sum(q))).
struct RecomputedTension {
  template <class R>
  KOKKOS_FUNCTION static TensionsOf<R> tensions(const EdgeChangesOf<R>& change, const R* rest, R w,
                                                R two_lambda_mu, R mu) {
    const R(&q)[3] = change.q;
    const R all = rest[0] + rest[1] + rest[2], sum = q[0] + q[1] + q[2], share = 0.0625 * w;
    const R n[3] = {all - 2.0 * rest[0], all - 2.0 * rest[1], all - 2.0 * rest[2]};
    const R area_change = two_lambda_mu * (w * share) * (n[0] * q[0] + n[1] * q[1] + n[2] * q[2]);
    return {share * (area_change * n[1] + mu * (2.0 * q[1] - sum)),
            share * (area_change * n[2] + mu * (2.0 * q[2] - sum))};
  }
};

/// Operations per triangle around a vertex, edges and force included, counted by tests/kernels/ladders/.
inline constexpr double stored_operations = 49.0, recomputed_operations = 70.0;

}  // namespace drogue::perf::ladder
