#pragma once

#include "kernels/fabric/contact/obstacle.hpp"
#include "kernels/fabric/state.hpp"
#include "kernels/fabric/stepping/divergence.hpp"
#include "kernels/spatial/bounding_sphere.hpp"

namespace drogue::fabric {

using spatial::BoundingSphere;

/// Rounds of impulses a step, and of zones that may grow where impulses did not keep parts from crossing.
inline constexpr int impulse_rounds = 10, zone_rounds = 6;

/// Parts near a vertex or edge, and touches of a vertex, that there is room for.
inline constexpr int max_neighbours = 64, max_constraints = 64;

/// Two parts that touch, or will within the step: a vertex and a triangle, two edges, or one of them and a
/// body. The parts' relative velocity where they are nearest is the sum of share times velocity.
struct ContactConstraint {
  std::uint64_t key;  ///< names the parts; orders the touches of a vertex
  int vertex[4];      ///< those without a share or lever count for nothing
  double weight[4];
  Point normal;             ///< unit vector along which the parts are to stay apart
  Point lever[2];           ///< of the couple that friction needs, `lever_of`
  double target_velocity;   ///< least relative velocity along the normal, m/s
  double friction;          ///< Coulomb's coefficient
  Point friction_target;    ///< relative velocity across, m/s, with which parts that friction holds stay
  double normal_impulse;    ///< impulse so far along the normal, kg m/s
  Point friction_impulse;   ///< and across
  double normal_increment;  ///< of this round
  Point friction_increment;
};

/// The lever of a vertex of a touch: along the triangle's edges from its first corner, or along both edges.
KOKKOS_INLINE_FUNCTION Point lever_of(const ContactConstraint& constraint, bool is_edge_edge, int slot) {
  const Point &a = constraint.lever[0], &b = constraint.lever[1];
  if (is_edge_edge) return slot == 0 ? -1.0 * a : slot == 1 ? a : slot == 2 ? -1.0 * b : b;
  return slot == 0 ? Point{0.0, 0.0, 0.0} : slot == 1 ? -1.0 * (a + b) : slot == 2 ? a : b;
}

enum class ConstraintKind : std::uint64_t { vertex_face, edge_edge, vertex_body, edge_body, face_body };

/// Numbers of parts below 2^30.
KOKKOS_INLINE_FUNCTION std::uint64_t constraint_key(ConstraintKind kind, int first, int second) {
  return static_cast<std::uint64_t>(kind) << 60U | static_cast<std::uint64_t>(first) << 30U |
         static_cast<std::uint64_t>(second);
}
KOKKOS_INLINE_FUNCTION bool is_edge_edge(const ContactConstraint& constraint) {
  return constraint.key >> 60U == static_cast<std::uint64_t>(ConstraintKind::edge_edge);
}

/// What the kernels of a step tell one another.
struct ContactStatus {
  std::uint64_t moved;    ///< bits of the largest distance from where the lists of near parts were made, m
  std::uint64_t fastest;  ///< bits of the largest speed, m/s
  std::uint64_t extent;   ///< bits of the largest extent of a triangle or edge along an axis, m
  double skin;            ///< m by which the lists see farther than contact reaches
  double speed;           ///< the largest of this step, m/s
  int stale;              ///< the lists are to be made again in this step
  int constraints;        ///< found in this step
  int crossing[zone_rounds + 1];  ///< whether parts would cross before and after each round of zones
  std::uint64_t reason;           ///< the least of step and kind
};

/// Fixed memory, which belongs to `ContactHandler`; counting references at every launch would cost.
template <class ExecutionSpace, class T>
using UnmanagedList =
    Kokkos::View<T*, typename ExecutionSpace::memory_space, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
template <class ExecutionSpace, class T, int columns>
using UnmanagedTable = Kokkos::View<T* [columns], Kokkos::LayoutLeft, typename ExecutionSpace::memory_space,
                                    Kokkos::MemoryTraits<Kokkos::Unmanaged>>;

/// How a zone moves.
struct ZoneMotion {
  int held;                          ///< 1: with its held vertices, by `shift` at `velocity`
  Point from, to;                    ///< its centre at the beginning and at the end of the step
  Point rotation;                    ///< Cayley's vector of its rotation
  Point velocity, angular_velocity;  ///< m/s, 1/s
};

template <class ExecutionSpace>
struct ContactViews {
  template <class T>
  using List = UnmanagedList<ExecutionSpace, T>;
  using Points3 = UnmanagedTable<ExecutionSpace, double, 3>;

  int vertices, triangles, edges;
  int first_line;  ///< edges from it on are of no triangle
  double thickness, self_friction, widest_skin, dt;
  bool self;
  List<Obstacle> bodies;
  UnmanagedTable<ExecutionSpace, int, 3> triangle;
  List<int> owned;  ///< `owned_features` of every triangle
  UnmanagedTable<ExecutionSpace, int, 2> edge;
  List<double> inverse_mass;
  List<std::uint8_t> fixed_dofs;  ///< as of Cloth
  Points3 start_x, start_v;       ///< at the beginning of the step, impulses included
  Points3 end_x, end_v;           ///< with zones
  Points3 listed_x;               ///< where the lists were made
  List<ContactWork> work;         ///< of contact on every vertex so far
  // A hashed grid of cells, each a chain.
  List<int> triangle_heads, edge_heads;
  List<BoundingSphere> triangle_sphere, edge_sphere;
  List<int> near_triangles, near_edges;  ///< how many of each vertex, and of each edge
  UnmanagedTable<ExecutionSpace, int, max_neighbours> near_triangle, near_edge;
  List<ContactConstraint> constraint;
  List<int> constraints;  ///< of every vertex
  UnmanagedTable<ExecutionSpace, int, max_constraints>
      vertex_constraint;    ///< 4 times the touch, and the slot in it
  List<int> zone;           ///< while zones are joined, the way to the least vertex of each
  List<int> label;          ///< that vertex, once they are
  List<int> zone_end;       ///< the largest vertex of the zone of the least one
  List<int> stuck;          ///< 1: would enter a body, and stays
  List<ZoneMotion> motion;  ///< of the zone of a least vertex
  List<ContactStatus> progress;
  StepMonitor<ExecutionSpace> monitor;

  [[nodiscard]] KOKKOS_FUNCTION double cutoff_distance() const { return thickness + progress(0).skin; }

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

  [[nodiscard]] KOKKOS_FUNCTION bool is_held(int i) const { return fixed_dofs(i) != 0; }

  /// Steps taken when this is called between them; both words of the monitor agree on no less.
  [[nodiscard]] KOKKOS_FUNCTION std::int64_t steps() const {
    const std::int64_t a = monitor.steps(0), b = monitor.steps(1);
    return a > b ? a : b;
  }

  KOKKOS_FUNCTION void raise(std::int64_t step, FailureReason reason, int vertex) const {
    monitor.record_failure(step, vertex);
    Kokkos::atomic_min(&progress(0).reason,
                       static_cast<std::uint64_t>(step) << 4U | static_cast<std::uint64_t>(reason));
  }
};

KOKKOS_INLINE_FUNCTION double value_of_bits(std::uint64_t bits) { return Kokkos::bit_cast<double>(bits); }

/// Non-negative doubles compare as their bits do: the largest is the same in any order.
KOKKOS_INLINE_FUNCTION void atomic_raise(std::uint64_t& slot, double value) {
  const auto bits = Kokkos::bit_cast<std::uint64_t>(value);
  if (bits > Kokkos::atomic_load(&slot)) Kokkos::atomic_max(&slot, bits);
}

}  // namespace drogue::fabric
