#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "kernels/spatial/hash_grid.hpp"

// Candidates of the hash grid against all pairs.

namespace drogue::spatial {
namespace {

using Space = DROGUE_TEST_SPACE;
using Spheres = Kokkos::View<BoundingSphere*, Space::memory_space>;
using Heads = Kokkos::View<int*, Space::memory_space>;
using Visits = Kokkos::View<int**, Kokkos::LayoutLeft, Space::memory_space>;

struct InsertFunctor {
  HashGrid grid;
  Heads heads;
  Spheres spheres;

  KOKKOS_FUNCTION void operator()(const int k) const { grid.insert(k, spheres(k), heads, spheres); }
};

/// Counts how often each primitive is a candidate of each other one.
struct VisitFunctor {
  HashGrid grid;
  Heads heads;
  Spheres spheres;
  Visits visits;

  KOKKOS_FUNCTION void operator()(const int i) const {
    grid.for_each_candidate(spheres(i).centre, heads, spheres, [&](int k) { ++visits(i, k); });
  }
};

/// Entry (i, k): how often point k is a candidate of point i.
Visits::host_mirror_type candidates(const std::vector<Point>& points, double width, std::size_t buckets) {
  const int n = static_cast<int>(points.size());
  const Spheres spheres("spheres", points.size());
  const auto mirror = Kokkos::create_mirror_view(spheres);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point single[1] = {points[i]};
    mirror(i) = bounding_sphere(single);
  }
  Kokkos::deep_copy(spheres, mirror);
  const Heads heads("heads", buckets);
  Kokkos::deep_copy(heads, -1);
  const HashGrid grid{width};
  const Visits visits("visits", points.size(), points.size());
  Kokkos::parallel_for("insert", Kokkos::RangePolicy<Space>(0, n), InsertFunctor{grid, heads, spheres});
  Kokkos::parallel_for("visit", Kokkos::RangePolicy<Space>(0, n), VisitFunctor{grid, heads, spheres, visits});
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, visits);
}

/// Coordinates of the cell of a point.
std::array<double, 3> cell(const Point& p, double width) {
  return {std::floor(p.x / width), std::floor(p.y / width), std::floor(p.z / width)};
}

/// Candidates are the points in the own and neighbouring cells, each once, for any number of buckets.
void expect_neighbours(const std::vector<Point>& points, double width) {
  for (const std::size_t buckets : {1U, 8U, 4096U}) {
    const auto visits = candidates(points, width, buckets);
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t k = 0; k < points.size(); ++k) {
        const auto a = cell(points[i], width), b = cell(points[k], width);
        bool neighbour = true;
        for (std::size_t axis = 0; axis < 3; ++axis) neighbour &= std::abs(a[axis] - b[axis]) <= 1.0;
        ASSERT_EQ(visits(i, k), neighbour ? 1 : 0) << i << ' ' << k << ' ' << buckets;
        const Point r = points[i] - points[k];
        if (std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)}) <= width) {
          ASSERT_TRUE(neighbour);
        }
      }
  }
}

std::vector<Point> random_points(std::size_t n, double size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<Point> points(n);
  for (Point& p : points)
    for (double* value : {&p.x, &p.y, &p.z}) *value = uniform(engine);
  return points;
}

// ctest-label: smoke
TEST(HashGrid, CandidatesAreThePointsOfNeighbouringCells) {
  for (const double width : {0.05, 0.2, 10.0}) expect_neighbours(random_points(200, 1.0, 1), width);
}

TEST(HashGrid, PointsOnFacesAndCornersOfCellsAreFound) {
  std::vector<Point> points;
  for (int n = 0; n < 125; ++n)
    points.push_back({0.25 * (n % 5 - 2), 0.25 * (n / 5 % 5 - 2), 0.25 * (n / 25 - 2)});
  expect_neighbours(points, 0.25);
  expect_neighbours(points, 0.5);
}

TEST(HashGrid, CoincidentPointsAreAllCandidates) {
  expect_neighbours(std::vector<Point>(150, Point{0.3, -0.7, 0.1}), 0.5);
}

TEST(HashGrid, NegativeZeroAndTinyCoordinatesLieInNeighbouringCells) {
  expect_neighbours(
      {{0.0, 0.0, 0.0}, {-0.0, -0.0, -0.0}, {-1e-300, 1e-300, 0.0}, {-1e-300, -1e-300, -1e-300}}, 1.0);
}

TEST(HashGrid, FarPointsAreFoundAmongTheirNeighbours) {
  // Beyond 2^20 cells the keys wrap, which may only add candidates.
  for (const double offset : {1e6, -1e9, 1e12}) {
    std::vector<Point> points = random_points(60, 2.0, 2);
    const std::size_t near = points.size();
    for (std::size_t i = 0; i < near; ++i) points.push_back(points[i] + Point{offset, -offset, 2.0 * offset});
    const auto visits = candidates(points, 1.0, 64);
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t k = 0; k < points.size(); ++k) {
        const Point r = points[i] - points[k];
        if (std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)}) <= 1.0) {
          EXPECT_EQ(visits(i, k), 1) << i << ' ' << k;
        }
      }
  }
}

TEST(HashGrid, KeysWrapAfterTwentyOneBits) {
  constexpr std::int64_t period = std::int64_t{1} << 21U;
  EXPECT_EQ(HashGrid::key(3, -4, 5), HashGrid::key(3 + period, -4 - period, 5 + 7 * period));
  EXPECT_NE(HashGrid::key(3, -4, 5), HashGrid::key(3, -4, 6));
  EXPECT_NE(HashGrid::key(1, 0, 0), HashGrid::key(0, 1, 0));
  EXPECT_NE(HashGrid::key(-1, 0, 0), HashGrid::key(1, 0, 0));
}

TEST(HashGrid, BucketsAreInRange) {
  for (std::size_t buckets = 1; buckets <= 1U << 20U; buckets *= 32)
    for (std::int64_t x = -50; x < 50; ++x) {
      const int bucket = HashGrid::bucket(HashGrid::key(x, 3 * x, -x), buckets);
      EXPECT_GE(bucket, 0);
      EXPECT_LT(bucket, static_cast<int>(buckets));
    }
}

}  // namespace
}  // namespace drogue::spatial
