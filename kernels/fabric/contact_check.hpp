#pragma once

#include "kernels/fabric/contact_table.hpp"

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
KOKKOS_INLINE_FUNCTION bool stay_apart(const DistanceAt& distance_at, double way, double thickness) {
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

/// Joins the zones of two vertices under the least vertex of both. Whatever the order in which threads join,
/// the zones are the same.
template <class Zones>
KOKKOS_INLINE_FUNCTION int zone_of(const Zones& zone, int i) {
  for (int up = Kokkos::atomic_load(&zone(i)); up != i; up = Kokkos::atomic_load(&zone(i))) i = up;
  return i;
}

template <class Zones>
KOKKOS_INLINE_FUNCTION void join(const Zones& zone, int i, int j) {
  for (;;) {
    i = zone_of(zone, i), j = zone_of(zone, j);
    if (i == j) return;
    const int low = i < j ? i : j, high = i < j ? j : i;
    if (Kokkos::atomic_compare_exchange(&zone(high), high, low) == high) return;
  }
}

/// Looks whether parts cross between the beginning and the end of the step: of every vertex, edge and
/// triangle. Those that do are joined to a zone; vertices that would enter a body are stuck.
template <class ExecutionSpace>
struct CheckFunctor {
  using Places = LentTable<ExecutionSpace, double, 3>;

  ContactTable<ExecutionSpace> table;
  Places end;  ///< positions at the end of the step
  int round;

  KOKKOS_FUNCTION void operator()(const int k) const {
    if (round > 0 && table.progress(0).crossing[round - 1] == 0) return;
    if (k < table.vertices)
      of_vertex(k);
    else if (k < table.vertices + table.edges)
      of_edge(k - table.vertices);
    else
      of_face(k - table.vertices - table.edges);
  }

  template <int size>
  KOKKOS_FUNCTION void cross_over(const int (&vertex)[size]) const {
    Kokkos::atomic_store(&table.progress(0).crossing[round], 1);
    if (round == zone_rounds) table.raise(table.steps(), FailureReason::crossing, vertex[0]);
    for (int k = 1; k < size; ++k) join(table.zone, vertex[0], vertex[k]);
  }

  template <int size>
  KOKKOS_FUNCTION void enter(const int (&vertex)[size]) const {
    Kokkos::atomic_store(&table.progress(0).crossing[round], 1);
    if (round == zone_rounds) table.raise(table.steps(), FailureReason::crossing, vertex[0]);
    for (const int i : vertex) Kokkos::atomic_store(&table.stuck(i), 1);
  }

  /// Where some vertices begin, how far each goes, and whether all belong to one zone that moves as a rigid
  /// body and so keeps its distances.
  template <int size>
  struct Ways {
    Point from[size], way[size];
    bool rigid;
  };

  template <int size>
  KOKKOS_FUNCTION Ways<size> ways(const int (&vertex)[size]) const {
    Ways<size> w;
    w.rigid = round > 0;
    const int zone = table.label(vertex[0]);
    for (int k = 0; k < size; ++k) {
      w.from[k] = load_points<double>(table.start_x, vertex[k]);
      w.way[k] = load_points<double>(end, vertex[k]) - w.from[k];
      w.rigid = w.rigid && table.label(vertex[k]) == zone;
    }
    w.rigid = w.rigid && table.motion(zone).fixed_dofs == 0;
    return w;
  }

  /// What of the ways is not common to all, m, of the first `first` vertices and of the others together.
  template <int size>
  KOKKOS_FUNCTION static double relative_way(const Ways<size>& w, int first) {
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
    const Ways<1> own = ways(only);
    const double length_of_way = length(own.way[0]);
    const double strayed = length(own.from[0] + own.way[0] - load_points<double>(table.listed_x, i));
    if (table.self && strayed > 0.5 * table.progress(0).skin && strayed < divergence_limit)
      table.raise(table.steps(), FailureReason::too_fast, i);
    if (length_of_way > 0.0 && !table.is_held(i))
      for (int b = 0; b < static_cast<int>(table.bodies.extent(0)); ++b) {
        const Obstacle& body = table.bodies(b);
        bool keeps_out = true;
        if (body.kind == BodyKind::level_set) {
          // No bound is known for how fast a level set changes: only where the way ends counts.
          double distance[2];
          for (int k = 0; k < 2; ++k)
            distance[k] =
                level_clearance(body, own.from[0] + (1.0 * k) * own.way[0], 0.01 * table.thickness).distance;
          const bool told = distance[0] == distance[0] && distance[1] == distance[1];
          if (!told && strayed < divergence_limit) table.raise(table.steps(), FailureReason::no_number, i);
          keeps_out = !told || distance[1] > least_distance(distance[0], table.thickness);
        } else {
          const auto distance_at = [&](double part) {
            return clearance(body, own.from[0] + part * own.way[0]).distance;
          };
          keeps_out = stay_apart(distance_at, length_of_way, table.thickness);
        }
        if (!keeps_out) enter(only);
      }
    if (!table.self) return;
    for (int k = 0; k < table.near_triangles(i); ++k) {
      const int t = table.near_triangle(i, k);
      const int vertex[4] = {i, table.triangle(t, 0), table.triangle(t, 1), table.triangle(t, 2)};
      const Ways<4> w = ways(vertex);
      if (w.rigid) continue;
      const Point a[2] = {w.from[0], w.from[0] + w.way[0]},
                  b[6] = {
                      w.from[1],           w.from[2], w.from[3], w.from[1] + w.way[1], w.from[2] + w.way[2],
                      w.from[3] + w.way[3]};
      if (boxes_apart(a, b, 0.1 * table.thickness)) continue;
      const auto distance_at = [&](double part) {
        const Point at[3] = {w.from[1] + part * w.way[1], w.from[2] + part * w.way[2],
                             w.from[3] + part * w.way[3]};
        return Kokkos::sqrt(nearest_on_triangle(w.from[0] + part * w.way[0], at).squared);
      };
      if (!stay_apart(distance_at, relative_way(w, 1), table.thickness)) cross_over(vertex);
    }
  }

  KOKKOS_FUNCTION void of_edge(int e) const {
    const int own[2] = {table.edge(e, 0), table.edge(e, 1)};
    // Faces see to their edges.
    if (e >= table.first_line)
      bodies(own,
             [](const Obstacle& body, const Point(&at)[2]) { return edge_distance(body, at[0], at[1]); });
    if (!table.self) return;
    for (int k = 0; k < table.near_edges(e); ++k) {
      const int f = table.near_edge(e, k);
      const int vertex[4] = {own[0], own[1], table.edge(f, 0), table.edge(f, 1)};
      const Ways<4> w = ways(vertex);
      if (w.rigid) continue;
      const Point a[4] = {w.from[0], w.from[1], w.from[0] + w.way[0], w.from[1] + w.way[1]},
                  b[4] = {w.from[2], w.from[3], w.from[2] + w.way[2], w.from[3] + w.way[3]};
      if (boxes_apart(a, b, 0.1 * table.thickness)) continue;
      const auto distance_at = [&](double part) {
        const Point p[2] = {w.from[0] + part * w.way[0], w.from[1] + part * w.way[1]},
                    q[2] = {w.from[2] + part * w.way[2], w.from[3] + part * w.way[3]};
        return Kokkos::sqrt(nearest_of_segments(p, q).squared);
      };
      if (!stay_apart(distance_at, relative_way(w, 2), table.thickness)) cross_over(vertex);
    }
  }

  KOKKOS_FUNCTION void of_face(int t) const {
    const int own[3] = {table.triangle(t, 0), table.triangle(t, 1), table.triangle(t, 2)};
    bodies(own, [](const Obstacle& body, const Point(&at)[3]) {
      if (body.kind == BodyKind::sphere)
        return Kokkos::sqrt(nearest_on_triangle(body.centre, at).squared) - body.radius;
      double least = 1e300;
      for (int side = 0; side < 2; ++side) {
        Point place;
        if (!facing_place(body, cross(at[1] - at[0], at[2] - at[0]), side, place)) continue;
        const double out = Kokkos::sqrt(nearest_on_triangle(place, at).squared);
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
    for (int b = 0; b < static_cast<int>(table.bodies.extent(0)); ++b) {
      const Obstacle& body = table.bodies(b);
      if (!between_vertices(body)) continue;
      const Ways<size> w = ways(vertex);
      double most = 0.0, extent = 0.0;
      bool fixed_dofs = true;
      for (int k = 0; k < size; ++k) {
        const double way = length(w.way[k]), side = length(w.from[k] - w.from[0]);
        most = way > most ? way : most, extent = side > extent ? side : extent;
        fixed_dofs = fixed_dofs && table.is_held(vertex[k]);
      }
      if (fixed_dofs || clearance(body, w.from[0]).distance > extent + most + 0.1 * table.thickness) continue;
      const auto distance_at = [&](double part) {
        Point at[size];
        for (int k = 0; k < size; ++k) at[k] = w.from[k] + part * w.way[k];
        return distance(body, at);
      };
      if (!stay_apart(distance_at, most, table.thickness)) enter(vertex);
    }
  }
};

}  // namespace drogue::fabric
