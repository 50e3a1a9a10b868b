#pragma once

#include "kernels/fabric/stress.hpp"
#include "kernels/fabric/triangle_list.hpp"
#include "kernels/fabric/views.hpp"

namespace drogue::fabric {

/// What the kernels of stress read: `TriangleList` where they run.
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

/// `major`, `minor` and the directions of both, one row a triangle or a vertex.
template <class ExecutionSpace>
using StressView = TableView<ExecutionSpace, double, 8>;

/// xx, yy and xy of a triangle's tensor, then both axes of the frame in which it is.
template <class ExecutionSpace>
using TensorView = TableView<ExecutionSpace, double, 9>;

template <class View>
KOKKOS_INLINE_FUNCTION void store_stress(const View& view, int i, const Principal& p,
                                         const Vector3<double>& e1, const Vector3<double>& e2) {
  const Vector3<double> direction = p.cosine * e1 + p.sine * e2, across = p.cosine * e2 - p.sine * e1;
  view(i, 0) = p.major, view(i, 1) = p.minor;
  view(i, 2) = direction.x, view(i, 3) = direction.y, view(i, 4) = direction.z;
  view(i, 5) = across.x, view(i, 6) = across.y, view(i, 7) = across.z;
}

/// The stress of each triangle.
template <class ExecutionSpace, ConstitutiveModel law>
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
    const Flat now{dot(along, e1), x2, dot(height, e2)};
    const Edges<double> squared{{dot(opposite, opposite), dot(aside, aside), dot(along, along)}};
    const Edges<double> rest{{triangles.rest(t, 0), triangles.rest(t, 1), triangles.rest(t, 2)}};
    const double inverse_area = triangles.inverse_area(t);
    Edges<double> tension;
    if constexpr (whole_triangles<law>)
      tension = membrane_tensions<law>(moduli, squared, rest, inverse_area);
    else
      for (int e = 0; e < 3; ++e)
        tension.of[e] =
            spring_tension<law>(triangles.stiffness(t, e), squared.of[e], device::square_root(rest.of[e]));
    const Flat at_rest = flat(rest, inverse_area);
    const Plane stress = measure == StressMeasure::cauchy
                             ? edge_stress(tension, now)
                             : nominal_stress(edge_stress(tension, at_rest), at_rest, now);
    store_stress(out, t, principal(stress), e1, e2);
    if (tensor.extent(0) == 0) return;
    const double values[9] = {stress.xx, stress.yy, stress.xy, e1.x, e1.y, e1.z, e2.x, e2.y, e2.z};
    for (int k = 0; k < 9; ++k) tensor(t, k) = values[k];
  }
};

/// The stress at each vertex: the mean over its triangles, weighted by their areas at rest and in the order
/// of the mesh, in the plane across their mean normal. Stress has no side, and in a mesh of a file neighbours
/// may turn against one another: each normal counts on the side of those before it. So a fold by more than a
/// right angle is laid flat, as it lies. Without triangles there is none.
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
    // The first axis is the one of the first triangle, laid into the plane.
    const Vector3<double> hint = begin < end ? axis(triangles.around(begin), 0) : normal;
    const Vector3<double> e1 = unit(hint - dot(hint, normal) * normal), e2 = cross(normal, e1);
    Plane sum{0.0, 0.0, 0.0};
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
