#pragma once

#include <Kokkos_Core.hpp>

#include "kernels/device/memory.hpp"
#include "kernels/device/warp.hpp"
#include "kernels/fabric/elastic/membrane.hpp"
#include "kernels/fabric/elastic/sliced_ell_views.hpp"
#include "kernels/spatial/vector3.hpp"

namespace drogue::fabric {

using spatial::Vector3;

/// One vector per vertex, (vertices, 3), padded to whole slices of vertices.
template <class ExecutionSpace>
using PointsView = Kokkos::View<double* [3], Kokkos::LayoutLeft, typename ExecutionSpace::memory_space>;

/// Table of points: rows of three numbers.
template <class Points>
concept Table = requires(const Points& points) {
  points(0, 2);
};

/// Rows i and those of the lanes after it.
template <class R, Table Points>
KOKKOS_INLINE_FUNCTION Vector3<R> load_points(const Points& points, int i) {
  using Lanes = device::Access<R>;
  return {Lanes::load(&points(i, 0)), Lanes::load(&points(i, 1)), Lanes::load(&points(i, 2))};
}

/// Stores rows i and those of the lanes after it.
template <class R, class Points>
KOKKOS_INLINE_FUNCTION void store_points(const Points& points, int i, const Vector3<R>& value) {
  using Lanes = device::Access<R>;
  Lanes::store(&points(i, 0), value.x);
  Lanes::store(&points(i, 1), value.y);
  Lanes::store(&points(i, 2), value.z);
}

/// Rows with one index per lane.
template <class R, Table Points>
KOKKOS_INLINE_FUNCTION Vector3<R> gather_points(const Points& points,
                                                typename device::Access<R>::Index index) {
  using Lanes = device::Access<R>;
  return {Lanes::gather(&points(0, 0), index), Lanes::gather(&points(0, 1), index),
          Lanes::gather(&points(0, 2), index)};
}

/// Points extrapolated with their velocities over `time`, s.
template <class Points>
struct ExtrapolatedPoints {
  Points x, v;
  double time;
};
template <class R, class Points>
KOKKOS_INLINE_FUNCTION Vector3<R> load_points(const ExtrapolatedPoints<Points>& points, int i) {
  return load_points<R>(points.x, i) + points.time * load_points<R>(points.v, i);
}
template <class R, class Points>
KOKKOS_INLINE_FUNCTION Vector3<R> gather_points(const ExtrapolatedPoints<Points>& points,
                                                typename device::Access<R>::Index index) {
  return gather_points<R>(points.x, index) + points.time * gather_points<R>(points.v, index);
}

/// Triangle at rest: products of the edges from its first vertex, m^2, and inverse area, 1/m^2.
template <class R>
struct RestTriangle {
  GramMatrix<R> products;
  R inverse_area;
};

/// Edge from a vertex to a neighbour, m, and its squared length, m^2.
template <class R>
struct EdgeVector {
  Vector3<R> to;
  R squared;
  typename device::Access<R>::Index neighbour;
};

/// Triangle at rest from the values that a slot of a ring stores; `before` and `next` are squared lengths of
/// the edges to the two neighbours, m^2.
template <class R, class Values>
KOKKOS_INLINE_FUNCTION RestTriangle<R> stored_triangle(const Values& value, R before, R next, int slot) {
  using Lanes = device::Access<R>;
  return {{before, Lanes::load(&value(slot, 1)), next}, Lanes::load(&value(slot, 2))};
}

/// Edge from the position `own`, m, to a neighbour.
template <class R, class Points>
KOKKOS_FORCEINLINE_FUNCTION EdgeVector<R> edge_to(const Points& points, const Vector3<R>& own,
                                                  typename device::Access<R>::Index neighbour) {
  const Vector3<R> to = gather_points<R>(points, neighbour) - own;
  return {to, dot(to, to), neighbour};
}

/// Constant tables and parameters of a fabric.
template <class ExecutionSpace>
struct FabricViews {
  using Points = PointsView<ExecutionSpace>;
  SlicedEllViews<ExecutionSpace, 3> triangles;  ///< without values on a device, which is memory-bound
  SlicedEllViews<ExecutionSpace, 2> springs;
  Points rest;                                                                    ///< m; empty on a host
  Kokkos::View<double*, typename ExecutionSpace::memory_space> inverse_mass;      ///< 1/kg
  Kokkos::View<std::uint8_t*, typename ExecutionSpace::memory_space> fixed_dofs;  ///< axes: 1 x, 2 y, 4 z
  Points load;  ///< dead force, N; may be empty
  Moduli moduli;
  Vector3<double> gravity;
  double damping;

  /// Edge to a neighbour of vertex i at rest, as `rest_triangle` needs it.
  template <class R>
  KOKKOS_INLINE_FUNCTION auto rest_edge(int i, int slot, typename device::Access<R>::Index neighbour) const {
    if constexpr (device::is_host<ExecutionSpace>)
      return device::Access<R>::load(&triangles.value(slot, 0));
    else
      return edge_to<R>(rest, load_points<R>(rest, i), neighbour);
  }
  /// Triangle at rest from two edges that follow one another in a ring.
  template <class R, class RestEdge>
  KOKKOS_INLINE_FUNCTION RestTriangle<R> rest_triangle(const RestEdge& before, const RestEdge& next,
                                                       int slot) const {
    if constexpr (device::is_host<ExecutionSpace>) {
      return stored_triangle(triangles.value, before, next, slot);
    } else {
      const GramMatrix<R> products{before.squared, dot(before.to, next.to), next.squared};
      return {products, inverse_area(products)};
    }
  }
};

/// 1 along free axes of a vertex and the lanes after it, 0 along fixed ones.
template <class R>
KOKKOS_INLINE_FUNCTION Vector3<R> free_axes(const std::uint8_t* fixed_dofs) {
  using Lanes = device::Access<R>;
  return {Lanes::unless_set(fixed_dofs, 1U), Lanes::unless_set(fixed_dofs, 2U),
          Lanes::unless_set(fixed_dofs, 4U)};
}
template <class R, class ExecutionSpace>
KOKKOS_INLINE_FUNCTION Vector3<R> free_axes(const FabricViews<ExecutionSpace>& fabric, int i) {
  return free_axes<R>(&fabric.fixed_dofs(i));
}

/// Force of a triangle on its first vertex, N.
template <ConstitutiveModel model, class R>
KOKKOS_INLINE_FUNCTION Vector3<R> triangle_force(const Moduli& m, const EdgeVector<R>& j,
                                                 const EdgeVector<R>& k, const RestTriangle<R>& rest) {
  const GramMatrix<R> now{j.squared, dot(j.to, k.to), k.squared};
  if constexpr (model.model == Model::biquadratic && !model.tension_only) {
    const EdgePairTensions<R> tension = edge_pair_tensions(m, now, rest.products, rest.inverse_area);
    return tension.j * j.to + tension.k * k.to;
  } else {
    // Edge j is opposite vertex j: it ends in k.
    const Edges<R> tension =
        membrane_tensions<model>(m, squared_edges(now), squared_edges(rest.products), rest.inverse_area);
    return tension.of[2] * j.to + tension.of[1] * k.to;
  }
}

/// Force of a spring on the start of `edge`, N.
template <ConstitutiveModel model, class R>
KOKKOS_INLINE_FUNCTION Vector3<R> spring_force(R stiffness, R rest, const Vector3<R>& edge) {
  return spring_tension<model>(stiffness, dot(edge, edge), rest) * edge;
}

/// Calls `visit(j, k, rest)` for the triangles of vertex i and the lanes after it, with the values of `read`
/// for both neighbours and the triangle at rest.
template <class R, class Fabric, class Read, class Visit>
KOKKOS_INLINE_FUNCTION void each_side_by_side(const Fabric& fabric, int i, const Read& read,
                                              const Visit& visit) {
  using Lanes = device::Access<R>;
  using Index = typename Lanes::Index;
  struct Side {
    decltype(read(Index{})) now;
    decltype(fabric.template rest_edge<R>(0, 0, Index{})) rest;
  };
  fabric.triangles.each_pair(
      i, [&](int slot) { return Lanes::index(&fabric.triangles.neighbour(slot)); },
      [&](int slot, Index neighbour) {
        return Side{read(neighbour), fabric.template rest_edge<R>(i, slot, neighbour)};
      },
      [&](const Side& j, const Side& k, int slot) {
        visit(j.now, k.now, fabric.template rest_triangle<R>(j.rest, k.rest, slot));
      });
}

/// Calls `visit(j, k, rest)` for the triangles of vertex i and the lanes after it, with their edges.
template <class R, class Fabric, class Points, class Visit>
KOKKOS_INLINE_FUNCTION void each_triangle(const Fabric& fabric, const Points& positions, int i,
                                          const Visit& visit) {
  const Vector3<R> own = load_points<R>(positions, i);
  using Index = typename device::Access<R>::Index;
  each_side_by_side<R>(
      fabric, i, [&](Index neighbour) { return edge_to<R>(positions, own, neighbour); }, visit);
}

/// Spring from a vertex to a neighbour.
template <class R>
struct Spring {
  R stiffness, rest;  ///< N/m; length at rest, m
  Vector3<R> edge;    ///< m
};

/// Function that reads the spring of a slot of vertex i and the lanes after it.
template <class R, class Springs, class Points>
KOKKOS_INLINE_FUNCTION auto spring_reader(const Springs& springs, const Points& positions, int i) {
  using Lanes = device::Access<R>;
  return [&springs, &positions, i](int slot) {
    return Spring<R>{
        Lanes::load(&springs.value(slot, 0)), Lanes::load(&springs.value(slot, 1)),
        gather_points<R>(positions, Lanes::index(&springs.neighbour(slot))) - load_points<R>(positions, i)};
  };
}

/// Force of a spring on its vertex, N.
template <ConstitutiveModel model, class R>
KOKKOS_INLINE_FUNCTION Vector3<R> spring_force(const Spring<R>& of) {
  return spring_force<model>(of.stiffness, of.rest, of.edge);
}

/// `sum` plus the forces of the springs on vertex i and the lanes after it, N, in the order of their slots.
template <ConstitutiveModel model, class R, class Fabric, class Points>
KOKKOS_INLINE_FUNCTION Vector3<R> with_springs(const Fabric& fabric, const Points& positions, int i,
                                               Vector3<R> sum) {
  const auto& springs = fabric.springs;
  springs.each_read(i, spring_reader<R>(springs, positions, i),
                    [&](const Spring<R>& spring) { sum = sum + spring_force<model>(spring); });
  return sum;
}

/// Sum as above on a device, for a slice of vertices by all threads of a warp together. Each thread adds a
/// dozen springs of its vertex. The warp shares longer rows, such as that of a payload on its lines: each
/// thread computes one force, and the thread of the vertex adds them in the order of their slots.
template <ConstitutiveModel model, class Springs, class Points>
KOKKOS_INLINE_FUNCTION Vector3<double> with_springs_of_warp(const Springs& springs, const Points& positions,
                                                            int i, Vector3<double> sum) {
  constexpr int most_own = 12;
  const int lane = i % slice, begin = springs.first(i / slice), end = springs.first(i / slice + 1),
            shared = device::minimum(begin + most_own, end);
  for_each_read_slot(begin, shared, i, spring_reader<double>(springs, positions, i),
                     [&](const Spring<double>& spring) { sum = sum + spring_force<model>(spring); });
  if (shared == end) return sum;
  unsigned rows = device::warp_ballot(springs.neighbour(shared * slice + lane) != i);
  for (int row = 0; rows != 0U; ++row, rows >>= 1U) {
    if ((rows & 1U) == 0U) continue;
    const auto read = spring_reader<double>(springs, positions, i - lane + row);
    for (int k = shared; k < end; k += slice) {
      Vector3<double> own{0.0, 0.0, 0.0};
      if (k + lane < end) own = spring_force<model>(read((k + lane) * slice + row));
      for (int n = 0; n < slice && k + n < end; ++n) {
        const Vector3<double> force_of_lane{device::shuffle(own.x, n), device::shuffle(own.y, n),
                                            device::shuffle(own.z, n)};
        if (lane == row) sum = sum + force_of_lane;
      }
    }
  }
  return sum;
}

template <ConstitutiveModel model, class ExecutionSpace, class Points>
requires(!device::is_host<ExecutionSpace>) KOKKOS_INLINE_FUNCTION Vector3<double> with_springs(
    const FabricViews<ExecutionSpace>& fabric, const Points& positions, int i, const Vector3<double>& sum) {
  return with_springs_of_warp<model>(fabric.springs, positions, i, sum);
}

/// Elastic forces on vertex i and the lanes after it, N, summed in the fixed order of slots. Momentum is
/// conserved to round-off: both ends of an edge, and all corners of a triangle, compute the same tension.
/// `Fabric` is `FabricViews`, whose kernels are launched by `launch_packs`, or has its members in other
/// memory (`TeamFabric`).
template <ConstitutiveModel model, class R, class Fabric, class Points>
KOKKOS_INLINE_FUNCTION Vector3<R> elastic_force(const Fabric& fabric, const Points& positions, int i) {
  Vector3<R> sum{R(0.0), R(0.0), R(0.0)};
  if constexpr (whole_triangles<model>)
    each_triangle<R>(fabric, positions, i,
                     [&](const EdgeVector<R>& j, const EdgeVector<R>& k, const RestTriangle<R>& rest) {
                       sum = sum + triangle_force<model>(fabric.moduli, j, k, rest);
                     });
  return with_springs<model>(fabric, positions, i, sum);
}

/// Values of two states.
template <class T>
struct StatePair {
  T first, second;
};
/// Elastic forces in two states, N, which read the neighbours and triangles at rest once.
template <ConstitutiveModel model, class R, class Fabric, class First, class Second>
KOKKOS_INLINE_FUNCTION StatePair<Vector3<R>> elastic_forces(const Fabric& fabric, const First& first,
                                                            const Second& second, int i) {
  StatePair<Vector3<R>> sum{{R(0.0), R(0.0), R(0.0)}, {R(0.0), R(0.0), R(0.0)}};
  if constexpr (whole_triangles<model>) {
    using EdgeVectors = StatePair<EdgeVector<R>>;
    const StatePair<Vector3<R>> own{load_points<R>(first, i), load_points<R>(second, i)};
    each_side_by_side<R>(
        fabric, i,
        [&](typename device::Access<R>::Index neighbour) {
          return EdgeVectors{edge_to<R>(first, own.first, neighbour),
                             edge_to<R>(second, own.second, neighbour)};
        },
        [&](const EdgeVectors& j, const EdgeVectors& k, const RestTriangle<R>& rest) {
          sum.first = sum.first + triangle_force<model>(fabric.moduli, j.first, k.first, rest);
          sum.second = sum.second + triangle_force<model>(fabric.moduli, j.second, k.second, rest);
        });
  }
  return {with_springs<model>(fabric, first, i, sum.first),
          with_springs<model>(fabric, second, i, sum.second)};
}

/// `elastic` plus the dead load on vertex i and the lanes after it, N.
template <class R, class ExecutionSpace>
KOKKOS_INLINE_FUNCTION Vector3<R> with_load(const FabricViews<ExecutionSpace>& fabric,
                                            const Vector3<R>& elastic, int i) {
  return fabric.load.extent(0) > 0 ? elastic + load_points<R>(fabric.load, i) : elastic;
}
/// Elastic force and dead load on vertex i and the lanes after it, N.
template <ConstitutiveModel model, class R, class ExecutionSpace, class Points>
KOKKOS_INLINE_FUNCTION Vector3<R> force(const FabricViews<ExecutionSpace>& fabric, const Points& positions,
                                        int i) {
  return with_load(fabric, elastic_force<model, R>(fabric, positions, i), i);
}

/// Acceleration, m/s^2; zero along pinned axes. `Fabric` as in `elastic_force`.
template <class R, class Fabric>
KOKKOS_INLINE_FUNCTION Vector3<R> acceleration(const Fabric& fabric, const Vector3<R>& force, R inverse_mass,
                                               const Vector3<R>& velocity, const Vector3<R>& free) {
  const Vector3<R> g{R(fabric.gravity.x), R(fabric.gravity.y), R(fabric.gravity.z)};
  const Vector3<R> a = inverse_mass * force + g - fabric.damping * velocity;
  return {free.x * a.x, free.y * a.y, free.z * a.z};
}

/// Acceleration of vertex i and the lanes after it, m/s^2.
template <class R, class ExecutionSpace>
KOKKOS_INLINE_FUNCTION Vector3<R> acceleration(const FabricViews<ExecutionSpace>& fabric,
                                               const Vector3<R>& force, const Vector3<R>& velocity, int i) {
  return acceleration(fabric, force, device::Access<R>::load(&fabric.inverse_mass(i)), velocity,
                      free_axes<R>(fabric, i));
}

}  // namespace drogue::fabric
