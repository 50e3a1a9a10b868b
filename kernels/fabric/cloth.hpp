#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/device/memory.hpp"
#include "kernels/fabric/incidence.hpp"
#include "kernels/fabric/membrane.hpp"

namespace drogue::fabric {

/// A vector a vertex, (vertices, 3), whole slices.
template <class ExecutionSpace>
using PointsView = Kokkos::View<double* [3], Kokkos::LayoutLeft, typename ExecutionSpace::memory_space>;

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

template <class R, class Points>
KOKKOS_INLINE_FUNCTION Vector3<R> load_points(const Points& points, int i) {
  using Lanes = device::Access<R>;
  return {Lanes::load(&points(i, 0)), Lanes::load(&points(i, 1)), Lanes::load(&points(i, 2))};
}

template <class R, class Points>
KOKKOS_INLINE_FUNCTION void store_points(const Points& points, int i, const Vector3<R>& value) {
  using Lanes = device::Access<R>;
  Lanes::store(&points(i, 0), value.x);
  Lanes::store(&points(i, 1), value.y);
  Lanes::store(&points(i, 2), value.z);
}

template <class R, class Points>
KOKKOS_INLINE_FUNCTION Vector3<R> gather_points(const Points& points, const int* index) {
  using Lanes = device::Access<R>;
  return {Lanes::gather(&points(0, 0), index), Lanes::gather(&points(0, 1), index),
          Lanes::gather(&points(0, 2), index)};
}

/// `Slots` where kernels read them.
template <class ExecutionSpace, int neighbours, int values>
struct SlotViews {
  using Memory = typename ExecutionSpace::memory_space;
  Kokkos::View<int*, Memory> first;
  Kokkos::View<int* [neighbours], Kokkos::LayoutLeft, Memory> neighbour;
  Kokkos::View<double* [values], Kokkos::LayoutLeft, Memory> value;

  /// Calls `take(slot)` for the slots of vertex i and the lanes after it.
  template <class Take>
  KOKKOS_INLINE_FUNCTION void each(int i, const Take& take) const {
    for (int k = first(i / slice); k < first(i / slice + 1); ++k) take(k * slice + i % slice);
  }
};

/// What does not change while cloth moves.
template <class ExecutionSpace>
struct Cloth {
  using Points = PointsView<ExecutionSpace>;
  SlotViews<ExecutionSpace, 2, 4> triangles;
  SlotViews<ExecutionSpace, 1, 2> springs;
  Kokkos::View<double*, typename ExecutionSpace::memory_space> inverse_mass;  ///< 1/kg
  Points free;  ///< 0 where an axis is pinned, else 1
  Points load;  ///< dead force, N; may be empty
  Moduli moduli;
  Vector3<double> gravity;
  double damping;
};

/// The pull of a triangle on its first vertex, N; `to_j` and `to_k` lead from it to the other two, m, `rest`
/// are the squared lengths of the edges opposite the three, m^2.
template <Law law, class R>
KOKKOS_INLINE_FUNCTION Vector3<R> triangle_pull(const Moduli& m, const Vector3<R>& to_j,
                                                const Vector3<R>& to_k, const Edges<R>& rest,
                                                R inverse_area) {
  const Vector3<R> opposite = to_k - to_j;
  // Edge j lies opposite vertex j: it leads to k.
  const Edges<R> now{{dot(opposite, opposite), dot(to_k, to_k), dot(to_j, to_j)}};
  const Edges<R> tension = membrane_tensions<law>(m, now, rest, inverse_area);
  return tension.of[2] * to_j + tension.of[1] * to_k;
}

/// The pull of a spring on the vertex from which `edge` leads, N.
template <Law law, class R>
KOKKOS_INLINE_FUNCTION Vector3<R> spring_pull(R stiffness, R rest, const Vector3<R>& edge) {
  return spring_tension<law>(stiffness, dot(edge, edge), rest) * edge;
}

/// Squared lengths at rest of the edges of the triangle in `slot`, m^2.
template <class R, class ExecutionSpace>
KOKKOS_INLINE_FUNCTION Edges<R> rest_edges(const Cloth<ExecutionSpace>& cloth, int slot) {
  using Lanes = device::Access<R>;
  const auto& value = cloth.triangles.value;
  return {{Lanes::load(&value(slot, 0)), Lanes::load(&value(slot, 1)), Lanes::load(&value(slot, 2))}};
}

/// The elastic and dead forces on vertex i and the lanes after it, N, each vertex in the fixed order of its
/// slots. Momentum is kept to round-off: both ends of an edge, and all corners of a triangle, compute the
/// same tension.
template <Law law, class R, class ExecutionSpace, class Points>
KOKKOS_INLINE_FUNCTION Vector3<R> force(const Cloth<ExecutionSpace>& cloth, const Points& positions, int i) {
  using Lanes = device::Access<R>;
  const Vector3<R> own = load_points<R>(positions, i);
  Vector3<R> sum{R(0.0), R(0.0), R(0.0)};
  const auto to = [&](const int* neighbour) { return gather_points<R>(positions, neighbour) - own; };
  if constexpr (whole_triangles<law>)
    cloth.triangles.each(i, [&](int slot) {
      const auto& neighbour = cloth.triangles.neighbour;
      sum =
          sum + triangle_pull<law>(cloth.moduli, to(&neighbour(slot, 0)), to(&neighbour(slot, 1)),
                                   rest_edges<R>(cloth, slot), Lanes::load(&cloth.triangles.value(slot, 3)));
    });
  cloth.springs.each(i, [&](int slot) {
    const auto& value = cloth.springs.value;
    sum = sum + spring_pull<law>(Lanes::load(&value(slot, 0)), Lanes::load(&value(slot, 1)),
                                 to(&cloth.springs.neighbour(slot, 0)));
  });
  if (cloth.load.extent(0) > 0) sum = sum + load_points<R>(cloth.load, i);
  return sum;
}

/// m/s^2; zero along pinned axes.
template <Law law, class R, class ExecutionSpace, class Points>
KOKKOS_INLINE_FUNCTION Vector3<R> acceleration(const Cloth<ExecutionSpace>& cloth, const Points& positions,
                                               const Vector3<R>& velocity, int i) {
  const R inverse_mass = device::Access<R>::load(&cloth.inverse_mass(i));
  const Vector3<R> elastic = inverse_mass * force<law, R>(cloth, positions, i);
  const Vector3<R> g{R(cloth.gravity.x), R(cloth.gravity.y), R(cloth.gravity.z)};
  const Vector3<R> a = elastic + g - cloth.damping * velocity, free = load_points<R>(cloth.free, i);
  return {free.x * a.x, free.y * a.y, free.z * a.z};
}

}  // namespace drogue::fabric
