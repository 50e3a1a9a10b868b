#include "kernels/reference/fabric/intersections.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace drogue::reference {

namespace {

using Exact = boost::multiprecision::cpp_rational;
using Place = std::array<double, 3>;

int sign(const Exact& value) { return value.sign(); }

/// The determinant of three rows of three numbers.
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

/// Which way a, b, c turn in the plane of two axes.
int turn(const Place& a, const Place& b, const Place& c, std::size_t u, std::size_t v) {
  using Long = long double;
  const Long bu = Long(b[u]) - a[u], bv = Long(b[v]) - a[v], cu = Long(c[u]) - a[u], cv = Long(c[v]) - a[v];
  const Long value = bu * cv - bv * cu, size = std::abs(bu * cv) + std::abs(bv * cu);
  if (std::abs(value) > 8.0L * std::numeric_limits<Long>::epsilon() * size) return value > 0 ? 1 : -1;
  return sign((Exact(b[u]) - Exact(a[u])) * (Exact(c[v]) - Exact(a[v])) -
              (Exact(b[v]) - Exact(a[v])) * (Exact(c[u]) - Exact(a[u])));
}

/// Segments of a plane.
bool segments_meet(const Place& p, const Place& q, const Place& a, const Place& b, std::size_t u,
                   std::size_t v) {
  const int p_side = turn(a, b, p, u, v), q_side = turn(a, b, q, u, v);
  const int a_side = turn(p, q, a, u, v), b_side = turn(p, q, b, u, v);
  if (p_side * q_side > 0 || a_side * b_side > 0) return false;
  if (p_side != 0 || q_side != 0 || a_side != 0 || b_side != 0) return true;
  // Of one line: their boxes tell.
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
    if (whole == 0) continue;  // seen edgewise
    const auto within = [&](std::size_t k) { return turn(t[k], t[(k + 1) % 3], s[0], u, v) * whole >= 0; };
    if (within(0) && within(1) && within(2)) return true;
    for (std::size_t k = 0; k < 3; ++k)
      if (segments_meet(s[0], s[1], t[k], t[(k + 1) % 3], u, v)) return true;
    return false;
  }
  return true;  // a triangle without area: it says nothing else than that something is wrong
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

bool overlap(const Box& a, const Box& b) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (a.low[axis] > b.high[axis] || b.low[axis] > a.high[axis]) return false;
  return true;
}

}  // namespace

int side_of_plane(const Place& a, const Place& b, const Place& c, const Place& d) {
  const auto rows = rows_from<long double>(d, a, b, c);
  long double size = 1.0L;
  for (const auto& row : rows) size *= std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]);
  const long double value = determinant(rows);
  // Products of three differences, each rounded once, and five more operations: below 16 units of the size.
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
  std::set<std::array<int, 2>> segments(lines.begin(), lines.end());
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      segments.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::vector<Box> boxes;
  for (const auto& t : triangles) boxes.push_back(box_of(positions, t));
  std::vector<std::size_t> by_low(triangles.size());
  std::iota(by_low.begin(), by_low.end(), std::size_t{0});
  std::ranges::sort(by_low, {}, [&](std::size_t t) { return boxes[t].low[0]; });
  double widest = 0.0;
  for (const Box& box : boxes) widest = std::max(widest, box.high[0] - box.low[0]);
  std::vector<Intersection> found;
  const auto place = [&](int i) { return positions[static_cast<std::size_t>(i)]; };
  for (const auto& segment : segments) {
    const Box box = box_of(positions, segment);
    auto next = std::ranges::lower_bound(by_low, box.low[0] - widest, {},
                                         [&](std::size_t t) { return boxes[t].low[0]; });
    for (; next != by_low.end() && boxes[*next].low[0] <= box.high[0]; ++next) {
      const auto& t = triangles[*next];
      const bool shares = std::ranges::any_of(t, [&](int i) { return i == segment[0] || i == segment[1]; });
      if (shares || !overlap(box, boxes[*next])) continue;
      if (meet({place(segment[0]), place(segment[1])}, {place(t[0]), place(t[1]), place(t[2])}))
        found.push_back({segment, *next});
    }
  }
  return found;
}

}  // namespace drogue::reference
