#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "kernels/reference/fabric/bodies.hpp"
#include "kernels/reference/fabric/intersections.hpp"

// Reference functions of contact against cases with known results.

namespace drogue::reference {
namespace {

using Place = std::array<double, 3>;

const std::array<Place, 3> half_square = {Place{0, 0, 0}, Place{1, 0, 0}, Place{0, 1, 0}};

TEST(ReferenceIntersections, OrientationIsExactWhereTheDeterminantRounds) {
  EXPECT_EQ(side_of_plane(half_square[0], half_square[1], half_square[2], {0.2, 0.2, 1.0}),
            -side_of_plane(half_square[0], half_square[1], half_square[2], {0.2, 0.2, -1.0}));
  // Points of the plane x + y + z = 1 with exactly representable coordinates, then one moved by 1 ulp.
  const Place a = {0.5, 0.25, 0.25}, b = {-0.125, 1.0, 0.125}, c = {3.0, -2.5, 0.5}, d = {0.75, 0.125, 0.125};
  EXPECT_EQ(side_of_plane(a, b, c, d), 0);
  const int above = side_of_plane(a, b, c, {0.75, 0.125, std::nextafter(0.125, 1.0)});
  EXPECT_NE(above, 0);
  EXPECT_EQ(side_of_plane(a, b, c, {0.75, 0.125, std::nextafter(0.125, 0.0)}), -above);
}

TEST(ReferenceIntersections, FindSegmentsThatCrossTriangles) {
  const auto pierced = [](const Place& p, const Place& q) { return meet({p, q}, half_square); };
  EXPECT_TRUE(pierced({0.2, 0.2, -1}, {0.3, 0.3, 1}));
  EXPECT_FALSE(pierced({0.2, 0.2, 1e-300}, {0.3, 0.3, 1}));
  EXPECT_TRUE(pierced({0.2, 0.2, 0}, {0.3, 0.3, 1})) << "touching counts";
  EXPECT_FALSE(pierced({0.8, 0.8, -1}, {0.8, 0.8, 1}));
  EXPECT_TRUE(pierced({0.5, 0.5, -1}, {0.5, 0.5, 1})) << "through an edge";
  // In its plane.
  EXPECT_TRUE(pierced({-1, 0.2, 0}, {2, 0.2, 0}));
  EXPECT_TRUE(pierced({0.1, 0.1, 0}, {0.2, 0.1, 0}));
  EXPECT_FALSE(pierced({0.6, 0.6, 0}, {2, 2, 0}));
  EXPECT_FALSE(pierced({2, 0, 0}, {3, 0, 0}));
  EXPECT_TRUE(pierced({1, 0, 0}, {3, 0, 0}));
}

TEST(ReferenceIntersections, ExcludeTrianglesThatShareAVertex) {
  std::vector<Place> x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.0}, {0.3, 0.3, -1}, {0.3, 0.3, 1}};
  const std::vector<std::array<int, 3>> triangles = {{0, 1, 2}, {1, 3, 2}};
  EXPECT_TRUE(intersections(x, triangles, {}).empty());
  const std::vector<std::array<int, 2>> line = {{4, 5}};
  const auto found = intersections(x, triangles, line);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].triangle, 0U);
  EXPECT_EQ(found[0].segment, (std::array<int, 2>{4, 5}));
  // For two triangles with a common vertex only the edges without that vertex count.
  x[3] = {0.5, 0.2, -0.5}, x[4] = {0.2, 0.5, 0.5};
  EXPECT_EQ(intersections(x, std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 3, 4}}, {}).size(), 1U);
}

/// True if the bounding boxes of two sets of corners overlap.
bool boxes_overlap(const std::vector<Place>& a, const std::vector<Place>& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto of = [axis](const Place& p) { return p[axis]; };
    if (of(std::ranges::min(a, {}, of)) > of(std::ranges::max(b, {}, of)) ||
        of(std::ranges::min(b, {}, of)) > of(std::ranges::max(a, {}, of)))
      return false;
  }
  return true;
}

TEST(ReferenceIntersections, EqualTheIntersectionsOfAllPairs) {
  // Triangles and lines of all sizes: in space, in a plane, and with integer coordinates, where they touch.
  std::mt19937 engine(7);
  const auto random = [&] { return std::generate_canonical<double, 53>(engine); };
  std::size_t met = 0;
  for (int draw = 0; draw < 20; ++draw) {
    const bool whole = draw % 2 == 1;
    const std::size_t axes = draw % 3 == 0 ? 2 : 3;
    std::vector<Place> x;
    const auto part = [&](int corners) {
      Place centre{};
      const double size = whole ? 4.0 : std::pow(10.0, 0.5 - 2.0 * random());
      for (std::size_t axis = 0; axis < axes; ++axis) centre[axis] = 6.0 * random();
      for (int k = 0; k < corners; ++k) {
        x.push_back(centre);
        for (std::size_t axis = 0; axis < axes; ++axis) {
          double& place = x.back()[axis];
          place += size * random();
          if (whole) place = std::round(place);
        }
      }
      return static_cast<int>(x.size()) - corners;
    };
    const auto at = [&](int i) { return x[static_cast<std::size_t>(i)]; };
    std::vector<std::array<int, 3>> triangles;
    std::vector<std::array<int, 2>> lines, segments;
    while (triangles.size() < 25) {
      const int t = part(3), line = part(2);
      // Degenerate triangles are skipped.
      if (side_of_plane(at(t), at(t + 1), at(t + 2), {0.7, 0.3, 99.9}) == 0) continue;
      triangles.push_back({t, t + 1, t + 2}), lines.push_back({line, line + 1});
      segments.insert(segments.end(), {{line, line + 1}, {t, t + 1}, {t + 1, t + 2}, {t + 2, t}});
    }
    std::size_t all = 0;
    for (const auto& [i, j] : segments)
      for (const auto& [a, b, c] : triangles)
        if (i != a && i != b && i != c && boxes_overlap({at(i), at(j)}, {at(a), at(b), at(c)}) &&
            meet({at(i), at(j)}, {at(a), at(b), at(c)}))
          ++all;
    EXPECT_EQ(intersections(x, triangles, lines).size(), all) << draw;
    met += all;
  }
  EXPECT_GT(met, 1000U);
}

/// True if one of many points of a triangle lies in a body.
bool sampled(const fabric::Body& body, const std::array<Place, 3>& t) {
  constexpr int n = 60;
  double before = 0.0;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j) {
      Place p{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] = (i * t[0][axis] + j * t[1][axis] + (n - i - j) * t[2][axis]) / n;
      if (body.kind != fabric::BodyKind::disk && distance_from(body, p) < 0.0) return true;
      // A disk has no interior: the triangle crosses its plane within the disk.
      const double beside = std::hypot(p[0], p[1]);
      if (body.kind == fabric::BodyKind::disk && j > 0 && before * p[2] < 0.0 && beside < body.radius - 0.1)
        return true;
      before = p[2];
    }
  return false;
}

TEST(ReferenceBodies, TrianglesPenetrateBodiesWhereTheirPointsDo) {
  std::mt19937 engine(4);
  const auto random = [&] { return 4.0 * std::generate_canonical<double, 53>(engine) - 2.0; };
  for (const auto kind : {fabric::BodyKind::sphere, fabric::BodyKind::disk, fabric::BodyKind::plane}) {
    fabric::Body body;
    body.kind = kind, body.radius = 0.7;
    int entered = 0, missed = 0;
    for (int k = 0; k < 300; ++k) {
      std::array<Place, 3> t;
      for (Place& p : t) p = {random(), random(), random()};
      const bool in = enters(body, t);
      EXPECT_TRUE(in || !sampled(body, t));
      ++(in ? entered : missed);
      // Fewer triangles penetrate smaller bodies.
      fabric::Body smaller = body;
      smaller.radius = 0.35;
      EXPECT_TRUE(in || !enters(smaller, t));
      const std::array<Place, 2> side = {t[0], t[1]};
      EXPECT_EQ(enters(body, side), enters(body, std::array{t[0], t[1], t[1]}));
      EXPECT_TRUE(in || !enters(body, side));
      EXPECT_TRUE(enters(body, side) || !sampled(body, {t[0], t[1], t[1]}));
    }
    EXPECT_GT(entered, 20);
    EXPECT_GT(missed, 20);
  }
  fabric::Body disk;
  disk.kind = fabric::BodyKind::disk, disk.radius = 1.0;
  EXPECT_DOUBLE_EQ(distance_from(disk, {4.0, 0.0, 4.0}), 5.0);
  EXPECT_DOUBLE_EQ(distance_from(disk, {0.5, 0.5, -3.0}), 3.0);
}

}  // namespace
}  // namespace drogue::reference
