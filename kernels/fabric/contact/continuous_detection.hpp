#pragma once

#include "kernels/device/relaxed_access.hpp"
#include "kernels/fabric/contact/contact_views.hpp"
#include "kernels/fabric/contact/union_find.hpp"

namespace drogue::fabric {

/// Least admissible distance during a step, m, for parts at `distance`, m, at its beginning: a fraction of
/// the thickness for distant parts, half of the distance for nearer ones, and below a floor the distance
/// itself but for round-off.
KOKKOS_INLINE_FUNCTION double least_distance(double distance, double thickness) {
  const double near = 0.1 * thickness, floor = 1e-3 * thickness;
  const double half = 0.5 * (distance < near ? distance : near), same = distance * (1.0 - 1e-6);
  const double last = floor < same ? floor : same;
  return half > last ? half : last;
}

/// True if parts keep the least admissible distance along straight paths through a step: conservative
/// advancement (Li, Kaufman and Jiang 2021, additive continuous collision detection). `distance_at(fraction)`
/// is their distance, m, after a fraction of the path; it changes by at most `path`, m, in total. False if 64
/// advances do not decide.
template <class DistanceAt>
KOKKOS_INLINE_FUNCTION bool ccd_keeps_distance(const DistanceAt& distance_at, double path, double thickness) {
  double fraction = 0.0, distance = distance_at(0.0);
  const double least = least_distance(distance, thickness);
  for (int advance = 0; advance < 64; ++advance) {
    const double margin = distance - least;
    if (!(margin > 0.0)) return false;
    if ((1.0 - fraction) * path < margin) return true;
    fraction += 0.9 * margin / path;
    distance = distance_at(fraction);
  }
  return false;
}

/// Detects parts that cross between the beginning and the end of the step, for every vertex, edge and
/// triangle. Crossing parts are united to a zone; vertices that would enter a body are marked as stuck.
template <class ExecutionSpace>
struct CcdFunctor {
  using Points3 = UnmanagedTable<ExecutionSpace, double, 3>;

  ContactViews<ExecutionSpace> views;
  Points3 end;  ///< positions at the end of the step
  int round;

  KOKKOS_FUNCTION void operator()(const int k) const {
    if (round > 0 && views.progress(0).crossing[round - 1] == 0) return;
    if (k < views.vertices)
      check_vertex(k);
    else if (k < views.vertices + views.edges)
      check_edge(k - views.vertices);
    else
      check_face(k - views.vertices - views.edges);
  }

  template <int size>
  KOKKOS_FUNCTION void unite_crossing(const int (&vertex)[size]) const {
    device::relaxed_store(&views.progress(0).crossing[round], 1);
    if (round == zone_rounds) views.raise(views.steps(), FailureReason::crossing, vertex[0]);
    for (int k = 1; k < size; ++k) unite(views.zone, vertex[0], vertex[k]);
  }

  template <int size>
  KOKKOS_FUNCTION void mark_stuck(const int (&vertex)[size]) const {
    device::relaxed_store(&views.progress(0).crossing[round], 1);
    if (round == zone_rounds) views.raise(views.steps(), FailureReason::crossing, vertex[0]);
    for (const int i : vertex) device::relaxed_store(&views.stuck(i), 1);
  }

  /// Initial positions and displacements of some vertices, m. `rigid`: all belong to one zone that moves as a
  /// rigid body, which conserves their distances.
  template <int size>
  struct Trajectories {
    Point from[size], path[size];
    bool rigid;
  };

  template <int size>
  KOKKOS_FUNCTION Trajectories<size> trajectories(const int (&vertex)[size]) const {
    Trajectories<size> w;
    w.rigid = round > 0;
    const int zone = views.label(vertex[0]);
    for (int k = 0; k < size; ++k) {
      w.from[k] = load_points<double>(views.start_x, vertex[k]);
      w.path[k] = load_points<double>(end, vertex[k]) - w.from[k];
      w.rigid = w.rigid && views.label(vertex[k]) == zone;
    }
    w.rigid = w.rigid && views.motion(zone).fixed == 0;
    return w;
  }

  /// Largest displacement relative to the mean, m, of the first `first` vertices plus that of the others.
  template <int size>
  KOKKOS_FUNCTION static double relative_displacement(const Trajectories<size>& w, int first) {
    Point mean{0.0, 0.0, 0.0};
    for (const Point& path : w.path) mean = mean + (1.0 / size) * path;
    double most[2] = {0.0, 0.0};
    for (int k = 0; k < size; ++k) {
      double& side = most[k < first ? 0 : 1];
      const double path = length(w.path[k] - mean);
      side = path > side ? path : side;
    }
    return most[0] + most[1];
  }

  KOKKOS_FUNCTION void check_vertex(int i) const {
    const int only[1] = {i};
    const Trajectories<1> own = trajectories(only);
    const double path_length = length(own.path[0]);
    const double from_listed = length(own.from[0] + own.path[0] - load_points<double>(views.listed_x, i));
    if (views.self && from_listed > 0.5 * views.progress(0).skin && from_listed < divergence_limit)
      views.raise(views.steps(), FailureReason::too_fast, i);
    if (path_length > 0.0 && !views.is_fixed(i))
      for (int b = 0; b < static_cast<int>(views.bodies.extent(0)); ++b) {
        const Obstacle& body = views.bodies(b);
        bool stays_outside = true;
        if (body.kind == BodyKind::level_set) {
          // The slope of a level set has no known bound: only the end of the path is checked.
          double distance[2];
          for (int k = 0; k < 2; ++k)
            distance[k] =
                level_set_distance(body, own.from[0] + (1.0 * k) * own.path[0], 0.01 * views.thickness)
                    .distance;
          const bool is_defined = distance[0] == distance[0] && distance[1] == distance[1];
          if (!is_defined && from_listed < divergence_limit)
            views.raise(views.steps(), FailureReason::no_number, i);
          stays_outside = !is_defined || distance[1] > least_distance(distance[0], views.thickness);
        } else {
          const auto distance_at = [&](double part) {
            return signed_distance(body, own.from[0] + part * own.path[0]).distance;
          };
          stays_outside = ccd_keeps_distance(distance_at, path_length, views.thickness);
        }
        if (!stays_outside) mark_stuck(only);
      }
    if (!views.self) return;
    for (int k = 0; k < views.near_triangles(i); ++k) {
      const int t = views.near_triangle(i, k);
      const int vertex[4] = {i, views.triangle(t, 0), views.triangle(t, 1), views.triangle(t, 2)};
      const Trajectories<4> w = trajectories(vertex);
      if (w.rigid) continue;
      const Point a[2] = {w.from[0], w.from[0] + w.path[0]}, b[6] = {w.from[1],
                                                                     w.from[2],
                                                                     w.from[3],
                                                                     w.from[1] + w.path[1],
                                                                     w.from[2] + w.path[2],
                                                                     w.from[3] + w.path[3]};
      if (boxes_apart(a, b, 0.1 * views.thickness)) continue;
      const auto distance_at = [&](double part) {
        const Point at[3] = {w.from[1] + part * w.path[1], w.from[2] + part * w.path[2],
                             w.from[3] + part * w.path[3]};
        return Kokkos::sqrt(closest_on_triangle(w.from[0] + part * w.path[0], at).squared);
      };
      if (!ccd_keeps_distance(distance_at, relative_displacement(w, 1), views.thickness))
        unite_crossing(vertex);
    }
  }

  KOKKOS_FUNCTION void check_edge(int e) const {
    if (views.is_cut(e) != 0) return;
    const int own[2] = {views.edge(e, 0), views.edge(e, 1)};
    // Faces check the edges of their triangles.
    if (e >= views.first_line)
      check_bodies(
          own, [](const Obstacle& body, const Point(&at)[2]) { return edge_distance(body, at[0], at[1]); });
    if (!views.self) return;
    for (int k = 0; k < views.near_edges(e); ++k) {
      const int f = views.near_edge(e, k);
      const int vertex[4] = {own[0], own[1], views.edge(f, 0), views.edge(f, 1)};
      const Trajectories<4> w = trajectories(vertex);
      if (w.rigid) continue;
      const Point a[4] = {w.from[0], w.from[1], w.from[0] + w.path[0], w.from[1] + w.path[1]},
                  b[4] = {w.from[2], w.from[3], w.from[2] + w.path[2], w.from[3] + w.path[3]};
      if (boxes_apart(a, b, 0.1 * views.thickness)) continue;
      const auto distance_at = [&](double part) {
        const Point p[2] = {w.from[0] + part * w.path[0], w.from[1] + part * w.path[1]},
                    q[2] = {w.from[2] + part * w.path[2], w.from[3] + part * w.path[3]};
        return Kokkos::sqrt(closest_of_segments(p, q).squared);
      };
      if (!ccd_keeps_distance(distance_at, relative_displacement(w, 2), views.thickness))
        unite_crossing(vertex);
    }
  }

  KOKKOS_FUNCTION void check_face(int t) const {
    const int own[3] = {views.triangle(t, 0), views.triangle(t, 1), views.triangle(t, 2)};
    check_bodies(own, [](const Obstacle& body, const Point(&at)[3]) {
      if (body.kind == BodyKind::sphere)
        return Kokkos::sqrt(closest_on_triangle(body.centre, at).squared) - body.radius;
      double least = 1e300;
      for (int side = 0; side < 2; ++side) {
        Point point;
        if (!facing_point(body, cross(at[1] - at[0], at[2] - at[0]), side, point)) continue;
        const double out = Kokkos::sqrt(closest_on_triangle(point, at).squared);
        least = out < least ? out : least;
      }
      for (int side = 0; side < 3; ++side) {
        const double out = edge_distance(body, at[side], at[(side + 1) % 3]);
        least = out < least ? out : least;
      }
      return least;
    });
  }

  /// Checks a part against all bodies; `distance(body, positions)` is its distance from a body, m.
  template <int size, class Distance>
  KOKKOS_FUNCTION void check_bodies(const int (&vertex)[size], const Distance& distance) const {
    for (int b = 0; b < static_cast<int>(views.bodies.extent(0)); ++b) {
      const Obstacle& body = views.bodies(b);
      if (!between_vertices(body)) continue;
      const Trajectories<size> w = trajectories(vertex);
      double most = 0.0, extent = 0.0;
      bool fixed = true;
      for (int k = 0; k < size; ++k) {
        const double path = length(w.path[k]), side = length(w.from[k] - w.from[0]);
        most = path > most ? path : most, extent = side > extent ? side : extent;
        fixed = fixed && views.is_fixed(vertex[k]);
      }
      if (fixed || signed_distance(body, w.from[0]).distance > extent + most + 0.1 * views.thickness)
        continue;
      const auto distance_at = [&](double part) {
        Point at[size];
        for (int k = 0; k < size; ++k) at[k] = w.from[k] + part * w.path[k];
        return distance(body, at);
      };
      if (!ccd_keeps_distance(distance_at, most, views.thickness)) mark_stuck(vertex);
    }
  }
};

}  // namespace drogue::fabric
