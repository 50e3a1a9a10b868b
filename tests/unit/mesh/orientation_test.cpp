#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kernels/mesh/orientation.hpp"
#include "kernels/mesh/polygon.hpp"
#include "kernels/mesh/quality.hpp"
#include "kernels/mesh/round_surfaces.hpp"
#include "kernels/mesh/topology.hpp"

// Sides of surfaces, their volumes, and the triangles of polygons.

namespace drogue::mesh {
namespace {

void reverse(Mesh& mesh, std::size_t triangle) {
  std::swap(mesh.triangles[triangle][1], mesh.triangles[triangle][2]);
}

/// Appends a mesh at a distance along x.
void append(Mesh& to, const Mesh& from, double distance) {
  const auto first = static_cast<int>(to.rest.size());
  for (Vector x : from.rest) {
    x[0] += distance;
    to.rest.push_back(x);
  }
  for (const auto& [a, b, c] : from.triangles) to.triangles.push_back({a + first, b + first, c + first});
}

double volume_of(const Mesh& mesh) { return enclosed_volume(mesh, orientation_of(mesh)); }

/// A band of n quadrilaterals that is joined after half a turn, or after none.
Mesh band(int n, bool twisted) {
  Mesh mesh;
  for (int k = 0; k < n; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / n, lean = twisted ? 0.5 * angle : 0.0;
    for (const double side : {-0.2, 0.2}) {
      const double radius = 1.0 + side * std::cos(lean);
      mesh.rest.push_back({radius * std::cos(angle), radius * std::sin(angle), side * std::sin(lean)});
    }
  }
  for (int k = 0; k < n; ++k) {
    const int a = 2 * k, b = a + 1, end = 2 * ((k + 1) % n);
    const bool crosses = twisted && k + 1 == n;
    const int c = crosses ? end + 1 : end, d = crosses ? end : end + 1;
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({b, c, d});
  }
  return mesh;
}

TEST(Orientation, VolumeIsBetweenMovedTrianglesAndAPoint) {
  // A tetrahedron of volume 1/6 at rest, twice as wide along x.
  const std::vector<std::array<int, 3>> all = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  const std::vector<Vector> x = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Vector& point : {Vector{0, 0, 0}, Vector{3, -4, 5}})
    EXPECT_NEAR(volume_between(all, x, point), 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(volume_between(std::span(all).subspan(2, 1), x, {0, 0, 0}), 1.0 / 3.0, 1e-15);
  EXPECT_EQ(volume_between(std::span(all).first(2), x, {0, 0, 0}), 0.0);
}

TEST(Orientation, TurnsTheFewerTrianglesOfEachPart) {
  const Mesh one = sphere(1.0, 3);
  Mesh mesh = one;
  append(mesh, one, 5.0);
  const std::size_t n = one.triangles.size();
  for (const std::size_t t : {std::size_t{4}, std::size_t{17}, n + 2}) reverse(mesh, t);
  const Orientation sides = orientation_of(mesh);
  ASSERT_EQ(sides.parts.size(), 2U);
  EXPECT_FALSE(sides.one_sided);
  EXPECT_EQ(sides.turns(), 3U);
  EXPECT_EQ(sides.turned[4] + sides.turned[17] + sides.turned[n + 2], 3);
  EXPECT_EQ(sides.parts[1].first, static_cast<int>(n));
  EXPECT_EQ(sides.parts[1].triangles, n);
  EXPECT_EQ(sides.parts[0].free_edges, 0U);
  EXPECT_GT(sides.parts[0].volume, 0.0);
  EXPECT_TRUE(inconsistent_triangles(mesh));
  turn(mesh, sides);
  EXPECT_FALSE(inconsistent_triangles(mesh));
  EXPECT_EQ(orientation_of(mesh).turns(), 0U);
}

TEST(Orientation, EverySecondTriangleReversedIsMended) {
  Mesh mesh = sphere(1.0, 4);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) reverse(mesh, t);
  turn(mesh, orientation_of(mesh));
  EXPECT_FALSE(inconsistent_triangles(mesh));
  EXPECT_NEAR(volume_of(mesh), volume_of(sphere(1.0, 4)), 1e-14);
}

TEST(Orientation, FindsTheOneSideOfAMoebiusStrip) {
  const Orientation flat = orientation_of(band(12, false)), twisted = orientation_of(band(12, true));
  EXPECT_FALSE(flat.one_sided);
  EXPECT_EQ(flat.parts.at(0).free_edges, 24U);
  ASSERT_TRUE(twisted.one_sided);
  EXPECT_EQ(twisted.parts.at(0).free_edges, 24U);
  EXPECT_NE(quality_report(band(12, true)).find("with one side"), std::string::npos);
}

TEST(Orientation, VolumesAreThoseOfClosedParts) {
  Mesh mesh = sphere(1.0, 8);
  const double whole = volume_of(mesh);
  EXPECT_NEAR(whole, 4.0 / 3.0 * std::numbers::pi, 0.05);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) reverse(mesh, t);  // inside out
  EXPECT_LT(orientation_of(mesh).parts.at(0).volume, 0.0);
  EXPECT_NE(quality_report(mesh).find("normals of 1 closed inwards"), std::string::npos);
  EXPECT_DOUBLE_EQ(volume_of(mesh), whole);
  append(mesh, sphere(0.5, 8), 0.1);  // within it
  EXPECT_NEAR(volume_of(mesh), whole, 1e-14);
  append(mesh, sphere(0.5, 8), 1e3);  // apart
  EXPECT_NEAR(volume_of(mesh), whole + volume_of(sphere(0.5, 8)), 1e-12);
  EXPECT_EQ(volume_of(hemisphere(1.0, 4)), 0.0);
}

TEST(Polygon, IsDividedByTheShorterDiagonal) {
  using Triangles = std::vector<std::array<int, 3>>;
  const std::vector<Vector> lozenge = {{0.0, 0.0, 0.0}, {2.0, -1.0, 0.0}, {4.0, 0.0, 0.0}, {2.0, 1.0, 0.0}};
  EXPECT_EQ(triangulate(lozenge, {0, 1, 2, 3}), (Triangles{{1, 2, 3}, {0, 1, 3}}));
  const std::vector<Vector> square = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}};
  EXPECT_EQ(triangulate(square, {0, 1, 2, 3}), (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(triangulate(square, {2, 1, 0}), (Triangles{{2, 1, 0}}));
}

TEST(Polygon, ConcaveCornersAndCornersOnSidesKeepTheArea) {
  // An arrow whose shorter diagonal lies outside; an L with a corner on a side.
  const std::vector<Vector> arrow = {{0.0, 0.0, 0.0}, {2.0, 0.0, 1.0}, {0.0, 0.0, 0.5}, {-2.0, 0.0, 1.0}};
  const std::vector<Vector> ell = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {2.0, 1.0, 0.0},
                                   {1.0, 1.0, 0.0}, {1.0, 2.0, 0.0}, {0.0, 2.0, 0.0}};
  const auto area = [](const std::vector<Vector>& points, std::size_t axis) {
    std::vector<int> corners;
    for (std::size_t k = 0; k < points.size(); ++k) corners.push_back(static_cast<int>(k));
    const auto triangles = triangulate(points, corners);
    EXPECT_EQ(triangles.size(), points.size() - 2);
    double sum = 0.0, sizes = 0.0;
    for (const auto& t : triangles) {
      sum += 0.5 * doubled_area(points, t)[axis];
      sizes += 0.5 * std::abs(doubled_area(points, t)[axis]);
    }
    EXPECT_DOUBLE_EQ(std::abs(sum), sizes) << "all turn alike";
    return sizes;
  };
  EXPECT_DOUBLE_EQ(area(arrow, 1), 1.0);
  EXPECT_DOUBLE_EQ(area(ell, 2), 3.0);
}

TEST(Polygon, GivesNoTrianglesIfItCrossesItself) {
  const std::vector<Vector> points = {{0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  EXPECT_TRUE(triangulate(points, {0, 1, 2, 3}).empty());
}

TEST(Topology, FindsVerticesThatAreNearToEachOther) {
  Mesh mesh;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) mesh.rest.push_back({0.1 * i, 0.1 * j, 0.0});
  EXPECT_FALSE(near_vertices(mesh, 0.09));
  mesh.rest.push_back({0.3, 0.4, 1e-7});
  const auto pair = near_vertices(mesh, 1e-6 * extent_of(mesh));
  ASSERT_TRUE(pair);
  EXPECT_EQ(*pair, (std::array{34, 100}));
  EXPECT_FALSE(near_vertices(mesh, 1e-8));
}

}  // namespace
}  // namespace drogue::mesh
