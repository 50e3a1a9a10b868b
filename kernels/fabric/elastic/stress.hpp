#pragma once

#include "kernels/fabric/elastic/triangle_list.hpp"
#include "kernels/fabric/fabric_views.hpp"
#include "kernels/fabric/results.hpp"
#include "kernels/fabric/views.hpp"

namespace drogue::fabric {

/// Symmetric tensor in a plane.
struct PlaneTensor {
  double xx, yy, xy;
};

/// Triangle in a frame of its plane, m: vertex 0 is the origin, vertex 1 is (x1, 0), vertex 2 is (x2, y2).
struct LocalTriangle {
  double x1, x2, y2;
};

/// Triangle with given squared lengths of the edges opposite its vertices, m^2, and inverse area, 1/m^2.
KOKKOS_INLINE_FUNCTION LocalTriangle local_triangle(const Edges<double>& squared, double inverse_area) {
  const double x1 = device::square_root(squared.of[2]);
  return {x1, (squared.of[2] + squared.of[1] - squared.of[0]) / (2.0 * x1), 2.0 / (inverse_area * x1)};
}

/// Sum of tension times edge times edge divided by the area, N/m: the Cauchy stress for present edges, the
/// second Piola-Kirchhoff stress for edges at rest, in place of [Shi], eq. (2.14)-(2.16). Zero without area.
KOKKOS_INLINE_FUNCTION PlaneTensor edge_stress(const Edges<double>& tension, const LocalTriangle& f) {
  const double twice = f.x1 * f.y2, per_area = twice > 0.0 ? 2.0 / twice : 0.0, across = f.x2 - f.x1;
  const double t0 = per_area * tension.of[0], t1 = per_area * tension.of[1], t2 = per_area * tension.of[2];
  return {t2 * f.x1 * f.x1 + t1 * f.x2 * f.x2 + t0 * across * across, (t1 + t0) * f.y2 * f.y2,
          (t1 * f.x2 + t0 * across) * f.y2};
}

/// Symmetric part of R^T P (Biot 1965), force per length at rest, N/m, rotated into the present plane.
/// P = F S is the first Piola-Kirchhoff stress, R the rotation of F. U = (C + J) / sqrt(tr C + 2 J).
KOKKOS_INLINE_FUNCTION PlaneTensor nominal_stress(const PlaneTensor& s, const LocalTriangle& rest,
                                                  const LocalTriangle& now) {
  const double f11 = now.x1 / rest.x1, f22 = now.y2 / rest.y2, f12 = (now.x2 - f11 * rest.x2) / rest.y2;
  const double j = f11 * f22, sum = f11 + f22;
  const double size = device::square_root(sum * sum + f12 * f12), scale = size > 0.0 ? 1.0 / size : 0.0;
  const double u11 = scale * (f11 * f11 + j), u22 = scale * (f12 * f12 + f22 * f22 + j),
               u12 = scale * f11 * f12;
  const PlaneTensor biot{u11 * s.xx + u12 * s.xy, u12 * s.xy + u22 * s.yy,
                         0.5 * (u11 * s.xy + u12 * s.yy + u12 * s.xx + u22 * s.xy)};
  // Columns of R are (cosine, sine) and (-sine, cosine).
  const double cosine = scale * sum, sine = -scale * f12;
  const double cc = cosine * cosine, ss = sine * sine, cs = cosine * sine;
  return {cc * biot.xx + ss * biot.yy - 2.0 * cs * biot.xy, ss * biot.xx + cc * biot.yy + 2.0 * cs * biot.xy,
          cs * (biot.xx - biot.yy) + (cc - ss) * biot.xy};
}

/// Principal values, N/m, and direction (cosine, sine) of the major one; the first axis for equal values.
struct PrincipalValues {
  double major, minor, cosine, sine;
};

/// Principal values of a tensor.
KOKKOS_INLINE_FUNCTION PrincipalValues principal(const PlaneTensor& s) {
  const double half = 0.5 * (s.xx - s.yy), mean = 0.5 * (s.xx + s.yy);
  const double radius = device::square_root(half * half + s.xy * s.xy);
  // The row of the eigenvector equation without cancellation.
  const double x = half >= 0.0 ? radius + half : s.xy, y = half >= 0.0 ? s.xy : radius - half;
  const double size = device::square_root(x * x + y * y);
  const bool alike = !(size > 0.0);
  return {mean + radius, mean - radius, alike ? 1.0 : x / size, alike ? 0.0 : y / size};
}

/// Unit vector; a vector of no length stays zero.
KOKKOS_INLINE_FUNCTION Vector3<double> unit(const Vector3<double>& a) {
  const double size = device::square_root(dot(a, a));
  return (size > 0.0 ? 1.0 / size : 0.0) * a;
}

/// `TriangleList` in the memory of an execution space.
template <class ExecutionSpace>
struct TriangleViews {
  TriangleViews(const ExecutionSpace& space, const TriangleList& list)
      : vertex(table_view(space, "drogue::fabric::triangle_vertices", list.vertex)),
        rest(table_view(space, "drogue::fabric::triangle_rest", list.rest)),
        stiffness(table_view(space, "drogue::fabric::triangle_stiffness", list.stiffness)),
        inverse_area(list_view(space, "drogue::fabric::triangle_area", list.inverse_area)),
        first(list_view(space, "drogue::fabric::triangles_first", list.first)),
        around(list_view(space, "drogue::fabric::triangles_around", list.around)) {}

  TableView<ExecutionSpace, int, 3> vertex;
  TableView<ExecutionSpace, double, 3> rest, stiffness;
  ListView<ExecutionSpace, double> inverse_area;
  ListView<ExecutionSpace, int> first, around;
};

/// `major`, `minor` and both directions, one row per triangle or vertex.
template <class ExecutionSpace>
using StressView = TableView<ExecutionSpace, double, 8>;

/// Components xx, yy and xy of the tensor of a triangle, N/m, then both axes of its frame.
template <class ExecutionSpace>
using TensorView = TableView<ExecutionSpace, double, 9>;

/// Stores principal values and directions in the frame e1, e2.
template <class View>
KOKKOS_INLINE_FUNCTION void store_stress(const View& view, int i, const PrincipalValues& p,
                                         const Vector3<double>& e1, const Vector3<double>& e2) {
  const Vector3<double> direction = p.cosine * e1 + p.sine * e2, across = p.cosine * e2 - p.sine * e1;
  view(i, 0) = p.major, view(i, 1) = p.minor;
  view(i, 2) = direction.x, view(i, 3) = direction.y, view(i, 4) = direction.z;
  view(i, 5) = across.x, view(i, 6) = across.y, view(i, 7) = across.z;
}

/// Stress of each triangle.
template <class ExecutionSpace, ConstitutiveModel model>
struct StressFunctor {
  TriangleViews<ExecutionSpace> triangles;
  PointsView<ExecutionSpace> x;
  Moduli moduli;
  StressMeasure measure;
  StressView<ExecutionSpace> out;
  TensorView<ExecutionSpace> tensor;  ///< may be empty

  KOKKOS_FUNCTION void operator()(const int t) const {
    const auto vertex = [&](int k) { return load_points<double>(x, triangles.vertex(t, k)); };
    const Vector3<double> origin = vertex(0), along = vertex(1) - origin, aside = vertex(2) - origin,
                          opposite = aside - along;
    const Vector3<double> e1 = unit(along);
    const double x2 = dot(aside, e1);
    const Vector3<double> height = aside - x2 * e1, e2 = unit(height);
    const LocalTriangle now{dot(along, e1), x2, dot(height, e2)};
    const Edges<double> squared{{dot(opposite, opposite), dot(aside, aside), dot(along, along)}};
    const Edges<double> rest{{triangles.rest(t, 0), triangles.rest(t, 1), triangles.rest(t, 2)}};
    const double inverse_area = triangles.inverse_area(t);
    Edges<double> tension;
    if constexpr (whole_triangles<model>)
      tension = membrane_tensions<model>(moduli, squared, rest, inverse_area);
    else
      for (int e = 0; e < 3; ++e)
        tension.of[e] =
            spring_tension<model>(triangles.stiffness(t, e), squared.of[e], device::square_root(rest.of[e]));
    const LocalTriangle at_rest = local_triangle(rest, inverse_area);
    const PlaneTensor stress = measure == StressMeasure::cauchy
                                   ? edge_stress(tension, now)
                                   : nominal_stress(edge_stress(tension, at_rest), at_rest, now);
    store_stress(out, t, principal(stress), e1, e2);
    if (tensor.extent(0) == 0) return;
    const double values[9] = {stress.xx, stress.yy, stress.xy, e1.x, e1.y, e1.z, e2.x, e2.y, e2.z};
    for (int k = 0; k < 9; ++k) tensor(t, k) = values[k];
  }
};

/// Stress at each vertex: the mean over its triangles in the order of the mesh, weighted by their areas at
/// rest, in the plane normal to their mean normal. The triangles of a mesh file may have opposite
/// orientations, so each normal is flipped to the side of the previous ones; a fold by more than a right
/// angle counts as flat. Zero for vertices without triangles.
template <class ExecutionSpace>
struct VertexStressFunctor {
  TriangleViews<ExecutionSpace> triangles;
  TensorView<ExecutionSpace> tensor;
  StressView<ExecutionSpace> out;

  KOKKOS_FUNCTION Vector3<double> axis(int t, int e) const {
    return {tensor(t, 3 * e + 3), tensor(t, 3 * e + 4), tensor(t, 3 * e + 5)};
  }

  KOKKOS_FUNCTION void operator()(const int i) const {
    const int begin = triangles.first(i), end = triangles.first(i + 1);
    Vector3<double> normal{0.0, 0.0, 0.0};
    for (int k = begin; k < end; ++k) {
      const int t = triangles.around(k);
      const Vector3<double> own = cross(axis(t, 0), axis(t, 1));
      normal = normal + (dot(own, normal) < 0.0 ? -1.0 : 1.0) / triangles.inverse_area(t) * own;
    }
    normal = unit(normal);
    // The first axis is the one of the first triangle, projected to the plane.
    const Vector3<double> hint = begin < end ? axis(triangles.around(begin), 0) : normal;
    const Vector3<double> e1 = unit(hint - dot(hint, normal) * normal), e2 = cross(normal, e1);
    PlaneTensor sum{0.0, 0.0, 0.0};
    double area = 0.0;
    for (int k = begin; k < end; ++k) {
      const int t = triangles.around(k);
      const double weight = 1.0 / triangles.inverse_area(t);
      const double a1 = dot(axis(t, 0), e1), b1 = dot(axis(t, 1), e1), a2 = dot(axis(t, 0), e2),
                   b2 = dot(axis(t, 1), e2);
      const double xx = tensor(t, 0), yy = tensor(t, 1), xy = tensor(t, 2);
      sum.xx += weight * (a1 * a1 * xx + b1 * b1 * yy + 2.0 * a1 * b1 * xy);
      sum.yy += weight * (a2 * a2 * xx + b2 * b2 * yy + 2.0 * a2 * b2 * xy);
      sum.xy += weight * (a1 * a2 * xx + b1 * b2 * yy + (a1 * b2 + b1 * a2) * xy);
      area += weight;
    }
    const double scale = area > 0.0 ? 1.0 / area : 0.0;
    store_stress(out, i, principal({scale * sum.xx, scale * sum.yy, scale * sum.xy}), e1, e2);
  }
};

}  // namespace drogue::fabric
