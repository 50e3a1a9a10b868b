#pragma once

#include "kernels/fabric/contact/contact_views.hpp"

namespace drogue::fabric {

/// What parts nearer than the thickness are given to part, m/s^2: a speed that would lift them by what they
/// lack against it, no more. About gravity, by which most come too near. A share of the lack a step, as in
/// Bridson, Fedkiw and Anderson 2002, 7.2 (0.1 h / dt), throws them apart faster the shorter the step is.
inline constexpr double recovery = 10.0;

/// The most of their lack that parts win back in a step.
inline constexpr double max_recovery = 0.1;

/// The least velocity, m/s, along the normal of parts `distance` apart whose velocity is `closing`, negative
/// where they approach: they may come as near as the thickness, and part where they are nearer, at no more
/// than sqrt(2 recovery thickness) and half of the speed of their approach. That half is what a force that
/// presses them together all the time takes of the way in a step; it takes from the energy, whatever dt.
KOKKOS_INLINE_FUNCTION double target_velocity(double distance, double thickness, double closing, double dt) {
  const double lack = thickness - distance;
  if (!(lack > 0.0)) return lack / dt;
  const double back = Kokkos::sqrt(2.0 * recovery * lack) + (closing < 0.0 ? -0.5 * closing : 0.0),
               most = max_recovery * lack / dt;
  return back < most ? back : most;
}

/// Vectors A and B such that k_i = a_i . t, with a_i = `lever_of` of them, is a couple along the normal n
/// that cancels the torque of friction along t, which acts a distance h apart: sum k_i x_i = h t along a
/// plane spanned by `along` and `across`, up to a part along n. Friction then does nothing to a rigid motion,
/// and keeps angular momentum. Nothing where n leans far over, or the two are nearly parallel: false.
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

/// Finds what touches: of every vertex, edge and triangle.
template <class ExecutionSpace>
struct DetectConstraintsFunctor {
  ContactViews<ExecutionSpace> views;

  KOKKOS_FUNCTION void operator()(const int k) const {
    if (k < views.vertices)
      of_vertex(k);
    else if (k < views.vertices + views.edges)
      of_edge(k - views.vertices);
    else
      of_face(k - views.vertices - views.edges);
  }

  /// Keeps a touch of parts that are `r` apart unless they stay apart on their own.
  KOKKOS_FUNCTION void keep(ContactConstraint& constraint, const Point& r, double distance) const {
    if (!(distance > 0.0)) return;  // the check after the step sees it
    constraint.normal = (1.0 / distance) * r;
    keep(constraint, distance);
  }

  KOKKOS_FUNCTION void keep(ContactConstraint& constraint, double distance) const {
    double closing = 0.0;
    for (int slot = 0; slot < 4; ++slot)
      if (constraint.weight[slot] != 0.0)
        closing += constraint.weight[slot] *
                   dot(load_points<double>(views.start_v, constraint.vertex[slot]), constraint.normal);
    constraint.target_velocity = target_velocity(distance, views.thickness, closing, views.dt);
    // Neighbours may yet drive them together.
    if (distance > views.thickness && closing > 0.5 * constraint.target_velocity) return;
    if (constraint.friction > 0.0) friction_target(constraint);
    const int number = Kokkos::atomic_fetch_add(&views.progress(0).constraints, 1);
    if (number >= static_cast<int>(views.constraint.extent(0)))
      return views.raise(views.steps() + 1, FailureReason::too_dense, constraint.vertex[0]);
    for (int slot = 0; slot < 4; ++slot)
      if (takes_part(constraint, slot)) {
        const int i = constraint.vertex[slot], place = Kokkos::atomic_fetch_add(&views.constraints(i), 1);
        if (place < max_constraints)
          views.vertex_constraint(i, place) = 4 * number + slot;
        else
          views.raise(views.steps() + 1, FailureReason::too_dense, i);
      }
    views.constraint(number) = constraint;
  }

  /// Forces that do not change move parts in a step by half of what they kick them: held parts start against
  /// it, or what sticks would creep. Where forces change, the ways of all steps sum to half of the last
  /// kick's, and what friction gives is at most an eighth of the mass times the square of a kick.
  KOKKOS_FUNCTION void friction_target(ContactConstraint& constraint) const {
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

  /// Whether the triangle answers for its point that is nearest: of its inside always.
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

  KOKKOS_FUNCTION void of_vertex(int i) const {
    const Point only[1] = {load_points<double>(views.start_x, i)}, &own = only[0];
    for (int b = 0; b < static_cast<int>(views.bodies.extent(0)); ++b) {
      const Obstacle& body = views.bodies(b);
      const SignedDistance gap = body.kind == BodyKind::level_set
                                     ? level_set_distance(body, own, 0.01 * views.thickness)
                                     : signed_distance(body, own);
      // Not a number either: the check has told of it.
      if (!(gap.distance <= views.thickness + step_cutoff())) continue;
      ContactConstraint constraint = make_constraint(ConstraintKind::vertex_body, i, b, body.friction);
      constraint.vertex[0] = i, constraint.weight[0] = 1.0, constraint.normal = gap.outward;
      keep(constraint, gap.distance);
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
      keep(constraint, r, distance);
    }
  }

  KOKKOS_FUNCTION void of_edge(int e) const {
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
      if (!(u > 1e-9 && u < 1.0 - 1e-9)) continue;  // its vertices see to that
      const SignedDistance gap = signed_distance(body, own[0] + u * (own[1] - own[0]));
      if (gap.distance > views.thickness + step_cutoff()) continue;
      ContactConstraint constraint = make_constraint(ConstraintKind::edge_body, e, b, body.friction);
      for (int end = 0; end < 2; ++end) constraint.vertex[end] = views.edge(e, end);
      constraint.weight[0] = 1.0 - u, constraint.weight[1] = u, constraint.normal = gap.outward;
      keep(constraint, gap.distance);
    }
    if (!views.self) return;
    for (int k = 0; k < views.near_edges(e); ++k) {
      const int f = views.near_edge(e, k);
      Point other[2];
      views.ends(f, views.start_x, other);
      if (boxes_apart(own, other, views.thickness + step_cutoff())) continue;
      const ClosestOfSegments nearest = closest_of_segments(own, other);
      const double distance = Kokkos::sqrt(nearest.squared);
      // At an end a vertex and a triangle are as near.
      if (!nearest.inside || distance > views.thickness + step_cutoff()) continue;
      ContactConstraint constraint = make_constraint(ConstraintKind::edge_edge, e, f, views.self_friction);
      for (int end = 0; end < 2; ++end)
        constraint.vertex[end] = views.edge(e, end), constraint.vertex[2 + end] = views.edge(f, end);
      const double s = nearest.first, u = nearest.second;
      constraint.weight[0] = 1.0 - s, constraint.weight[1] = s, constraint.weight[2] = u - 1.0,
      constraint.weight[3] = -u;
      const Point r = (1.0 - s) * own[0] + s * own[1] - ((1.0 - u) * other[0] + u * other[1]);
      if (constraint.friction > 0.0 && distance > 0.0 &&
          !friction_levers(own[1] - own[0], other[1] - other[0], (1.0 / distance) * r, distance,
                           constraint.lever))
        constraint.friction = 0.0;
      keep(constraint, r, distance);
    }
  }

  KOKKOS_FUNCTION void of_face(int t) const {
    Point at[3], place;
    views.corners(t, views.start_x, at);
    const Point normal = cross(at[1] - at[0], at[2] - at[0]);
    for (int b = 0; b < static_cast<int>(views.bodies.extent(0)); ++b) {
      const Obstacle& body = views.bodies(b);
      if (!between_vertices(body)) continue;
      const double size = body.kind == BodyKind::sphere ? body.radius : 0.0;
      for (int side = 0; side < 2; ++side) {
        if (!facing_place(body, normal, side, place)) continue;
        const Point only[1] = {place};
        if (boxes_apart(only, at, size + views.thickness + step_cutoff())) continue;
        const ClosestOnTriangle nearest = closest_on_triangle(place, at);
        const double out = Kokkos::sqrt(nearest.squared), distance = out - size;
        if (!nearest.inside || !(out > 0.0) || distance > views.thickness + step_cutoff()) continue;
        ContactConstraint constraint =
            make_constraint(ConstraintKind::face_body, t, 2 * b + side, body.friction);
        Point r{-place.x, -place.y, -place.z};
        for (int corner = 0; corner < 3; ++corner) {
          constraint.vertex[corner] = views.triangle(t, corner);
          constraint.weight[corner] = nearest.weight[corner];
          r = r + nearest.weight[corner] * at[corner];
        }
        constraint.normal = (1.0 / out) * r;
        keep(constraint, distance);
      }
    }
  }

  /// What parts that use up half of what they have beyond the thickness in a step have at most, m.
  [[nodiscard]] KOKKOS_FUNCTION double step_cutoff() const {
    return 4.0 * views.dt * views.progress(0).speed;
  }
};

/// Orders the touches of vertex i by the parts that they are of.
template <class ExecutionSpace>
KOKKOS_FUNCTION void sort_constraints(const ContactViews<ExecutionSpace>& views, int i) {
  const int count = views.constraints(i) < max_constraints ? views.constraints(i) : max_constraints;
  views.constraints(i) = count;
  for (int k = 1; k < count; ++k) {
    const int moved = views.vertex_constraint(i, k);
    const std::uint64_t key = views.constraint(moved / 4).key;
    int place = k;
    for (; place > 0 && views.constraint(views.vertex_constraint(i, place - 1) / 4).key > key; --place)
      views.vertex_constraint(i, place) = views.vertex_constraint(i, place - 1);
    views.vertex_constraint(i, place) = moved;
  }
}

}  // namespace drogue::fabric
