#pragma once

#include "kernels/device/relaxed_access.hpp"
#include "kernels/fabric/contact/obstacle.hpp"
#include "kernels/fabric/results.hpp"
#include "kernels/fabric/stepping/divergence.hpp"
#include "kernels/spatial/bounding_sphere.hpp"

namespace drogue::fabric {

using spatial::BoundingSphere;

/// Rounds of impulses per step, and of rigid impact zones, which may grow where impulses were not enough.
inline constexpr int impulse_rounds = 10, zone_rounds = 6;

/// Capacity: neighbours of a vertex or edge. Crumpled cloth needs the larger number, which all but meshes of
/// so many edges that their lists would take hundreds of megabytes have, and all of them in intervals of
/// several steps.
inline constexpr int max_neighbours = 192, max_neighbours_of_large_meshes = 64;
inline constexpr std::size_t most_edges_of_long_lists = 262144;

/// Number of constraints of a vertex up to which their impulses are added in a fixed order. More are added as
/// integers (`ImpulseSum`).
inline constexpr int max_listed_constraints = 64;

/// Impulses on a vertex as multiples of a quantum: their sum does not depend on the order of addition. The
/// total of a round, and that of friction in all rounds.
struct ImpulseSum {
  std::int64_t total[3], friction[3];
};

/// Contact of two parts that touch or will touch within the step: a vertex and a triangle, two edges, or one
/// of these and a body. The relative velocity at the closest points is the sum of weight times velocity.
struct ContactConstraint {
  std::uint64_t key;  ///< identifies the parts; orders the constraints of a vertex
  int vertex[4];      ///< unused without weight and lever
  double weight[4];
  Point normal;             ///< unit vector of the separation
  Point lever[2];           ///< of the couple that balances friction, see `lever_of`
  double target_velocity;   ///< lower bound of the normal relative velocity, m/s
  double friction;          ///< Coulomb coefficient
  Point friction_target;    ///< tangential relative velocity of sticking parts, m/s
  double normal_impulse;    ///< accumulated normal impulse, kg m/s
  Point friction_impulse;   ///< accumulated tangential impulse, kg m/s
  double normal_increment;  ///< change in this round, kg m/s
  Point friction_increment;
};

/// Lever of a vertex of a constraint, m: along the edges of the triangle from its first corner, or along both
/// edges of an edge pair.
KOKKOS_INLINE_FUNCTION Point lever_of(const ContactConstraint& constraint, bool is_edge_edge, int slot) {
  const Point &a = constraint.lever[0], &b = constraint.lever[1];
  if (is_edge_edge) return slot == 0 ? -1.0 * a : slot == 1 ? a : slot == 2 ? -1.0 * b : b;
  return slot == 0 ? Point{0.0, 0.0, 0.0} : slot == 1 ? -1.0 * (a + b) : slot == 2 ? a : b;
}

enum class ConstraintKind : std::uint64_t { vertex_face, edge_edge, vertex_body, edge_body, face_body };

/// Key of a constraint between parts with numbers below 2^30.
KOKKOS_INLINE_FUNCTION std::uint64_t constraint_key(ConstraintKind kind, int first, int second) {
  return static_cast<std::uint64_t>(kind) << 60U | static_cast<std::uint64_t>(first) << 30U |
         static_cast<std::uint64_t>(second);
}
KOKKOS_INLINE_FUNCTION bool is_edge_edge(const ContactConstraint& constraint) {
  return constraint.key >> 60U == static_cast<std::uint64_t>(ConstraintKind::edge_edge);
}

/// Data that the kernels of a contact step share. The steps of an interval are one contact step.
struct ContactStatus {
  std::uint64_t moved;    ///< bits of the largest displacement since the neighbour lists were built, m
  std::uint64_t fastest;  ///< bits of the largest speed, m/s
  std::uint64_t extent;   ///< bits of the largest extent of a triangle or edge along an axis, m
  double skin;            ///< m, margin of the neighbour lists beyond the contact distance
  double least_skin;      ///< m, least margin with which lists are valid in this step
  double grid_skin;       ///< m, margin for which the cells of the hash grid are wide enough
  double speed;           ///< largest speed in this step, m/s
  double dt;              ///< s, of this step
  int stale;              ///< 1: the neighbour lists must be rebuilt in this step
  int crowded;            ///< 1: a rebuilt list cannot hold the neighbours within the skin
  int constraints;        ///< number of constraints found in this step
  int crossing[zone_rounds + 1];  ///< 1 if parts would cross before and after each round of zones
  std::uint64_t reason;           ///< minimum of 16 * step + FailureReason
};

/// Unmanaged View of memory of `ContactImpl`: reference counts at every launch would cost time.
template <class ExecutionSpace, class T>
using UnmanagedList =
    Kokkos::View<T*, typename ExecutionSpace::memory_space, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
template <class ExecutionSpace, class T, int columns>
using UnmanagedTable = Kokkos::View<T* [columns], Kokkos::LayoutLeft, typename ExecutionSpace::memory_space,
                                    Kokkos::MemoryTraits<Kokkos::Unmanaged>>;

/// Motion of a rigid impact zone in a step.
struct ZoneMotion {
  int fixed;                         ///< 1: translates with its fixed vertices by `to`, m, at `velocity`
  Point from, to;                    ///< m, centre of mass at the beginning and at the end of the step
  Point rotation;                    ///< Cayley vector of the rotation
  Point velocity, angular_velocity;  ///< m/s, 1/s
};

/// Data of contact in the memory of an execution space.
template <class ExecutionSpace>
struct ContactViews {
  template <class T>
  using List = UnmanagedList<ExecutionSpace, T>;
  using Points3 = UnmanagedTable<ExecutionSpace, double, 3>;

  int vertices, triangles, edges;
  int first_line;  ///< first edge that belongs to no triangle
  double thickness, self_friction, widest_skin;
  bool self;
  bool by_interval;  ///< impulses follow the steps of an interval; else they precede every step
  List<Obstacle> bodies;
  UnmanagedTable<ExecutionSpace, int, 3> triangle;
  List<int> owned;  ///< `owned_features` of every triangle
  UnmanagedTable<ExecutionSpace, int, 2> edge;
  List<int> long_edge;         ///< numbers of edges that are left out of the hash grid, in ascending order
  List<std::uint8_t> is_long;  ///< of every edge
  List<std::uint8_t> is_cut;   ///< of every edge: a line that is no obstacle
  List<double> inverse_mass;
  List<std::uint8_t> fixed_dofs;  ///< as in FabricViews
  Points3 start_x;                ///< m, at the beginning of the step
  Points3 start_v;         ///< m/s, at the beginning of the step, or mean in an interval; impulses included
  Points3 end_x, end_v;    ///< with zones
  Points3 listed_x;        ///< m, positions when the neighbour lists were built
  List<ContactWork> work;  ///< of contact on every vertex
  // Hash grid whose cells are linked lists.
  List<int> triangle_heads, edge_heads;
  List<BoundingSphere> triangle_sphere, edge_sphere;
  List<int> near_triangles, near_edges;  ///< numbers of neighbours of each vertex and of each edge
  /// (vertices or edges, largest number of neighbours)
  Kokkos::View<int**, Kokkos::LayoutLeft, typename ExecutionSpace::memory_space,
               Kokkos::MemoryTraits<Kokkos::Unmanaged>>
      near_triangle, near_edge;
  List<ContactConstraint> constraint;
  List<int> constraints;  ///< number of constraints of every vertex
  UnmanagedTable<ExecutionSpace, int, max_listed_constraints>
      vertex_constraint;         ///< 4 times the constraint, plus the slot of the vertex
  List<ImpulseSum> impulse_sum;  ///< of vertices with more constraints than are listed; else zero
  List<int> zone;                ///< parents of the union-find forest of zones
  List<int> label;               ///< least vertex of the zone of each vertex
  List<int> zone_end;            ///< largest vertex of a zone, stored at its least vertex
  List<int> stuck;               ///< 1: would enter a body and does not move
  List<ZoneMotion> motion;       ///< of a zone, stored at its least vertex
  List<ContactStatus> progress;
  StepMonitor<ExecutionSpace> monitor;

  [[nodiscard]] KOKKOS_FUNCTION double cutoff_distance() const { return thickness + progress(0).skin; }

  [[nodiscard]] KOKKOS_FUNCTION bool is_listed(int i) const {
    return constraints(i) <= max_listed_constraints;
  }

  template <class Points>
  KOKKOS_FUNCTION void corners(int t, const Points& x, Point (&to)[3]) const {
    for (int k = 0; k < 3; ++k) to[k] = load_points<double>(x, triangle(t, k));
  }
  template <class Points>
  KOKKOS_FUNCTION void ends(int e, const Points& x, Point (&to)[2]) const {
    for (int k = 0; k < 2; ++k) to[k] = load_points<double>(x, edge(e, k));
  }

  [[nodiscard]] KOKKOS_FUNCTION bool in_zone(int i) const {
    return zone_end(label(i)) != label(i) || stuck(i) != 0;
  }

  [[nodiscard]] KOKKOS_FUNCTION bool is_fixed(int i) const { return fixed_dofs(i) != 0; }

  /// Number of completed steps, if called between steps: the larger entry of the double-buffered counter.
  [[nodiscard]] KOKKOS_FUNCTION std::int64_t steps() const {
    const std::int64_t a = monitor.steps(0), b = monitor.steps(1);
    return a > b ? a : b;
  }

  /// Number of the step whose contact is being resolved, before its end.
  [[nodiscard]] KOKKOS_FUNCTION std::int64_t present_step() const {
    return by_interval ? steps() : steps() + 1;
  }

  KOKKOS_FUNCTION void raise(std::int64_t step, FailureReason reason, int vertex) const {
    monitor.record_failure(step, vertex);
    Kokkos::atomic_min(&progress(0).reason,
                       static_cast<std::uint64_t>(step) << 4U | static_cast<std::uint64_t>(reason));
  }
};

/// Double with the given bit pattern.
KOKKOS_INLINE_FUNCTION double value_of_bits(std::uint64_t bits) { return Kokkos::bit_cast<double>(bits); }

/// Maximum of non-negative doubles, which compare as their bit patterns do; independent of the order.
KOKKOS_INLINE_FUNCTION void atomic_raise(std::uint64_t& slot, double value) {
  const auto bits = Kokkos::bit_cast<std::uint64_t>(value);
  if (bits > device::relaxed_load(&slot)) Kokkos::atomic_max(&slot, bits);
}

}  // namespace drogue::fabric
