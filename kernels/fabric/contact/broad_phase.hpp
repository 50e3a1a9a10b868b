#pragma once

#include "kernels/fabric/contact/contact_views.hpp"
#include "kernels/spatial/hash_grid.hpp"

namespace drogue::fabric {

// Neighbour lists, rebuilt only after vertices have moved far enough (Verlet 1967). Parts outside of the
// lists are farther apart than the contact distance, so that the result of a step does not depend on the age
// of a list.

/// Initialises the data of a step of vertex i.
template <class ExecutionSpace>
KOKKOS_INLINE_FUNCTION void reset_vertex(const ContactViews<ExecutionSpace>& views, int i) {
  views.constraints(i) = 0;
  views.zone(i) = views.label(i) = views.zone_end(i) = i;
  views.stuck(i) = 0;
}

/// Maximum displacement since the last build and maximum speed; initialises the data of a step per vertex.
template <class ExecutionSpace>
struct MotionBoundsFunctor {
  ContactViews<ExecutionSpace> views;
  UnmanagedTable<ExecutionSpace, double, 3> x, v;

  KOKKOS_FUNCTION void operator()(const int i) const {
    const Point at = load_points<double>(x, i), velocity = load_points<double>(v, i);
    atomic_raise(views.progress(0).moved, length(at - load_points<double>(views.listed_x, i)));
    atomic_raise(views.progress(0).fastest, length(velocity));
    store_points(views.start_x, i, at);
    store_points(views.start_v, i, velocity);
    reset_vertex(views, i);
  }
};

/// Stores the positions at the beginning of an interval of `dt`, s.
template <class ExecutionSpace>
struct StartIntervalFunctor {
  ContactViews<ExecutionSpace> views;
  UnmanagedTable<ExecutionSpace, double, 3> x;
  double dt;

  KOKKOS_FUNCTION void operator()(const int i) const {
    if (i == 0) views.progress(0).dt = dt;
    store_points(views.start_x, i, load_points<double>(x, i));
  }
};

/// Mean velocity of vertex i in an interval that ends at x, m/s.
template <class ExecutionSpace, class Points>
KOKKOS_INLINE_FUNCTION Point mean_velocity(const ContactViews<ExecutionSpace>& views, const Points& x,
                                           int i) {
  return (1.0 / views.progress(0).dt) * (load_points<double>(x, i) - load_points<double>(views.start_x, i));
}

/// `MotionBoundsFunctor` for the mean velocities in an interval.
template <class ExecutionSpace>
struct MeanMotionFunctor {
  ContactViews<ExecutionSpace> views;
  UnmanagedTable<ExecutionSpace, double, 3> x;

  KOKKOS_FUNCTION void operator()(const int i) const {
    const Point velocity = mean_velocity(views, x, i), start = load_points<double>(views.start_x, i);
    atomic_raise(views.progress(0).moved, length(start - load_points<double>(views.listed_x, i)));
    atomic_raise(views.progress(0).fastest, length(velocity));
    store_points(views.start_v, i, velocity);
    reset_vertex(views, i);
  }
};

/// Decides whether the lists remain valid: at the end of the step no vertex may be farther than half the skin
/// from its listed position. Forces and impulses may double the largest speed and move vertices at rest a
/// little. In an interval the speeds are those after the forces, and impulses hardly raise the largest one.
/// The skin is 16 steps at the present speed, or 5 intervals: a wider one has more pairs to test, a narrower
/// one is rebuilt too often. Launched for one index.
///
/// Crumpled cloth may have more neighbours within the skin than a list holds, though few within reach:
/// `NarrowSkinFunctor` then takes the least one that is valid for this step.
template <class ExecutionSpace>
struct RebuildDecisionFunctor {
  ContactViews<ExecutionSpace> views;

  KOKKOS_FUNCTION void operator()(const int) const {
    ContactStatus& progress = views.progress(0);
    progress.speed = value_of_bits(progress.fastest);
    const double stride = progress.dt * progress.speed, little = 0.1 * views.widest_skin;
    const double ahead = (views.by_interval ? 1.25 : 2.0) * stride + little;
    const double farthest = value_of_bits(progress.moved) + ahead;
    progress.stale = !(farthest <= 0.5 * progress.skin) ? 1 : 0;
    // Positions after a failure are in no grid.
    if (views.by_interval && views.monitor.has_failed()) progress.stale = 0;
    if (progress.stale != 0) {
      const auto larger = [](double a, double b) { return a > b ? a : b; };
      const double strides = views.by_interval ? 6.0 : 18.0,
                   skin = larger(2.0 * (little + strides * stride), 4.0 * little),
                   least = views.by_interval ? 2.0 * ahead : 8.0 * stride;
      progress.skin = larger(skin < views.widest_skin ? skin : views.widest_skin, least);
      // For this step alone, in which vertices at rest move by a hundredth of an edge at most.
      progress.least_skin = (views.by_interval ? 2.5 : 8.0) * stride + 0.2 * little;
      progress.grid_skin = progress.skin;
      progress.extent = 0;
    }
    progress.moved = progress.fastest = 0;
    progress.constraints = progress.crowded = 0;
    for (int& crossing : progress.crossing) crossing = 0;
  }
};

/// Clears the grid, stores the listed positions and computes the largest extent of an edge along an axis.
template <class ExecutionSpace>
struct ClearGridFunctor {
  ContactViews<ExecutionSpace> views;

  KOKKOS_FUNCTION void operator()(const int k) const {
    if (views.progress(0).stale == 0) return;
    if (k < static_cast<int>(views.triangle_heads.extent(0)))
      views.triangle_heads(k) = -1, views.edge_heads(k) = -1;
    if (k < views.vertices) store_points(views.listed_x, k, load_points<double>(views.start_x, k));
    const auto measure = [&](const Point& d) {
      const double x = Kokkos::fabs(d.x), y = Kokkos::fabs(d.y), z = Kokkos::fabs(d.z);
      const double most = x > y ? x : y;
      atomic_raise(views.progress(0).extent, most > z ? most : z);
    };
    // Edges include those of triangles, whose extent they bound.
    if (k < views.edges && views.is_long(k) == 0 && views.is_cut(k) == 0) {
      Point end[2];
      views.ends(k, views.start_x, end);
      measure(end[1] - end[0]);
    }
  }
};

/// Grid with cells so wide that near parts lie in adjacent cells.
template <class ExecutionSpace>
KOKKOS_INLINE_FUNCTION spatial::HashGrid search_grid(const ContactViews<ExecutionSpace>& views) {
  const ContactStatus& progress = views.progress(0);
  const double width = value_of_bits(progress.extent) + views.thickness + progress.grid_skin;
  return spatial::HashGrid{width};
}

/// Inserts every triangle and edge into the cell of its centre, except for long edges: cells as wide as a
/// suspension line would hold most of a canopy.
template <class ExecutionSpace>
struct FillGridFunctor {
  ContactViews<ExecutionSpace> views;

  KOKKOS_FUNCTION void operator()(const int k) const {
    if (views.progress(0).stale == 0) return;
    if (k < views.triangles) {
      Point at[3];
      views.corners(k, views.start_x, at);
      put(k, at, views.triangle_sphere, views.triangle_heads);
    }
    if (k < views.edges && views.is_cut(k) == 0) {
      Point at[2];
      views.ends(k, views.start_x, at);
      if (views.is_long(k) != 0)
        views.edge_sphere(k) = spatial::bounding_sphere(at);
      else
        put(k, at, views.edge_sphere, views.edge_heads);
    }
  }

  template <int size, class Spheres, class Heads>
  KOKKOS_FUNCTION void put(int k, const Point (&at)[size], const Spheres& spheres, const Heads& heads) const {
    search_grid(views).insert(k, spatial::bounding_sphere(at), heads, spheres);
  }
};

/// Takes the least skin if a list was too short for its neighbours. Launched for one index.
template <class ExecutionSpace>
struct NarrowSkinFunctor {
  ContactViews<ExecutionSpace> views;

  KOKKOS_FUNCTION void operator()(const int) const {
    ContactStatus& progress = views.progress(0);
    if (progress.stale != 0 && progress.crowded != 0) progress.skin = progress.least_skin;
  }
};

/// Lists the near triangles of every vertex and the near edges with larger numbers of every edge. With
/// `narrowed` it repeats that after `NarrowSkinFunctor`, if there was no room.
template <class ExecutionSpace>
struct NeighbourListFunctor {
  ContactViews<ExecutionSpace> views;
  bool narrowed;

  KOKKOS_FUNCTION void operator()(const int k) const {
    if (views.progress(0).stale == 0 || (narrowed && views.progress(0).crowded == 0)) return;
    if (k < views.vertices)
      list_triangles(k);
    else
      list_edges(k - views.vertices);
  }

  /// A list near vertex i has no room.
  KOKKOS_FUNCTION void overflow(int i) const {
    if (narrowed)
      views.raise(views.present_step(), FailureReason::too_dense, i);
    else
      device::relaxed_store(&views.progress(0).crowded, 1);
  }

  KOKKOS_FUNCTION void list_triangles(int i) const {
    const Point own[1] = {load_points<double>(views.start_x, i)};
    const double cutoff_distance = views.cutoff_distance(), squared = cutoff_distance * cutoff_distance;
    int count = 0;
    const int room = static_cast<int>(views.near_triangle.extent(1));
    const spatial::HashGrid grid = search_grid(views);
    grid.for_each_candidate(own[0], views.triangle_heads, views.triangle_sphere, [&](int t) {
      if (!views.triangle_sphere(t).is_near(own[0], cutoff_distance)) return;
      for (int corner = 0; corner < 3; ++corner)
        if (views.triangle(t, corner) == i) return;
      Point at[3];
      views.corners(t, views.start_x, at);
      if (boxes_apart(own, at, cutoff_distance) || closest_on_triangle(own[0], at).squared > squared) return;
      if (count < room)
        views.near_triangle(i, count) = t;
      else
        overflow(i);
      ++count;
    });
    views.near_triangles(i) = count < room ? count : room;
  }

  KOKKOS_FUNCTION void list_edges(int e) const {
    if (views.is_cut(e) != 0) {
      views.near_edges(e) = 0;
      return;
    }
    Point own[2], other[2];
    views.ends(e, views.start_x, own);
    const BoundingSphere own_sphere = views.edge_sphere(e);
    const double cutoff_distance = views.cutoff_distance(), squared = cutoff_distance * cutoff_distance;
    int count = 0;
    const int room = static_cast<int>(views.near_edge.extent(1));
    const int a = views.edge(e, 0), b = views.edge(e, 1);
    const auto list_if_near = [&](int f) {
      if (f <= e || views.is_cut(f) != 0 ||
          !views.edge_sphere(f).is_near(own_sphere.centre, cutoff_distance + own_sphere.radius))
        return;
      const int c = views.edge(f, 0), d = views.edge(f, 1);
      if (c == a || c == b || d == a || d == b) return;
      views.ends(f, views.start_x, other);
      if (boxes_apart(own, other, cutoff_distance) || closest_of_segments(own, other).squared > squared)
        return;
      if (count < room)
        views.near_edge(e, count) = f;
      else
        overflow(a);
      ++count;
    };
    if (views.is_long(e) != 0) {
      for (int f = e + 1; f < views.edges; ++f) list_if_near(f);
    } else {
      search_grid(views).for_each_candidate(own_sphere.centre, views.edge_heads, views.edge_sphere,
                                            list_if_near);
      for (int k = 0; k < static_cast<int>(views.long_edge.extent(0)); ++k) list_if_near(views.long_edge(k));
    }
    views.near_edges(e) = count < room ? count : room;
  }
};

}  // namespace drogue::fabric
