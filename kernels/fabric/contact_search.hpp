#pragma once

#include "kernels/fabric/contact_table.hpp"

namespace drogue::fabric {

// Lists of near parts, made again only when vertices have moved far enough (Verlet 1967): parts that are not
// in them are farther apart than contact reaches, so what a step does depends on no list's age.

/// Measures how far and how fast vertices move, and prepares what a step counts. Of every vertex.
template <class ExecutionSpace>
struct MeasureFunctor {
  ContactTable<ExecutionSpace> table;
  LentTable<ExecutionSpace, double, 3> x, v;

  KOKKOS_FUNCTION void operator()(const int i) const {
    const Point at = load_points<double>(x, i), velocity = load_points<double>(v, i);
    raise_to(table.progress(0).moved, length(at - load_points<double>(table.listed_x, i)));
    raise_to(table.progress(0).fastest, length(velocity));
    store_points(table.start_x, i, at);
    store_points(table.start_v, i, velocity);
    table.touches(i) = 0;
    table.zone(i) = table.label(i) = table.zone_end(i) = i;
    table.stuck(i) = 0;
  }
};

/// Decides whether the lists still hold: at the end of the step no vertex may be farther than half the skin
/// from where they were made; forces and impulses may double the largest speed, and move what rests a little.
/// A skin of 16 steps at the present speed: a wider one has more pairs to ask about, a narrower one is made
/// again too often. One call.
template <class ExecutionSpace>
struct DecideFunctor {
  ContactTable<ExecutionSpace> table;

  KOKKOS_FUNCTION void operator()(const int) const {
    ContactProgress& progress = table.progress(0);
    progress.speed = number_of(progress.fastest);
    const double stride = table.dt * progress.speed, little = 0.1 * table.widest_skin;
    const double farthest = number_of(progress.moved) + 2.0 * stride + little;
    progress.stale = !(farthest <= 0.5 * progress.skin) ? 1 : 0;
    if (progress.stale != 0) {
      const auto larger = [](double a, double b) { return a > b ? a : b; };
      const double wanted = larger(2.0 * (little + 18.0 * stride), 4.0 * little);
      progress.skin = larger(wanted < table.widest_skin ? wanted : table.widest_skin, 8.0 * stride);
      progress.extent = 0;
    }
    progress.moved = progress.fastest = 0;
    progress.touches = 0;
    for (int& crossing : progress.crossing) crossing = 0;
  }
};

/// Empties the cells and finds the largest extent. Of every bucket, triangle, edge and vertex.
template <class ExecutionSpace>
struct EmptyFunctor {
  ContactTable<ExecutionSpace> table;

  KOKKOS_FUNCTION void operator()(const int k) const {
    if (table.progress(0).stale == 0) return;
    if (k < static_cast<int>(table.first_triangle.extent(0)))
      table.first_triangle(k) = -1, table.first_edge(k) = -1;
    if (k < table.vertices) store_points(table.listed_x, k, load_points<double>(table.start_x, k));
    const auto measure = [&](const Point& d) {
      const double x = Kokkos::fabs(d.x), y = Kokkos::fabs(d.y), z = Kokkos::fabs(d.z);
      const double most = x > y ? x : y;
      raise_to(table.progress(0).extent, most > z ? most : z);
    };
    // The edges of a triangle are edges too: they span it.
    if (k < table.edges) {
      Point end[2];
      table.ends(k, table.start_x, end);
      measure(end[1] - end[0]);
    }
  }
};

/// A cell of the grid, wide enough that near parts lie in neighbouring ones: 21 bits an axis.
template <class ExecutionSpace>
struct Cells {
  double width;

  KOKKOS_FUNCTION explicit Cells(const ContactTable<ExecutionSpace>& table)
      : width(number_of(table.progress(0).extent) + table.reach()) {}

  KOKKOS_FUNCTION static std::uint64_t packed(std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto bits = [](std::int64_t a) { return static_cast<std::uint64_t>(a) & 0x1fffffU; };
    return bits(x) << 42U | bits(y) << 21U | bits(z);
  }
  [[nodiscard]] KOKKOS_FUNCTION std::int64_t along(double x) const {
    return static_cast<std::int64_t>(Kokkos::floor(x / width));
  }
  [[nodiscard]] KOKKOS_FUNCTION std::uint64_t of(const Point& p) const {
    return packed(along(p.x), along(p.y), along(p.z));
  }
  /// Multiplicative hashing (Knuth 1973, vol. 3, 6.4).
  KOKKOS_FUNCTION static int bucket(std::uint64_t cell, std::size_t buckets) {
    return static_cast<int>((cell * 0x9e3779b97f4a7c15U >> 32U) & (buckets - 1));
  }

  /// Calls `take(part)` for what lies in the cell of p and in those about it.
  template <class First, class Balls, class Take>
  KOKKOS_FUNCTION void about(const Point& p, const First& first, const Balls& balls, const Take& take) const {
    const std::int64_t x = along(p.x), y = along(p.y), z = along(p.z);
    for (int near = 0; near < 27; ++near) {
      const std::uint64_t cell = packed(x + near % 3 - 1, y + near / 3 % 3 - 1, z + near / 9 - 1);
      for (int part = first(bucket(cell, first.extent(0))); part >= 0; part = balls(part).next)
        if (balls(part).cell == cell) take(part);
    }
  }
};

/// Puts every triangle and edge into the cell of its centre.
template <class ExecutionSpace>
struct FillFunctor {
  ContactTable<ExecutionSpace> table;

  KOKKOS_FUNCTION void operator()(const int k) const {
    if (table.progress(0).stale == 0) return;
    if (k < table.triangles) {
      Point at[3];
      table.corners(k, table.start_x, at);
      put(k, at, table.ball_of_triangle, table.first_triangle);
    }
    if (k < table.edges) {
      Point at[2];
      table.ends(k, table.start_x, at);
      put(k, at, table.ball_of_edge, table.first_edge);
    }
  }

  template <int size, class Balls, class First>
  KOKKOS_FUNCTION void put(int k, const Point (&at)[size], const Balls& balls, const First& first) const {
    Ball ball{{0.0, 0.0, 0.0}, 0.0, 0, -1};
    for (const Point& p : at) ball.centre = ball.centre + (1.0 / size) * p;
    for (const Point& p : at) {
      const double out = length(p - ball.centre);
      ball.radius = out > ball.radius ? out : ball.radius;
    }
    ball.radius *= 1.0 + 1e-12;  // round-off must not make it too small
    const Cells<ExecutionSpace> cells(table);
    ball.cell = cells.of(ball.centre);
    ball.next = Kokkos::atomic_exchange(&first(cells.bucket(ball.cell, first.extent(0))), k);
    balls(k) = ball;
  }
};

/// Lists what is near: triangles of every vertex, then of every edge those that come after it.
template <class ExecutionSpace>
struct ListFunctor {
  ContactTable<ExecutionSpace> table;

  KOKKOS_FUNCTION void operator()(const int k) const {
    if (table.progress(0).stale == 0) return;
    if (k < table.vertices)
      list_triangles(k);
    else
      list_edges(k - table.vertices);
  }

  KOKKOS_FUNCTION void list_triangles(int i) const {
    const Point own[1] = {load_points<double>(table.start_x, i)};
    const double reach = table.reach(), squared = reach * reach;
    int count = 0;
    const Cells<ExecutionSpace> cells(table);
    cells.about(own[0], table.first_triangle, table.ball_of_triangle, [&](int t) {
      if (!table.ball_of_triangle(t).is_near(own[0], reach)) return;
      for (int corner = 0; corner < 3; ++corner)
        if (table.triangle(t, corner) == i) return;
      Point at[3];
      table.corners(t, table.start_x, at);
      if (boxes_apart(own, at, reach) || nearest_on_triangle(own[0], at).squared > squared) return;
      if (count < most_near)
        table.near_triangle(i, count) = t;
      else
        table.raise(table.steps() + 1, FailureReason::too_dense, i);
      ++count;
    });
    table.near_triangles(i) = count < most_near ? count : most_near;
  }

  KOKKOS_FUNCTION void list_edges(int e) const {
    Point own[2], other[2];
    table.ends(e, table.start_x, own);
    const Ball mine = table.ball_of_edge(e);
    const double reach = table.reach(), squared = reach * reach;
    int count = 0;
    const Cells<ExecutionSpace> cells(table);
    const int a = table.edge(e, 0), b = table.edge(e, 1);
    cells.about(mine.centre, table.first_edge, table.ball_of_edge, [&](int f) {
      if (f <= e || !table.ball_of_edge(f).is_near(mine.centre, reach + mine.radius)) return;
      const int c = table.edge(f, 0), d = table.edge(f, 1);
      if (c == a || c == b || d == a || d == b) return;
      table.ends(f, table.start_x, other);
      if (boxes_apart(own, other, reach) || nearest_of_segments(own, other).squared > squared) return;
      if (count < most_near)
        table.near_edge(e, count) = f;
      else
        table.raise(table.steps() + 1, FailureReason::too_dense, a);
      ++count;
    });
    table.near_edges(e) = count < most_near ? count : most_near;
  }
};

}  // namespace drogue::fabric
