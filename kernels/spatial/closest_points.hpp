#pragma once

#include "kernels/spatial/vector3.hpp"

namespace drogue::spatial {

/// True if the axis-aligned bounding boxes of two point sets are more than `margin` (m) apart along an axis.
template <int m, int n>
KOKKOS_INLINE_FUNCTION bool boxes_apart(const Point (&a)[m], const Point (&b)[n], double margin) {
  const auto apart = [&](auto along) {
    double low_a = along(a[0]), high_a = low_a, low_b = along(b[0]), high_b = low_b;
    for (int k = 1; k < m; ++k) {
      const double value = along(a[k]);
      low_a = value < low_a ? value : low_a, high_a = value > high_a ? value : high_a;
    }
    for (int k = 1; k < n; ++k) {
      const double value = along(b[k]);
      low_b = value < low_b ? value : low_b, high_b = value > high_b ? value : high_b;
    }
    return low_a - high_b > margin || low_b - high_a > margin;
  };
  return apart([](const Point& p) { return p.x; }) || apart([](const Point& p) { return p.y; }) ||
         apart([](const Point& p) { return p.z; });
}

/// Parameter, dimensionless in [0, 1], of the point of segment ab (m) closest to p (m); 0 for a segment of no
/// length.
KOKKOS_INLINE_FUNCTION double closest_on_segment(const Point& p, const Point& a, const Point& b) {
  const Point along = b - a;
  const double squared = dot(along, along), part = dot(p - a, along);
  if (!(part > 0.0)) return 0.0;
  return part < squared ? part / squared : 1.0;
}

/// Closest point of a triangle.
struct ClosestOnTriangle {
  double weight[3];  ///< barycentric coordinates
  double squared;    ///< distance, m^2
  bool inside;       ///< in the interior, not on an edge
};

/// Closest point of triangle t (m) to p (m). Tests every edge, then the face if p projects into it;
/// degenerate triangles cost no accuracy.
KOKKOS_INLINE_FUNCTION ClosestOnTriangle closest_on_triangle(const Point& p, const Point (&t)[3]) {
  ClosestOnTriangle best{{1.0, 0.0, 0.0}, 1e300, false};
  for (int k = 0; k < 3; ++k) {
    const int j = (k + 1) % 3;
    const double u = closest_on_segment(p, t[k], t[j]);
    const Point r = p - (t[k] + u * (t[j] - t[k]));
    if (dot(r, r) >= best.squared) continue;
    best.squared = dot(r, r);
    best.weight[0] = best.weight[1] = best.weight[2] = 0.0;
    best.weight[k] = 1.0 - u, best.weight[j] = u;
  }
  const Point normal = cross(t[1] - t[0], t[2] - t[0]);
  const double area = dot(normal, normal);
  if (!(area > 0.0)) return best;
  double weight[3];
  for (int k = 0; k < 3; ++k) {
    const Point &a = t[(k + 1) % 3], &b = t[(k + 2) % 3];
    weight[k] = dot(cross(b - a, p - a), normal) / area;
    if (!(weight[k] > 0.0)) return best;
  }
  const double sum = weight[0] + weight[1] + weight[2];
  Point r = p;
  for (int k = 0; k < 3; ++k) r = r - (weight[k] / sum) * t[k];
  if (dot(r, r) > best.squared) return best;
  for (int k = 0; k < 3; ++k) best.weight[k] = weight[k] / sum;
  best.squared = dot(r, r), best.inside = true;
  return best;
}

/// Closest points of two segments, as parameters in [0, 1].
struct ClosestOfSegments {
  double first, second;
  double squared;  ///< distance, m^2
  bool inside;     ///< both points lie in the interior of their segment
};

/// Closest points of segments p and q (m): tests all four ends, then the common perpendicular if both feet
/// lie inside.
KOKKOS_INLINE_FUNCTION ClosestOfSegments closest_of_segments(const Point (&p)[2], const Point (&q)[2]) {
  ClosestOfSegments best{0.0, 0.0, 1e300, false};
  for (int end = 0; end < 4; ++end) {
    const bool of_first = end < 2;
    const int k = end % 2;
    const Point& point = of_first ? p[k] : q[k];
    const double u = of_first ? closest_on_segment(point, q[0], q[1]) : closest_on_segment(point, p[0], p[1]);
    const Point r = point - (of_first ? q[0] + u * (q[1] - q[0]) : p[0] + u * (p[1] - p[0]));
    if (dot(r, r) < best.squared) best = {of_first ? 1.0 * k : u, of_first ? u : 1.0 * k, dot(r, r), false};
  }
  const Point d = p[1] - p[0], e = q[1] - q[0], between = p[0] - q[0];
  const double dd = dot(d, d), ee = dot(e, e), de = dot(d, e), dr = dot(d, between), er = dot(e, between);
  const double denominator = dd * ee - de * de;
  if (!(denominator > 1e-12 * dd * ee)) return best;
  const double s = (de * er - dr * ee) / denominator, u = (dd * er - de * dr) / denominator;
  if (!(s > 0.0 && s < 1.0 && u > 0.0 && u < 1.0)) return best;
  const Point r = between + s * d - u * e;
  if (dot(r, r) > best.squared) return best;
  return {s, u, dot(r, r), true};
}

}  // namespace drogue::spatial
