#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "kernels/spatial/bounding_sphere.hpp"
#include "kernels/spatial/closest_points.hpp"

// Closest points against a search over samples and against optimality conditions, on random and degenerate
// triangles and segments.

namespace drogue::spatial {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : _engine(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * std::generate_canonical<double, 53>(_engine);
  }
  Point point(double size) {
    Point p;
    for (double* value : {&p.x, &p.y, &p.z}) *value = (*this)(-size, size);
    return p;
  }

 private:
  std::mt19937 _engine;
};

Point on_segment(const Point (&s)[2], double u) { return s[0] + u * (s[1] - s[0]); }

Point on_triangle(const Point (&t)[3], const double (&w)[3]) {
  return w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
}

double squared_distance(const Point& a, const Point& b) { return dot(a - b, a - b); }

/// Least squared distance of p to a triangle over a lattice of barycentric coordinates, m^2.
double sampled_distance(const Point& p, const Point (&t)[3]) {
  constexpr int n = 60;
  double best = 1e300;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n - i; ++j) {
      const double w[3] = {double(i) / n, double(j) / n, double(n - i - j) / n};
      best = std::min(best, squared_distance(p, on_triangle(t, w)));
    }
  return best;
}

/// Least squared distance of two segments over a lattice of parameters, m^2.
double sampled_distance(const Point (&p)[2], const Point (&q)[2]) {
  constexpr int n = 100;
  double best = 1e300;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      best = std::min(best, squared_distance(on_segment(p, double(i) / n), on_segment(q, double(j) / n)));
  return best;
}

/// The distance of the result is that of its points, and no sample comes nearer than round-off of `size`.
void expect_closest(const Point& p, const Point (&t)[3], double size = 1.0) {
  const ClosestOnTriangle closest = closest_on_triangle(p, t);
  double sum = 0.0;
  for (const double weight : closest.weight) {
    EXPECT_GE(weight, 0.0);
    sum += weight;
  }
  EXPECT_NEAR(sum, 1.0, 1e-14);
  const double tolerance = 1e-13 * size * size;
  EXPECT_NEAR(closest.squared, squared_distance(p, on_triangle(t, closest.weight)), tolerance);
  const double sampled = sampled_distance(p, t);
  EXPECT_LE(closest.squared, sampled + tolerance);
  // A lattice of 60 intervals comes within a thirtieth of the longest edge.
  double longest = 0.0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, length(t[(k + 1) % 3] - t[k]));
  EXPECT_GE(std::sqrt(closest.squared), std::sqrt(sampled) - longest / 30.0 - 1e-7 * size);
}

void expect_closest(const Point (&p)[2], const Point (&q)[2], double size = 1.0) {
  const ClosestOfSegments closest = closest_of_segments(p, q);
  for (const double u : {closest.first, closest.second}) {
    EXPECT_GE(u, 0.0);
    EXPECT_LE(u, 1.0);
  }
  const double tolerance = 1e-13 * size * size;
  EXPECT_NEAR(closest.squared, squared_distance(on_segment(p, closest.first), on_segment(q, closest.second)),
              tolerance);
  const double sampled = sampled_distance(p, q);
  EXPECT_LE(closest.squared, sampled + tolerance);
  EXPECT_GE(std::sqrt(closest.squared),
            std::sqrt(sampled) - (length(p[1] - p[0]) + length(q[1] - q[0])) / 100.0 - 1e-7 * size);
}

TEST(ClosestPoints, OnSegmentIsTheProjectionOrAnEnd) {
  const Point a{0.0, 0.0, 0.0}, b{2.0, 0.0, 0.0};
  EXPECT_EQ(closest_on_segment({0.5, 3.0, -1.0}, a, b), 0.25);
  EXPECT_EQ(closest_on_segment({-1.0, 1.0, 0.0}, a, b), 0.0);
  EXPECT_EQ(closest_on_segment({9.0, 1.0, 0.0}, a, b), 1.0);
  EXPECT_EQ(closest_on_segment({2.0, 1.0, 0.0}, a, b), 1.0);
  EXPECT_EQ(closest_on_segment({9.0, 1.0, 0.0}, a, a), 0.0) << "a segment of no length";
}

TEST(ClosestPoints, OnTriangleBeatsAllSamples) {
  Random random(1);
  for (int trial = 0; trial < 300; ++trial) {
    const Point t[3] = {random.point(1.0), random.point(1.0), random.point(1.0)};
    expect_closest(random.point(trial % 2 == 0 ? 0.5 : 3.0), t);
  }
}

TEST(ClosestPoints, OnTriangleIsInsideExactlyForProjectionsIntoTheFace) {
  Random random(2);
  for (int trial = 0; trial < 300; ++trial) {
    const Point t[3] = {random.point(1.0), random.point(1.0), random.point(1.0)};
    double w[3] = {random(0.02, 1.0), random(0.02, 1.0), random(0.02, 1.0)};
    const double sum = w[0] + w[1] + w[2];
    for (double& weight : w) weight /= sum;
    const Point normal = cross(t[1] - t[0], t[2] - t[0]);
    const Point foot = on_triangle(t, w), above = foot + random(-2.0, 2.0) * normal;
    const ClosestOnTriangle closest = closest_on_triangle(above, t);
    EXPECT_TRUE(closest.inside);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(closest.weight[k], w[k], 1e-9);
    // Beyond the edge opposite vertex 0 the closest point lies on the boundary.
    w[0] = -0.1, w[1] = 0.6, w[2] = 0.5;
    EXPECT_FALSE(closest_on_triangle(on_triangle(t, w), t).inside);
  }
}

TEST(ClosestPoints, OnTriangleIsExactAtVerticesEdgesAndPointsOfTheFace) {
  const Point t[3] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  for (const Point& vertex : t) EXPECT_EQ(closest_on_triangle(vertex, t).squared, 0.0);
  EXPECT_EQ(closest_on_triangle({0.5, 0.5, 0.0}, t).squared, 0.0);
  EXPECT_FALSE(closest_on_triangle({0.5, 0.0, 2.0}, t).inside) << "above an edge";
  EXPECT_EQ(closest_on_triangle({0.5, 0.0, 2.0}, t).squared, 4.0);
  EXPECT_EQ(closest_on_triangle({0.25, 0.25, -3.0}, t).squared, 9.0);
}

TEST(ClosestPoints, DegenerateTrianglesCostNoAccuracy) {
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const Point a = random.point(1.0), b = random.point(1.0), p = random.point(2.0);
    const Point collinear[3] = {a, b, a + random(-1.0, 2.0) * (b - a)}, doubled[3] = {a, b, a},
                single[3] = {a, a, a}, needle[3] = {a, b, a + 1e-13 * random.point(1.0)};
    expect_closest(p, collinear);
    expect_closest(p, doubled);
    expect_closest(p, single);
    expect_closest(p, needle);
    EXPECT_NEAR(closest_on_triangle(p, single).squared, squared_distance(p, a), 1e-14);
  }
}

TEST(ClosestPoints, LargeCoordinatesCostOnlyTheirOwnRoundOff) {
  Random random(4);
  for (const double size : {1e-6, 1e6}) {
    for (int trial = 0; trial < 50; ++trial) {
      const Point t[3] = {random.point(size), random.point(size), random.point(size)};
      expect_closest(random.point(size), t, size);
      const Point p[2] = {random.point(size), random.point(size)},
                  q[2] = {random.point(size), random.point(size)};
      expect_closest(p, q, size);
    }
  }
  // A unit triangle far away: differences of coordinates keep an absolute error of 1e-10.
  const Point far{1e6, -1e6, 1e6};
  const Point t[3] = {far, far + Point{1.0, 0.0, 0.0}, far + Point{0.0, 1.0, 0.0}};
  EXPECT_NEAR(closest_on_triangle(far + Point{0.25, 0.25, 2.0}, t).squared, 4.0, 1e-9);
}

TEST(ClosestPoints, AreCloserThanAllSamplesOfSegments) {
  Random random(5);
  for (int trial = 0; trial < 300; ++trial) {
    const Point p[2] = {random.point(1.0), random.point(1.0)}, q[2] = {random.point(1.0), random.point(1.0)};
    expect_closest(p, q);
  }
}

TEST(ClosestPoints, LieOnTheCommonPerpendicularOfSegments) {
  Random random(6);
  int inside = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Point p[2] = {random.point(1.0), random.point(1.0)}, q[2] = {random.point(1.0), random.point(1.0)};
    const ClosestOfSegments closest = closest_of_segments(p, q);
    if (!closest.inside) continue;
    ++inside;
    const Point between = on_segment(p, closest.first) - on_segment(q, closest.second);
    EXPECT_NEAR(dot(between, p[1] - p[0]), 0.0, 1e-10);
    EXPECT_NEAR(dot(between, q[1] - q[0]), 0.0, 1e-10);
  }
  EXPECT_GT(inside, 50);
}

TEST(ClosestPoints, HandleParallelDegenerateAndCoincidentSegments) {
  Random random(7);
  for (int trial = 0; trial < 100; ++trial) {
    const Point a = random.point(1.0), d = random.point(1.0);
    const Point p[2] = {a, a + d}, parallel[2] = {random.point(1.0), {}}, single[2] = {a, a};
    const Point q[2] = {parallel[0], parallel[0] + random(-2.0, 2.0) * d};
    expect_closest(p, q);
    expect_closest(p, p);
    expect_closest(p, single);
    expect_closest(single, q);
    expect_closest(single, single);
    const Point nearly[2] = {q[0], q[1] + 1e-9 * random.point(1.0)};
    expect_closest(p, nearly);
  }
  const Point x[2] = {{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, y[2] = {{0.0, -1.0, 0.5}, {0.0, 1.0, 0.5}};
  const ClosestOfSegments crossing = closest_of_segments(x, y);
  EXPECT_TRUE(crossing.inside);
  EXPECT_EQ(crossing.squared, 0.25);
}

TEST(ClosestPoints, BoxesAreApartIfTheirGapExceedsTheMargin) {
  const Point a[2] = {{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}};
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      Point shift{0.0, 0.0, 0.0};
      (axis == 0 ? shift.x : axis == 1 ? shift.y : shift.z) = side * 1.5;
      const Point b[2] = {a[0] + shift, a[1] + shift};
      EXPECT_TRUE(boxes_apart(a, b, 0.25));
      EXPECT_FALSE(boxes_apart(a, b, 0.5)) << "a gap of the margin is not apart";
      EXPECT_FALSE(boxes_apart(a, b, 1.0));
    }
}

TEST(BoundingSphere, ContainsItsPointsAndIsAboutTheirCentroid) {
  Random random(8);
  for (const double size : {1e-9, 1.0, 1e9}) {
    for (int trial = 0; trial < 200; ++trial) {
      const Point points[3] = {random.point(size), random.point(size), random.point(size)};
      const BoundingSphere sphere = bounding_sphere(points);
      EXPECT_NEAR(length(sphere.centre - (1.0 / 3.0) * (points[0] + points[1] + points[2])), 0.0,
                  1e-15 * size);
      double largest = 0.0;
      for (const Point& p : points) {
        EXPECT_TRUE(sphere.is_near(p, 0.0));
        largest = std::max(largest, length(p - sphere.centre));
      }
      EXPECT_NEAR(sphere.radius, largest, 1e-11 * size);
    }
  }
}

TEST(BoundingSphere, IsNearWithinTheDistance) {
  const Point points[2] = {{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  const BoundingSphere sphere = bounding_sphere(points);
  EXPECT_TRUE(sphere.is_near({0.0, 1.5, 0.0}, 0.5));
  EXPECT_FALSE(sphere.is_near({0.0, 1.5, 0.0}, 0.49));
  const Point single[1] = {{3.0, 4.0, 5.0}};
  EXPECT_EQ(bounding_sphere(single).radius, 0.0);
}

}  // namespace
}  // namespace drogue::spatial
