#pragma once

#include "kernels/coupling/sheet/no_slip.hpp"
#include "kernels/fabric/vertex_force.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::coupling {

/// Drag per velocity, kg/s: a symmetric matrix without negative eigenvalues.
struct DragRate {
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;

  [[nodiscard]] KOKKOS_FUNCTION double trace() const { return xx + yy + zz; }
};

/// `across` in all directions but that of the unit vector t, which has `along`.
KOKKOS_INLINE_FUNCTION DragRate drag_rate(double across, double along, const spatial::Point& t) {
  const double more = along - across;
  return {across + more * t.x * t.x, across + more * t.y * t.y, across + more * t.z * t.z,
          more * t.x * t.y,          more * t.x * t.z,          more * t.y * t.z};
}

KOKKOS_INLINE_FUNCTION DragRate operator+(const DragRate& a, const DragRate& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}

KOKKOS_INLINE_FUNCTION DragRate operator*(double factor, const DragRate& a) {
  return {factor * a.xx, factor * a.yy, factor * a.zz, factor * a.xy, factor * a.xz, factor * a.yz};
}

KOKKOS_INLINE_FUNCTION spatial::Point product(const DragRate& a, const spatial::Point& v) {
  return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
          a.xz * v.x + a.yz * v.y + a.zz * v.z};
}

/// Solution v of v + product(by, product(rate, v)) = r, elementwise in `by`, not negative, s/kg, by Cramer's
/// rule.
KOKKOS_INLINE_FUNCTION spatial::Point solve_drag(const DragRate& rate, const spatial::Point& by,
                                                 const spatial::Point& r) {
  const spatial::Point x{1.0 + by.x * rate.xx, by.y * rate.xy, by.z * rate.xz},
      y{by.x * rate.xy, 1.0 + by.y * rate.yy, by.z * rate.yz},
      z{by.x * rate.xz, by.y * rate.yz, 1.0 + by.z * rate.zz};
  const double inverse = 1.0 / dot(x, cross(y, z));
  return {inverse * dot(r, cross(y, z)), inverse * dot(x, cross(r, z)), inverse * dot(x, cross(y, r))};
}

/// Drag of lines and bodies on the vertices of a fabric in a step of the flow, on a device: `drive` - `rate`
/// v for the velocity v of a vertex, from `AirDrag`. Rows are vertices; all Views are empty without drag.
template <class ExecutionSpace>
struct DragRelaxation {
  using Memory = typename ExecutionSpace::memory_space;
  using Rates = Kokkos::View<DragRate*, Memory>;
  using Vectors = Kokkos::View<double* [3], Kokkos::LayoutLeft, Memory>;

  // Constant during the steps of the cloth in one step of the flow.
  Vectors drive;  ///< N
  Rates rate;

  Vectors path;  ///< of each vertex under drag since the beginning of the step of the flow, m

  [[nodiscard]] KOKKOS_FUNCTION bool is_empty() const { return rate.extent(0) == 0; }

  /// Velocity, m/s, of a vertex after dt of its drag by the backward Euler method. `inverse_mass`: of the
  /// vertex along each axis, 1/kg. Updates its path.
  KOKKOS_FUNCTION spatial::Point relax(const fabric::VertexStage& at,
                                       const spatial::Point& inverse_mass) const {
    const int i = at.vertex;
    const DragRate& of_vertex = rate(i);
    if (!(of_vertex.trace() > 0.0)) return at.velocity;
    const spatial::Point by = at.dt * inverse_mass;
    const spatial::Point velocity =
        solve_drag(of_vertex, by, at.velocity + product(by, spatial::load_vector(drive, i)));
    spatial::store_vector(path, i, spatial::load_vector(path, i) + at.dt * velocity);
    return velocity;
  }
};

}  // namespace drogue::coupling
