#pragma once

#include <Kokkos_Core.hpp>

namespace drogue::perf::ladder {

/// Vector of three numbers.
struct Point {
  double x, y, z;

  KOKKOS_FUNCTION friend Point operator-(const Point& a, const Point& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  KOKKOS_FUNCTION friend Point operator+(const Point& a, const Point& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  KOKKOS_FUNCTION friend Point operator*(double s, const Point& a) { return {s * a.x, s * a.y, s * a.z}; }
  [[nodiscard]] KOKKOS_FUNCTION double squared() const { return x * x + y * y + z * z; }
};

/// Changes of the squared lengths of a triangle's edges, opposite the vertex itself, `a` and `b`, m^2.
struct EdgeChanges {
  double q[3];
};

/// Edges of a triangle at its vertex, and the changes of their squared lengths `rest`, m^2.
struct TriangleEdges {
  Point to_b, to_a;
  EdgeChanges change;

  KOKKOS_FUNCTION TriangleEdges(const Point& at, const Point& a, const Point& b, const double* rest)
      : to_b(b - at),
        to_a(a - at),
        change{{(b - a).squared() - rest[0], to_b.squared() - rest[1], to_a.squared() - rest[2]}} {}
};

/// Force per length along the edges to b and to a, N/m.
struct Tensions {
  double along_b, along_a;
};

/// Tensions from stored stiffnesses (Delingette 2008, section 3.2): tensile ones of the edges to b and a,
/// then angular ones at the vertex, a and b, N/m^3.
KOKKOS_INLINE_FUNCTION Tensions stored_tensions(const EdgeChanges& change, const double* k) {
  const double(&q)[3] = change.q;
  return {k[0] * q[1] + k[2] * q[2] + k[4] * q[0], k[1] * q[2] + k[3] * q[0] + k[2] * q[1]};
}

/// Tensions from the squared lengths at rest, m^2, and the inverse area w, 1/m^2: with n_e, the sum of the
/// other two less that of the edge, S_e = w/16 (2 (lambda + mu) w^2/16 n_e sum(n q) + mu (2 q_e - sum(q))).
struct RecomputedTension {
  KOKKOS_FUNCTION static Tensions tensions(const EdgeChanges& change, const double* rest, double w,
                                           double two_lambda_mu, double mu) {
    const double(&q)[3] = change.q;
    const double all = rest[0] + rest[1] + rest[2], sum = q[0] + q[1] + q[2];
    const double n[3] = {all - 2.0 * rest[0], all - 2.0 * rest[1], all - 2.0 * rest[2]};
    const double area_change = two_lambda_mu * (w * w / 16.0) * (n[0] * q[0] + n[1] * q[1] + n[2] * q[2]);
    return {w / 16.0 * (area_change * n[1] + mu * (2.0 * q[1] - sum)),
            w / 16.0 * (area_change * n[2] + mu * (2.0 * q[2] - sum))};
  }
};

}  // namespace drogue::perf::ladder
