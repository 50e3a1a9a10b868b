#pragma once

#include "kernels/fabric/contact/contact_views.hpp"
#include "kernels/fabric/contact/union_find.hpp"

namespace drogue::fabric {

/// The least distance, m, that parts may have on their way when they set out `distance` apart: far apart a
/// share of the thickness; parts that are nearer may halve their distance, and below a last floor only lose
/// what round-off takes.
KOKKOS_INLINE_FUNCTION double least_distance(double distance, double thickness) {
  const double near = 0.1 * thickness, floor = 1e-3 * thickness;
  const double half = 0.5 * (distance < near ? distance : near), same = distance * (1.0 - 1e-6);
  const double last = floor < same ? floor : same;
  return half > last ? half : last;
}

/// Whether parts keep at least that distance on a straight way through a step: conservative advancement (Li,
/// Kaufman and Jiang 2021, additive continuous detection). `distance_at(share of the way)` is their distance,
/// which changes by at most `way` over all of it. Where it is not sure within 64 advances, no.
template <class DistanceAt>
KOKKOS_INLINE_FUNCTION bool ccd_keeps_distance(const DistanceAt& distance_at, double way, double thickness) {
  double gone = 0.0, distance = distance_at(0.0);
  const double least = least_distance(distance, thickness);
  for (int advance = 0; advance < 64; ++advance) {
    const double spare = distance - least;
    if (!(spare > 0.0)) return false;
    if ((1.0 - gone) * way < spare) return true;
    gone += 0.9 * spare / way;
    distance = distance_at(gone);
  }
  return false;
}

/// Looks whether parts cross between the beginning and the end of the step: of every vertex, edge and
/// triangle. Those that do are joined to a zone; vertices that would enter a body are stuck.
template <class ExecutionSpace>
struct CcdFunctor {
  using Points3 = UnmanagedTable<ExecutionSpace, double, 3>;

  ContactViews<ExecutionSpace> views;
  Points3 end;  ///< positions at the end of the step
  int round;

  KOKKOS_FUNCTION void operator()(const int k) const {
    if (round > 0 && views.progress(0).crossing[round - 1] == 0) return;
    if (k < views.vertices)
      of_vertex(k);
    else if (k < views.vertices + views.edges)
      of_edge(k - views.vertices);
    else
      of_face(k - views.vertices - views.edges);
  }

  template <int size>
  KOKKOS_FUNCTION void cross_over(const int (&vertex)[size]) const {
    Kokkos::atomic_store(&views.progress(0).crossing[round], 1);
    if (round == zone_rounds) views.raise(views.steps(), FailureReason::crossing, vertex[0]);
    for (int k = 1; k < size; ++k) unite(views.zone, vertex[0], vertex[k]);
  }

  template <int size>
  KOKKOS_FUNCTION void enter(const int (&vertex)[size]) const {
    Kokkos::atomic_store(&views.progress(0).crossing[round], 1);
    if (round == zone_rounds) views.raise(views.steps(), FailureReason::crossing, vertex[0]);
    for (const int i : vertex) Kokkos::atomic_store(&views.stuck(i), 1);
  }

  /// Where some vertices begin, how far each goes, and whether all belong to one zone that moves as a rigid
  /// body and so keeps its distances.
  template <int size>
  struct Trajectories {
    Point from[size], way[size];
    bool rigid;
  };

  template <int size>
  KOKKOS_FUNCTION Trajectories<size> trajectories(const int (&vertex)[size]) const {
    Trajectories<size> w;
    w.rigid = round > 0;
    const int zone = views.label(vertex[0]);
    for (int k = 0; k < size; ++k) {
      w.from[k] = load_points<double>(views.start_x, vertex[k]);
      w.way[k] = load_points<double>(end, vertex[k]) - w.from[k];
      w.rigid = w.rigid && views.label(vertex[k]) == zone;
    }
    w.rigid = w.rigid && views.motion(zone).held == 0;
    return w;
  }

  /// What of the ways is not common to all, m, of the first `first` vertices and of the others together.
  template <int size>
  KOKKOS_FUNCTION static double relative_displacement(const Trajectories<size>& w, int first) {
    Point mean{0.0, 0.0, 0.0};
    for (const Point& way : w.way) mean = mean + (1.0 / size) * way;
    double most[2] = {0.0, 0.0};
    for (int k = 0; k < size; ++k) {
      double& side = most[k < first ? 0 : 1];
      const double way = length(w.way[k] - mean);
      side = way > side ? way : side;
    }
    return most[0] + most[1];
  }

  KOKKOS_FUNCTION void of_vertex(int i) const {
    const int only[1] = {i};
    const Trajectories<1> own = trajectories(only);
    const double length_of_way = length(own.way[0]);
    const double strayed = length(own.from[0] + own.way[0] - load_points<double>(views.listed_x, i));
    if (views.self && strayed > 0.5 * views.progress(0).skin && strayed < divergence_limit)
      views.raise(views.steps(), FailureReason::too_fast, i);
    if (length_of_way > 0.0 && !views.is_held(i))
      for (int b = 0; b < static_cast<int>(views.bodies.extent(0)); ++b) {
        const Obstacle& body = views.bodies(b);
        bool keeps_out = true;
        if (body.kind == BodyKind::level_set) {
          // No bound is known for how fast a level set changes: only where the way ends counts.
          double distance[2];
          for (int k = 0; k < 2; ++k)
            distance[k] =
                level_set_distance(body, own.from[0] + (1.0 * k) * own.way[0], 0.01 * views.thickness)
                    .distance;
          const bool told = distance[0] == distance[0] && distance[1] == distance[1];
          if (!told && strayed < divergence_limit) views.raise(views.steps(), FailureReason::no_number, i);
          keeps_out = !told || distance[1] > least_distance(distance[0], views.thickness);
        } else {
          const auto distance_at = [&](double part) {
            return signed_distance(body, own.from[0] + part * own.way[0]).distance;
          };
          keeps_out = ccd_keeps_distance(distance_at, length_of_way, views.thickness);
        }
        if (!keeps_out) enter(only);
      }
    if (!views.self) return;
    for (int k = 0; k < views.near_triangles(i); ++k) {
      const int t = views.near_triangle(i, k);
      const int vertex[4] = {i, views.triangle(t, 0), views.triangle(t, 1), views.triangle(t, 2)};
      const Trajectories<4> w = trajectories(vertex);
      if (w.rigid) continue;
      const Point a[2] = {w.from[0], w.from[0] + w.way[0]},
                  b[6] = {
                      w.from[1],           w.from[2], w.from[3], w.from[1] + w.way[1], w.from[2] + w.way[2],
                      w.from[3] + w.way[3]};
      if (boxes_apart(a, b, 0.1 * views.thickness)) continue;
      const auto distance_at = [&](double part) {
        const Point at[3] = {w.from[1] + part * w.way[1], w.from[2] + part * w.way[2],
                             w.from[3] + part * w.way[3]};
        return Kokkos::sqrt(closest_on_triangle(w.from[0] + part * w.way[0], at).squared);
      };
      if (!ccd_keeps_distance(distance_at, relative_displacement(w, 1), views.thickness)) cross_over(vertex);
    }
  }

  KOKKOS_FUNCTION void of_edge(int e) const {
    const int own[2] = {views.edge(e, 0), views.edge(e, 1)};
    // Faces see to their edges.
    if (e >= views.first_line)
      bodies(own,
             [](const Obstacle& body, const Point(&at)[2]) { return edge_distance(body, at[0], at[1]); });
    if (!views.self) return;
    for (int k = 0; k < views.near_edges(e); ++k) {
      const int f = views.near_edge(e, k);
      const int vertex[4] = {own[0], own[1], views.edge(f, 0), views.edge(f, 1)};
      const Trajectories<4> w = trajectories(vertex);
      if (w.rigid) continue;
      const Point a[4] = {w.from[0], w.from[1], w.from[0] + w.way[0], w.from[1] + w.way[1]},
                  b[4] = {w.from[2], w.from[3], w.from[2] + w.way[2], w.from[3] + w.way[3]};
      if (boxes_apart(a, b, 0.1 * views.thickness)) continue;
      const auto distance_at = [&](double part) {
        const Point p[2] = {w.from[0] + part * w.way[0], w.from[1] + part * w.way[1]},
                    q[2] = {w.from[2] + part * w.way[2], w.from[3] + part * w.way[3]};
        return Kokkos::sqrt(closest_of_segments(p, q).squared);
      };
      if (!ccd_keeps_distance(distance_at, relative_displacement(w, 2), views.thickness)) cross_over(vertex);
    }
  }

  KOKKOS_FUNCTION void of_face(int t) const {
    const int own[3] = {views.triangle(t, 0), views.triangle(t, 1), views.triangle(t, 2)};
    bodies(own, [](const Obstacle& body, const Point(&at)[3]) {
      if (body.kind == BodyKind::sphere)
        return Kokkos::sqrt(closest_on_triangle(body.centre, at).squared) - body.radius;
      double least = 1e300;
      for (int side = 0; side < 2; ++side) {
        Point place;
        if (!facing_place(body, cross(at[1] - at[0], at[2] - at[0]), side, place)) continue;
        const double out = Kokkos::sqrt(closest_on_triangle(place, at).squared);
        least = out < least ? out : least;
      }
      for (int side = 0; side < 3; ++side) {
        const double out = edge_distance(body, at[side], at[(side + 1) % 3]);
        least = out < least ? out : least;
      }
      return least;
    });
  }

  /// Bodies and a part of which `distance(body, places)` tells the distance.
  template <int size, class Distance>
  KOKKOS_FUNCTION void bodies(const int (&vertex)[size], const Distance& distance) const {
    for (int b = 0; b < static_cast<int>(views.bodies.extent(0)); ++b) {
      const Obstacle& body = views.bodies(b);
      if (!between_vertices(body)) continue;
      const Trajectories<size> w = trajectories(vertex);
      double most = 0.0, extent = 0.0;
      bool held = true;
      for (int k = 0; k < size; ++k) {
        const double way = length(w.way[k]), side = length(w.from[k] - w.from[0]);
        most = way > most ? way : most, extent = side > extent ? side : extent;
        held = held && views.is_held(vertex[k]);
      }
      if (held || signed_distance(body, w.from[0]).distance > extent + most + 0.1 * views.thickness) continue;
      const auto distance_at = [&](double part) {
        Point at[size];
        for (int k = 0; k < size; ++k) at[k] = w.from[k] + part * w.way[k];
        return distance(body, at);
      };
      if (!ccd_keeps_distance(distance_at, most, views.thickness)) enter(vertex);
    }
  }
};

}  // namespace drogue::fabric
