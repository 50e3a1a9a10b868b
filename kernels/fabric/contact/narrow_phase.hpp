#pragma once

#include "kernels/fabric/contact/contact_views.hpp"

namespace drogue::fabric {

/// Deceleration that limits the separation speed of parts nearer than the thickness, m/s^2: the speed that
/// would lift them by their penetration against it. About gravity, which causes most penetrations. A fraction
/// of the penetration per step, as in Bridson, Fedkiw and Anderson 2002, section 7.2 (0.1 h / dt), would give
/// higher speeds for shorter steps.
inline constexpr double recovery = 10.0;

/// Largest fraction of the penetration that is removed in a step.
inline constexpr double max_recovery = 0.1;

/// Lower bound of the normal relative velocity, m/s, of parts at `distance`, m, with the normal relative
/// velocity `closing`, m/s, which is negative for approaching parts. Parts may approach to the thickness.
/// Nearer parts separate with at most sqrt(2 recovery thickness) and half of their speed of approach. That
/// half balances the path per step under a constant force; it dissipates energy for every dt.
KOKKOS_INLINE_FUNCTION double target_velocity(double distance, double thickness, double closing, double dt) {
  const double penetration = thickness - distance;
  if (!(penetration > 0.0)) return penetration / dt;
  const double speed = Kokkos::sqrt(2.0 * recovery * penetration) + (closing < 0.0 ? -0.5 * closing : 0.0),
               largest = max_recovery * penetration / dt;
  return speed < largest ? speed : largest;
}

/// Levers A and B, m, such that k_i = a_i . t, with a_i from `lever_of`, is a couple along the normal n that
/// cancels the torque of friction along t, whose forces act at a distance h: sum k_i x_i = h t in the plane
/// spanned by `along` and `across`, up to a component along n. Friction then does not change a rigid motion
/// and conserves angular momentum. Returns false if n is far from the plane's normal or the two vectors are
/// nearly parallel.
KOKKOS_INLINE_FUNCTION bool friction_levers(const Point& along, const Point& across, const Point& n, double h,
                                            Point (&lever)[2]) {
  const Point normal = cross(along, across);
  const double squared = dot(normal, normal), upright = dot(normal, n);
  if (!(squared > 0.01 * dot(along, along) * dot(across, across)) || !(upright * upright > 0.5 * squared))
    return false;
  const Point dual[2] = {(1.0 / squared) * cross(across, normal), (1.0 / squared) * cross(normal, along)};
  for (int k = 0; k < 2; ++k) {
    const Point straight = dual[k] - (dot(dual[k], n) / upright) * normal;
    lever[k] = h * (straight - dot(straight, n) * n);
  }
  return true;
}

/// Detects the contacts of every vertex, edge and triangle.
template <class ExecutionSpace>
struct DetectConstraintsFunctor {
  ContactViews<ExecutionSpace> views;

  KOKKOS_FUNCTION void operator()(const int k) const {
    if (k < views.vertices)
      detect_at_vertex(k);
    else if (k < views.vertices + views.edges)
      detect_at_edge(k - views.vertices);
    else
      detect_at_face(k - views.vertices - views.edges);
  }

  /// Adds a constraint between parts at the separation `r`, m, unless they stay apart without it.
  KOKKOS_FUNCTION void add_constraint(ContactConstraint& constraint, const Point& r, double distance) const {
    if (!(distance > 0.0)) return;  // continuous detection after the step handles it
    constraint.normal = (1.0 / distance) * r;
    add_constraint(constraint, distance);
  }

  KOKKOS_FUNCTION void add_constraint(ContactConstraint& constraint, double distance) const {
    double closing = 0.0;
    for (int slot = 0; slot < 4; ++slot)
      if (constraint.weight[slot] != 0.0)
        closing += constraint.weight[slot] *
                   dot(load_points<double>(views.start_v, constraint.vertex[slot]), constraint.normal);
    constraint.target_velocity = target_velocity(distance, views.thickness, closing, views.progress(0).dt);
    // Neighbours may still push the parts together.
    if (distance > views.thickness && closing > 0.5 * constraint.target_velocity) return;
    if (constraint.friction > 0.0) set_friction_target(constraint);
    const int number = Kokkos::atomic_fetch_add(&views.progress(0).constraints, 1);
    if (number >= static_cast<int>(views.constraint.extent(0)))
      return views.raise(views.present_step(), FailureReason::too_many_constraints, constraint.vertex[0]);
    for (int slot = 0; slot < 4; ++slot)
      if (takes_part(constraint, slot)) {
        const int i = constraint.vertex[slot], entry = Kokkos::atomic_fetch_add(&views.constraints(i), 1);
        if (entry < max_listed_constraints) views.vertex_constraint(i, entry) = 4 * number + slot;
      }
    views.constraint(number) = constraint;
  }

  /// Constant forces displace parts in a step by half of their velocity change (kick) times dt. Sticking
  /// parts start with the opposite velocity; otherwise they would creep. Under changing forces the
  /// displacements of all steps sum to half of that of the last kick, and friction adds at most an eighth of
  /// the mass times the square of a kick to the energy.
  KOKKOS_FUNCTION void set_friction_target(ContactConstraint& constraint) const {
    Point kick{0.0, 0.0, 0.0};
    for (int slot = 0; slot < 4; ++slot) {
      if (!takes_part(constraint, slot)) continue;
      const ContactWork& of = views.work(constraint.vertex[slot]);
      const Point own{of.kick_x, of.kick_y, of.kick_z};
      kick = kick + constraint.weight[slot] * own +
             dot(constraint.normal, own) * lever_of(constraint, is_edge_edge(constraint), slot);
    }
    constraint.friction_target = -0.5 * (kick - dot(kick, constraint.normal) * constraint.normal);
  }

  /// True if the triangle owns its closest point: always for points inside it.
  KOKKOS_FUNCTION static bool owns(int bits, const ClosestOnTriangle& nearest) {
    if (nearest.inside) return true;
    for (int k = 0; k < 3; ++k) {
      if (nearest.weight[k] == 1.0) return (bits >> k & 1) != 0;
      if (nearest.weight[(k + 2) % 3] == 0.0 && nearest.weight[k] > 0.0 && nearest.weight[(k + 1) % 3] > 0.0)
        return (bits >> k & 8) != 0;
    }
    return true;
  }

  KOKKOS_FUNCTION static bool takes_part(const ContactConstraint& constraint, int slot) {
    const Point lever = lever_of(constraint, is_edge_edge(constraint), slot);
    return constraint.weight[slot] != 0.0 || dot(lever, lever) > 0.0;
  }

  KOKKOS_FUNCTION static ContactConstraint make_constraint(ConstraintKind kind, int first, int second,
                                                           double friction) {
    ContactConstraint constraint{};
    constraint.key = constraint_key(kind, first, second);
    constraint.friction = friction;
    return constraint;
  }

  KOKKOS_FUNCTION void detect_at_vertex(int i) const {
    const Point only[1] = {load_points<double>(views.start_x, i)}, &own = only[0];
    for (int b = 0; b < static_cast<int>(views.bodies.extent(0)); ++b) {
      const Obstacle& body = views.bodies(b);
      const SignedDistance gap = body.kind == BodyKind::level_set
                                     ? level_set_distance(body, own, 0.01 * views.thickness)
                                     : signed_distance(body, own);
      // Also false for NaN, which continuous detection reports.
      if (!(gap.distance <= views.thickness + step_cutoff())) continue;
      ContactConstraint constraint = make_constraint(ConstraintKind::vertex_body, i, b, body.friction);
      constraint.vertex[0] = i, constraint.weight[0] = 1.0, constraint.normal = gap.outward;
      add_constraint(constraint, gap.distance);
    }
    if (!views.self) return;
    for (int k = 0; k < views.near_triangles(i); ++k) {
      const int t = views.near_triangle(i, k);
      Point at[3];
      views.corners(t, views.start_x, at);
      if (boxes_apart(only, at, views.thickness + step_cutoff())) continue;
      const ClosestOnTriangle nearest = closest_on_triangle(own, at);
      const double distance = Kokkos::sqrt(nearest.squared);
      if (distance > views.thickness + step_cutoff() || !owns(views.owned(t), nearest)) continue;
      ContactConstraint constraint = make_constraint(ConstraintKind::vertex_face, i, t, views.self_friction);
      constraint.vertex[0] = i, constraint.weight[0] = 1.0;
      Point r = own;
      for (int corner = 0; corner < 3; ++corner) {
        constraint.vertex[1 + corner] = views.triangle(t, corner);
        constraint.weight[1 + corner] = -nearest.weight[corner];
        r = r - nearest.weight[corner] * at[corner];
      }
      if (constraint.friction > 0.0 && distance > 0.0 &&
          !friction_levers(at[1] - at[0], at[2] - at[0], (1.0 / distance) * r, distance, constraint.lever))
        constraint.friction = 0.0;
      add_constraint(constraint, r, distance);
    }
  }

  KOKKOS_FUNCTION void detect_at_edge(int e) const {
    if (views.is_cut(e) != 0) return;
    Point own[2];
    views.ends(e, views.start_x, own);
    for (int b = 0; b < static_cast<int>(views.bodies.extent(0)); ++b) {
      const Obstacle& body = views.bodies(b);
      if (!between_vertices(body)) continue;
      const Point middle = 0.5 * (own[0] + own[1]);
      if (signed_distance(body, middle).distance >
          views.thickness + step_cutoff() + 0.5 * length(own[1] - own[0]))
        continue;
      const double u = nearest_to_body(body, own[0], own[1]);
      if (!(u > 1e-9 && u < 1.0 - 1e-9)) continue;  // the vertices detect this contact
      const SignedDistance gap = signed_distance(body, own[0] + u * (own[1] - own[0]));
      if (gap.distance > views.thickness + step_cutoff()) continue;
      ContactConstraint constraint = make_constraint(ConstraintKind::edge_body, e, b, body.friction);
      for (int end = 0; end < 2; ++end) constraint.vertex[end] = views.edge(e, end);
      constraint.weight[0] = 1.0 - u, constraint.weight[1] = u, constraint.normal = gap.outward;
      add_constraint(constraint, gap.distance);
    }
    if (!views.self) return;
    for (int k = 0; k < views.near_edges(e); ++k) {
      const int f = views.near_edge(e, k);
      Point other[2];
      views.ends(f, views.start_x, other);
      if (boxes_apart(own, other, views.thickness + step_cutoff())) continue;
      const ClosestOfSegments nearest = closest_of_segments(own, other);
      const double distance = Kokkos::sqrt(nearest.squared);
      // At an end of an edge the contact of a vertex and a triangle is as near.
      if (!nearest.inside || distance > views.thickness + step_cutoff()) continue;
      ContactConstraint constraint = make_constraint(ConstraintKind::edge_edge, e, f, views.self_friction);
      for (int end = 0; end < 2; ++end)
        constraint.vertex[end] = views.edge(e, end), constraint.vertex[2 + end] = views.edge(f, end);
      const double s = place_of_impulse(e, nearest.first), u = place_of_impulse(f, nearest.second);
      constraint.weight[0] = 1.0 - s, constraint.weight[1] = s, constraint.weight[2] = u - 1.0,
      constraint.weight[3] = -u;
      const Point r = point_on(own, nearest.first) - point_on(other, nearest.second);
      if (constraint.friction > 0.0 && distance > 0.0 &&
          !friction_levers(own[1] - own[0], other[1] - other[0], (1.0 / distance) * r, distance,
                           constraint.lever))
        constraint.friction = 0.0;
      add_constraint(constraint, r, distance);
    }
  }

  KOKKOS_FUNCTION static Point point_on(const Point (&end)[2], double part) {
    return (1.0 - part) * end[0] + part * end[1];
  }

  /// Place on edge e, 0 to 1, at which impulses of a contact at `part` act. Near the ends of a long line it
  /// is the end: a payload would have more constraints than there is room for, from all cloth at its lines.
  [[nodiscard]] KOKKOS_FUNCTION double place_of_impulse(int e, double part) const {
    if (!views.by_interval || views.is_long(e) == 0) return part;
    return part < 0.0625 ? 0.0 : part > 0.9375 ? 1.0 : part;
  }

  KOKKOS_FUNCTION void detect_at_face(int t) const {
    Point at[3], point;
    views.corners(t, views.start_x, at);
    const Point normal = cross(at[1] - at[0], at[2] - at[0]);
    for (int b = 0; b < static_cast<int>(views.bodies.extent(0)); ++b) {
      const Obstacle& body = views.bodies(b);
      if (!between_vertices(body)) continue;
      const double size = body.kind == BodyKind::sphere ? body.radius : 0.0;
      for (int side = 0; side < 2; ++side) {
        if (!facing_point(body, normal, side, point)) continue;
        const Point only[1] = {point};
        if (boxes_apart(only, at, size + views.thickness + step_cutoff())) continue;
        const ClosestOnTriangle nearest = closest_on_triangle(point, at);
        const double out = Kokkos::sqrt(nearest.squared), distance = out - size;
        if (!nearest.inside || !(out > 0.0) || distance > views.thickness + step_cutoff()) continue;
        ContactConstraint constraint =
            make_constraint(ConstraintKind::face_body, t, 2 * b + side, body.friction);
        Point r{-point.x, -point.y, -point.z};
        for (int corner = 0; corner < 3; ++corner) {
          constraint.vertex[corner] = views.triangle(t, corner);
          constraint.weight[corner] = nearest.weight[corner];
          r = r + nearest.weight[corner] * at[corner];
        }
        constraint.normal = (1.0 / out) * r;
        add_constraint(constraint, distance);
      }
    }
  }

  /// Distance beyond the thickness, m, of which parts traverse at most half in a step, or that they traverse
  /// in an interval if impulses raise the largest speed by a quarter.
  [[nodiscard]] KOKKOS_FUNCTION double step_cutoff() const {
    return (views.by_interval ? 2.5 : 4.0) * views.progress(0).dt * views.progress(0).speed;
  }
};

/// Sorts the listed constraints of vertex i by their keys, so that sums do not depend on the order of
/// detection.
template <class ExecutionSpace>
KOKKOS_FUNCTION void sort_constraints(const ContactViews<ExecutionSpace>& views, int i) {
  const int count = views.constraints(i);
  for (int k = 1; k < count; ++k) {
    const int moved = views.vertex_constraint(i, k);
    const std::uint64_t key = views.constraint(moved / 4).key;
    int slot = k;
    for (; slot > 0 && views.constraint(views.vertex_constraint(i, slot - 1) / 4).key > key; --slot)
      views.vertex_constraint(i, slot) = views.vertex_constraint(i, slot - 1);
    views.vertex_constraint(i, slot) = moved;
  }
}

}  // namespace drogue::fabric
