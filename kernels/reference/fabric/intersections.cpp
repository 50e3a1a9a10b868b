#include "kernels/reference/fabric/intersections.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace drogue::reference {

namespace {

using Exact = boost::multiprecision::cpp_rational;
using Place = std::array<double, 3>;

int sign(const Exact& value) { return value.sign(); }

/// Determinant of a 3 x 3 matrix.
template <class Number>
Number determinant(const std::array<std::array<Number, 3>, 3>& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

template <class Number>
std::array<std::array<Number, 3>, 3> rows_from(const Place& d, const Place& a, const Place& b,
                                               const Place& c) {
  std::array<std::array<Number, 3>, 3> rows;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    rows[0][axis] = Number(a[axis]) - Number(d[axis]);
    rows[1][axis] = Number(b[axis]) - Number(d[axis]);
    rows[2][axis] = Number(c[axis]) - Number(d[axis]);
  }
  return rows;
}

/// Orientation of a, b, c in the coordinate plane (u, v): 1 if counterclockwise, -1 if clockwise, else 0.
int turn(const Place& a, const Place& b, const Place& c, std::size_t u, std::size_t v) {
  using Long = long double;
  const Long bu = Long(b[u]) - a[u], bv = Long(b[v]) - a[v], cu = Long(c[u]) - a[u], cv = Long(c[v]) - a[v];
  const Long value = bu * cv - bv * cu, size = std::abs(bu * cv) + std::abs(bv * cu);
  if (std::abs(value) > 8.0L * std::numeric_limits<Long>::epsilon() * size) return value > 0 ? 1 : -1;
  return sign((Exact(b[u]) - Exact(a[u])) * (Exact(c[v]) - Exact(a[v])) -
              (Exact(b[v]) - Exact(a[v])) * (Exact(c[u]) - Exact(a[u])));
}

/// Returns whether the segments (p, q) and (a, b) intersect in the coordinate plane (u, v).
bool segments_meet(const Place& p, const Place& q, const Place& a, const Place& b, std::size_t u,
                   std::size_t v) {
  const int p_side = turn(a, b, p, u, v), q_side = turn(a, b, q, u, v);
  const int a_side = turn(p, q, a, u, v), b_side = turn(p, q, b, u, v);
  if (p_side * q_side > 0 || a_side * b_side > 0) return false;
  if (p_side != 0 || q_side != 0 || a_side != 0 || b_side != 0) return true;
  // Collinear segments intersect if their boxes overlap.
  const auto overlap = [&](std::size_t axis) {
    return std::max(std::min(p[axis], q[axis]), std::min(a[axis], b[axis])) <=
           std::min(std::max(p[axis], q[axis]), std::max(a[axis], b[axis]));
  };
  return overlap(u) && overlap(v);
}

bool meet_in_plane(const std::array<Place, 2>& s, const std::array<Place, 3>& t) {
  for (std::size_t drop = 0; drop < 3; ++drop) {
    const std::size_t u = (drop + 1) % 3, v = (drop + 2) % 3;
    const int whole = turn(t[0], t[1], t[2], u, v);
    if (whole == 0) continue;  // the projection has no area
    const auto within = [&](std::size_t k) { return turn(t[k], t[(k + 1) % 3], s[0], u, v) * whole >= 0; };
    if (within(0) && within(1) && within(2)) return true;
    for (std::size_t k = 0; k < 3; ++k)
      if (segments_meet(s[0], s[1], t[k], t[(k + 1) % 3], u, v)) return true;
    return false;
  }
  return true;  // a degenerate triangle in a coplanar pair counts as intersected
}

struct Box {
  Place low, high;
};

template <class Vertices>
Box box_of(std::span<const Place> positions, const Vertices& vertices) {
  Box box{positions[static_cast<std::size_t>(vertices[0])], positions[static_cast<std::size_t>(vertices[0])]};
  for (const int i : vertices)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = positions[static_cast<std::size_t>(i)][axis];
      box.low[axis] = std::min(box.low[axis], x), box.high[axis] = std::max(box.high[axis], x);
    }
  return box;
}

/// Returns whether the projections of two point sets on the direction `along` are disjoint by more than the
/// bound of their rounding errors.
template <std::size_t m, std::size_t n>
bool has_disjoint_projections(const std::array<long double, 3>& along, const std::array<Place, m>& p,
                              const std::array<Place, n>& q) {
  long double size = 0.0L;
  const auto height = [&](const Place& x) {
    long double sum = 0.0L;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const long double part = along[axis] * (static_cast<long double>(x[axis]) - q[0][axis]);
      sum += part, size = std::max(size, std::abs(part));
    }
    return sum;
  };
  long double p_low = height(p[0]), p_high = p_low, q_low = 0.0L, q_high = 0.0L;
  for (const Place& x : p) p_low = std::min(p_low, height(x)), p_high = std::max(p_high, height(x));
  for (const Place& x : q) q_low = std::min(q_low, height(x)), q_high = std::max(q_high, height(x));
  return std::max(p_low - q_high, q_low - p_high) >
         64.0L * std::numeric_limits<long double>::epsilon() * size;
}

/// Separating-axis test of a segment and a triangle: true only if they are disjoint. Tests the normal of the
/// triangle, and cross products of it, of the sides and of the segment. Avoids rational arithmetic for most
/// pairs of a flat sheet.
bool has_separating_axis(const std::array<Place, 2>& segment, const std::array<Place, 3>& triangle) {
  using Long = std::array<long double, 3>;
  const auto edge_vector = [](const Place& from, const Place& to) {
    return Long{static_cast<long double>(to[0]) - from[0], static_cast<long double>(to[1]) - from[1],
                static_cast<long double>(to[2]) - from[2]};
  };
  const auto cross = [](const Long& a, const Long& b) {
    return Long{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Long normal = cross(edge_vector(triangle[0], triangle[1]), edge_vector(triangle[0], triangle[2]));
  if (has_disjoint_projections(normal, segment, triangle)) return true;
  const Long along = edge_vector(segment[0], segment[1]);
  if (has_disjoint_projections(cross(normal, along), segment, triangle)) return true;
  for (std::size_t k = 0; k < 3; ++k) {
    const Long side = edge_vector(triangle[k], triangle[(k + 1) % 3]);
    if (has_disjoint_projections(cross(normal, side), segment, triangle) ||
        has_disjoint_projections(cross(along, side), segment, triangle))
      return true;
  }
  return false;
}

bool overlap(const Box& a, const Box& b) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (a.low[axis] > b.high[axis] || b.low[axis] > a.high[axis]) return false;
  return true;
}

/// Uniform grid of boxes, sorted by the cells of their lower corners. A cell is wider than the widest box by
/// more than round-off. Boxes that overlap a given box thus start in one of its cells or in the next lower
/// ones.
class BoxGrid {
 public:
  /// `widest_query`: largest width of the boxes given to `each_near`, m. They span at most 129 cells of an
  /// axis, also where a few long lines cross a fine mesh.
  BoxGrid(std::span<const Box> boxes, double widest_query) : _width(widest_query / 128.0) {
    if (boxes.empty()) return;
    _low = boxes[0].low;
    Place high = _low;
    for (const Box& box : boxes)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        _low[axis] = std::min(_low[axis], box.low[axis]), high[axis] = std::max(high[axis], box.low[axis]);
        _width = std::max(_width, box.high[axis] - box.low[axis]);
      }
    for (std::size_t axis = 0; axis < 3; ++axis) _width = std::max(_width, (high[axis] - _low[axis]) / most);
    _width *= 1.0 + 1e-6;
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      const auto at = [&](std::size_t axis) { return cell(axis, boxes[k].low[axis]); };
      _places.push_back({key(at(0), at(1), at(2)), k});
    }
    std::ranges::sort(_places);
  }

  /// Calls `take(number)` for every box that overlaps `box`, and possibly for others.
  template <class Take>
  void each_near(const Box& box, const Take& take) const {
    const auto first = [&](std::size_t axis) {
      return std::max<std::int64_t>(1, cell(axis, box.low[axis])) - 1;
    };
    const auto last = [&](std::size_t axis) { return cell(axis, box.high[axis]); };
    for (std::int64_t x = first(0); x <= last(0); ++x)
      for (std::int64_t y = first(1); y <= last(1); ++y) {
        auto next = std::ranges::lower_bound(_places, std::pair{key(x, y, first(2)), std::size_t{0}});
        for (const std::uint64_t end = key(x, y, last(2)); next != _places.end() && next->first <= end;
             ++next)
          take(next->second);
      }
  }

 private:
  static constexpr double most = 1 << 20;  ///< cells along an axis; 21 bits of a key

  /// Cell of a coordinate. Monotone, since rounding is monotone.
  [[nodiscard]] std::int64_t cell(std::size_t axis, double x) const {
    const double from_low = (x - _low[axis]) / _width;
    return from_low > 0.0 ? static_cast<std::int64_t>(std::min(from_low, most)) : 0;
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>(x) << 42U | static_cast<std::uint64_t>(y) << 21U |
           static_cast<std::uint64_t>(z);
  }

  Place _low{};
  double _width;  ///< width of a cell, m
  std::vector<std::pair<std::uint64_t, std::size_t>> _places;
};

}  // namespace

int side_of_plane(const Place& a, const Place& b, const Place& c, const Place& d) {
  const auto rows = rows_from<long double>(d, a, b, c);
  long double size = 1.0L;
  for (const auto& row : rows) size *= std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]);
  const long double value = determinant(rows);
  // Products of three rounded differences and five further operations: error below 16 epsilon times `size`.
  if (std::abs(value) > 32.0L * std::numeric_limits<long double>::epsilon() * size) return value > 0 ? 1 : -1;
  return sign(determinant(rows_from<Exact>(d, a, b, c)));
}

bool meet(const std::array<Place, 2>& segment, const std::array<Place, 3>& triangle) {
  const auto& [p, q] = segment;
  const auto& [a, b, c] = triangle;
  const int p_side = side_of_plane(a, b, c, p), q_side = side_of_plane(a, b, c, q);
  if (p_side * q_side > 0) return false;
  if (p_side == 0 && q_side == 0) return meet_in_plane(segment, triangle);
  const int first = side_of_plane(p, q, a, b), second = side_of_plane(p, q, b, c),
            third = side_of_plane(p, q, c, a);
  const int least = std::min({first, second, third}), most = std::max({first, second, third});
  return !(least < 0 && most > 0);
}

std::vector<Intersection> intersections(std::span<const Place> positions,
                                        std::span<const std::array<int, 3>> triangles,
                                        std::span<const std::array<int, 2>> lines) {
  std::vector<std::array<int, 2>> segments(lines.begin(), lines.end());
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      segments.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::ranges::sort(segments);
  segments.erase(std::ranges::unique(segments).begin(), segments.end());
  std::vector<Box> boxes;
  for (const auto& t : triangles) boxes.push_back(box_of(positions, t));
  double widest = 0.0;
  for (const auto& line : lines) {
    const Box box = box_of(positions, line);
    for (std::size_t axis = 0; axis < 3; ++axis) widest = std::max(widest, box.high[axis] - box.low[axis]);
  }
  const BoxGrid grid(boxes, widest);
  std::vector<Intersection> found;
  const auto place = [&](int i) { return positions[static_cast<std::size_t>(i)]; };
  for (const auto& segment : segments) {
    const Box box = box_of(positions, segment);
    const std::array<Place, 2> ends = {place(segment[0]), place(segment[1])};
    grid.each_near(box, [&](std::size_t number) {
      const auto& t = triangles[number];
      const bool shares = std::ranges::any_of(t, [&](int i) { return i == segment[0] || i == segment[1]; });
      if (shares || !overlap(box, boxes[number])) return;
      const std::array<Place, 3> corners = {place(t[0]), place(t[1]), place(t[2])};
      if (!has_separating_axis(ends, corners) && meet(ends, corners)) found.push_back({segment, number});
    });
  }
  return found;
}

}  // namespace drogue::reference
