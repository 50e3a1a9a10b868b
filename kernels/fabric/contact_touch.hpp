#pragma once

#include "kernels/fabric/contact_table.hpp"

namespace drogue::fabric {

/// What parts nearer than the thickness are given to part, m/s^2: a speed that would lift them by what they
/// lack against it, no more. About gravity, by which most come too near. A share of the lack a step, as in
/// Bridson, Fedkiw and Anderson 2002, 7.2 (0.1 h / dt), throws them apart faster the shorter the step is.
inline constexpr double recovery = 10.0;

/// The most of their lack that parts win back in a step.
inline constexpr double most_recovery = 0.1;

/// The least velocity, m/s, along the normal of parts `distance` apart whose velocity is `closing`, negative
/// where they approach: they may come as near as the thickness, and part where they are nearer, at no more
/// than sqrt(2 recovery thickness) and half of the speed of their approach. That half is what a force that
/// presses them together all the time takes of the way in a step; it takes from the energy, whatever dt.
KOKKOS_INLINE_FUNCTION double wanted_velocity(double distance, double thickness, double closing, double dt) {
  const double lack = thickness - distance;
  if (!(lack > 0.0)) return lack / dt;
  const double back = Kokkos::sqrt(2.0 * recovery * lack) + (closing < 0.0 ? -0.5 * closing : 0.0),
               most = most_recovery * lack / dt;
  return back < most ? back : most;
}

/// Vectors A and B such that k_i = a_i . t, with a_i = `lever_of` of them, is a couple along the normal n
/// that cancels the torque of friction along t, which acts a distance h apart: sum k_i x_i = h t along a
/// plane spanned by `along` and `across`, up to a part along n. Friction then does nothing to a rigid motion,
/// and keeps angular momentum. Nothing where n leans far over, or the two are nearly parallel: false.
KOKKOS_INLINE_FUNCTION bool levers(const Point& along, const Point& across, const Point& n, double h,
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
struct TouchFunctor {
  ContactTable<ExecutionSpace> table;

  KOKKOS_FUNCTION void operator()(const int k) const {
    if (k < table.vertices)
      of_vertex(k);
    else if (k < table.vertices + table.edges)
      of_edge(k - table.vertices);
    else
      of_face(k - table.vertices - table.edges);
  }

  /// Keeps a touch of parts that are `r` apart unless they stay apart on their own.
  KOKKOS_FUNCTION void keep(Touch& touch, const Point& r, double distance) const {
    if (!(distance > 0.0)) return;  // the check after the step sees it
    touch.normal = (1.0 / distance) * r;
    keep(touch, distance);
  }

  KOKKOS_FUNCTION void keep(Touch& touch, double distance) const {
    double closing = 0.0;
    for (int slot = 0; slot < 4; ++slot)
      if (touch.share[slot] != 0.0)
        closing +=
            touch.share[slot] * dot(load_points<double>(table.start_v, touch.vertex[slot]), touch.normal);
    touch.wanted = wanted_velocity(distance, table.thickness, closing, table.dt);
    // Neighbours may yet drive them together.
    if (distance > table.thickness && closing > 0.5 * touch.wanted) return;
    if (touch.friction > 0.0) hold(touch);
    const int number = Kokkos::atomic_fetch_add(&table.progress(0).touches, 1);
    if (number >= static_cast<int>(table.touch.extent(0)))
      return table.raise(table.steps() + 1, FailureReason::too_dense, touch.vertex[0]);
    for (int slot = 0; slot < 4; ++slot)
      if (takes_part(touch, slot)) {
        const int i = touch.vertex[slot], place = Kokkos::atomic_fetch_add(&table.touches(i), 1);
        if (place < most_touches)
          table.mine(i, place) = 4 * number + slot;
        else
          table.raise(table.steps() + 1, FailureReason::too_dense, i);
      }
    table.touch(number) = touch;
  }

  /// Forces that do not change move parts in a step by half of what they kick them: held parts start against
  /// it, or what sticks would creep. Where forces change, the ways of all steps sum to half of the last
  /// kick's, and what friction gives is at most an eighth of the mass times the square of a kick.
  KOKKOS_FUNCTION void hold(Touch& touch) const {
    Point kick{0.0, 0.0, 0.0};
    for (int slot = 0; slot < 4; ++slot) {
      if (!takes_part(touch, slot)) continue;
      const ContactWork& of = table.work(touch.vertex[slot]);
      const Point own{of.kick_x, of.kick_y, of.kick_z};
      kick = kick + touch.share[slot] * own + dot(touch.normal, own) * lever_of(touch, of_edges(touch), slot);
    }
    touch.hold = -0.5 * (kick - dot(kick, touch.normal) * touch.normal);
  }

  /// Whether the triangle answers for its point that is nearest: of its inside always.
  KOKKOS_FUNCTION static bool owns(int bits, const NearestOnTriangle& nearest) {
    if (nearest.inside) return true;
    for (int k = 0; k < 3; ++k) {
      if (nearest.share[k] == 1.0) return (bits >> k & 1) != 0;
      if (nearest.share[(k + 2) % 3] == 0.0 && nearest.share[k] > 0.0 && nearest.share[(k + 1) % 3] > 0.0)
        return (bits >> k & 8) != 0;
    }
    return true;
  }

  KOKKOS_FUNCTION static bool takes_part(const Touch& touch, int slot) {
    const Point lever = lever_of(touch, of_edges(touch), slot);
    return touch.share[slot] != 0.0 || dot(lever, lever) > 0.0;
  }

  KOKKOS_FUNCTION static Touch blank(TouchKind kind, int first, int second, double friction) {
    Touch touch{};
    touch.key = touch_key(kind, first, second);
    touch.friction = friction;
    return touch;
  }

  KOKKOS_FUNCTION void of_vertex(int i) const {
    const Point only[1] = {load_points<double>(table.start_x, i)}, &own = only[0];
    for (int b = 0; b < static_cast<int>(table.bodies.extent(0)); ++b) {
      const Obstacle& body = table.bodies(b);
      const Clearance clear = body.kind == BodyKind::level_set
                                  ? level_clearance(body, own, 0.01 * table.thickness)
                                  : clearance(body, own);
      // Not a number either: the check has told of it.
      if (!(clear.distance <= table.thickness + step_reach())) continue;
      Touch touch = blank(TouchKind::vertex_body, i, b, body.friction);
      touch.vertex[0] = i, touch.share[0] = 1.0, touch.normal = clear.away;
      keep(touch, clear.distance);
    }
    if (!table.self) return;
    for (int k = 0; k < table.near_triangles(i); ++k) {
      const int t = table.near_triangle(i, k);
      Point at[3];
      table.corners(t, table.start_x, at);
      if (boxes_apart(only, at, table.thickness + step_reach())) continue;
      const NearestOnTriangle nearest = nearest_on_triangle(own, at);
      const double distance = Kokkos::sqrt(nearest.squared);
      if (distance > table.thickness + step_reach() || !owns(table.owned(t), nearest)) continue;
      Touch touch = blank(TouchKind::vertex_face, i, t, table.self_friction);
      touch.vertex[0] = i, touch.share[0] = 1.0;
      Point r = own;
      for (int corner = 0; corner < 3; ++corner) {
        touch.vertex[1 + corner] = table.triangle(t, corner);
        touch.share[1 + corner] = -nearest.share[corner];
        r = r - nearest.share[corner] * at[corner];
      }
      if (touch.friction > 0.0 && distance > 0.0 &&
          !levers(at[1] - at[0], at[2] - at[0], (1.0 / distance) * r, distance, touch.lever))
        touch.friction = 0.0;
      keep(touch, r, distance);
    }
  }

  KOKKOS_FUNCTION void of_edge(int e) const {
    Point own[2];
    table.ends(e, table.start_x, own);
    for (int b = 0; b < static_cast<int>(table.bodies.extent(0)); ++b) {
      const Obstacle& body = table.bodies(b);
      if (!between_vertices(body)) continue;
      const Point middle = 0.5 * (own[0] + own[1]);
      if (clearance(body, middle).distance > table.thickness + step_reach() + 0.5 * length(own[1] - own[0]))
        continue;
      const double u = nearest_to_body(body, own[0], own[1]);
      if (!(u > 1e-9 && u < 1.0 - 1e-9)) continue;  // its vertices see to that
      const Clearance clear = clearance(body, own[0] + u * (own[1] - own[0]));
      if (clear.distance > table.thickness + step_reach()) continue;
      Touch touch = blank(TouchKind::edge_body, e, b, body.friction);
      for (int end = 0; end < 2; ++end) touch.vertex[end] = table.edge(e, end);
      touch.share[0] = 1.0 - u, touch.share[1] = u, touch.normal = clear.away;
      keep(touch, clear.distance);
    }
    if (!table.self) return;
    for (int k = 0; k < table.near_edges(e); ++k) {
      const int f = table.near_edge(e, k);
      Point other[2];
      table.ends(f, table.start_x, other);
      if (boxes_apart(own, other, table.thickness + step_reach())) continue;
      const NearestOfSegments nearest = nearest_of_segments(own, other);
      const double distance = Kokkos::sqrt(nearest.squared);
      // At an end a vertex and a triangle are as near.
      if (!nearest.inside || distance > table.thickness + step_reach()) continue;
      Touch touch = blank(TouchKind::edge_edge, e, f, table.self_friction);
      for (int end = 0; end < 2; ++end)
        touch.vertex[end] = table.edge(e, end), touch.vertex[2 + end] = table.edge(f, end);
      const double s = nearest.first, u = nearest.second;
      touch.share[0] = 1.0 - s, touch.share[1] = s, touch.share[2] = u - 1.0, touch.share[3] = -u;
      const Point r = (1.0 - s) * own[0] + s * own[1] - ((1.0 - u) * other[0] + u * other[1]);
      if (touch.friction > 0.0 && distance > 0.0 &&
          !levers(own[1] - own[0], other[1] - other[0], (1.0 / distance) * r, distance, touch.lever))
        touch.friction = 0.0;
      keep(touch, r, distance);
    }
  }

  KOKKOS_FUNCTION void of_face(int t) const {
    Point at[3], place;
    table.corners(t, table.start_x, at);
    const Point normal = cross(at[1] - at[0], at[2] - at[0]);
    for (int b = 0; b < static_cast<int>(table.bodies.extent(0)); ++b) {
      const Obstacle& body = table.bodies(b);
      if (!between_vertices(body)) continue;
      const double size = body.kind == BodyKind::sphere ? body.radius : 0.0;
      for (int side = 0; side < 2; ++side) {
        if (!facing_place(body, normal, side, place)) continue;
        const Point only[1] = {place};
        if (boxes_apart(only, at, size + table.thickness + step_reach())) continue;
        const NearestOnTriangle nearest = nearest_on_triangle(place, at);
        const double out = Kokkos::sqrt(nearest.squared), distance = out - size;
        if (!nearest.inside || !(out > 0.0) || distance > table.thickness + step_reach()) continue;
        Touch touch = blank(TouchKind::face_body, t, 2 * b + side, body.friction);
        Point r{-place.x, -place.y, -place.z};
        for (int corner = 0; corner < 3; ++corner) {
          touch.vertex[corner] = table.triangle(t, corner);
          touch.share[corner] = nearest.share[corner];
          r = r + nearest.share[corner] * at[corner];
        }
        touch.normal = (1.0 / out) * r;
        keep(touch, distance);
      }
    }
  }

  /// What parts that use up half of what they have beyond the thickness in a step have at most, m.
  [[nodiscard]] KOKKOS_FUNCTION double step_reach() const { return 4.0 * table.dt * table.progress(0).speed; }
};

/// Orders the touches of vertex i by the parts that they are of.
template <class ExecutionSpace>
KOKKOS_FUNCTION void order_touches(const ContactTable<ExecutionSpace>& table, int i) {
  const int count = table.touches(i) < most_touches ? table.touches(i) : most_touches;
  table.touches(i) = count;
  for (int k = 1; k < count; ++k) {
    const int moved = table.mine(i, k);
    const std::uint64_t key = table.touch(moved / 4).key;
    int place = k;
    for (; place > 0 && table.touch(table.mine(i, place - 1) / 4).key > key; --place)
      table.mine(i, place) = table.mine(i, place - 1);
    table.mine(i, place) = moved;
  }
}

}  // namespace drogue::fabric
