#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kernels/fabric/contact/features.hpp"
#include "kernels/mesh/edges.hpp"
#include "kernels/mesh/generators.hpp"
#include "kernels/mesh/quality.hpp"
#include "kernels/mesh/renumbering.hpp"
#include "kernels/mesh/topology.hpp"

namespace drogue::mesh {
namespace {

/// Sum of the areas, all normals along +z.
double flat_area(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const Vector normal = doubled_area(mesh.rest, triangle);
    EXPECT_EQ(normal[0], 0.0);
    EXPECT_EQ(normal[1], 0.0);
    EXPECT_GT(normal[2], 0.0);
    sum += 0.5 * normal[2];
  }
  return sum;
}

/// A disk of the plane has one vertex more than edges less triangles (Euler), and no vertex lies outside it.
void expect_simply_connected(const Mesh& mesh) {
  EXPECT_EQ(mesh.rest.size() + mesh.triangles.size(), edges_of(mesh).size() + 1);
  std::set<int> used;
  for (const auto& triangle : mesh.triangles) used.insert(triangle.begin(), triangle.end());
  EXPECT_EQ(used.size(), mesh.rest.size());
}

double largest_edge(const Mesh& mesh) {
  double largest = 0.0;
  for (const auto& [i, j] : edges_of(mesh)) {
    const Vector &a = mesh.rest[static_cast<std::size_t>(i)], &b = mesh.rest[static_cast<std::size_t>(j)];
    largest = std::max(largest, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
  }
  return largest;
}

TEST(Mesh, EdgesAreUniqueInBothDirections) {
  Mesh mesh;
  mesh.rest = {{0.0, 0.0, 0.0}, {3.0, 0.0, 0.0}, {0.0, 4.0, 0.0}, {3.0, 4.0, 0.0}, {0.0, 0.0, 7.0}};
  mesh.triangles = {{0, 1, 2}, {3, 2, 1}};
  mesh.lines = {{4, 0}, {2, 1}};  // a string, and a seam that is an edge of both triangles
  using Edges = std::vector<Edge>;
  const Edges of_triangles = {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}};
  EXPECT_EQ(triangle_edges(mesh), of_triangles);
  EXPECT_EQ(edges_of(mesh), (Edges{{0, 1}, {0, 2}, {0, 4}, {1, 2}, {1, 3}, {2, 3}}));
  const fabric::CollisionEdges edges = fabric::collision_edges(mesh);
  Edges lines_last = of_triangles;
  lines_last.push_back({0, 4});
  EXPECT_EQ(edges.ends, lines_last);
  EXPECT_EQ(edges.first_line, 5);
  EXPECT_DOUBLE_EQ(edges.mean_length, (3.0 + 4.0 + 7.0 + 5.0 + 4.0 + 3.0) / 6.0);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(opposite_edge({3, 2, 1}, k), (Edges{{1, 2}, {1, 3}, {2, 3}})[k]);
}

TEST(Mesh, RectangleCoversItsArea) {
  for (const int vertices : {4, 5, 100, 5461}) {
    const Mesh mesh = generate(Rectangle{2.0, 0.5, vertices});
    EXPECT_NEAR(flat_area(mesh), 1.0, 1e-12);
    expect_simply_connected(mesh);
    if (vertices > 50) {
      EXPECT_NEAR(static_cast<double>(mesh.rest.size()) / vertices, 1.0, 0.1);
    }
  }
}

TEST(Mesh, DistortedRectangleKeepsBoundaryAndOrientation) {
  const Mesh even = generate(Rectangle{2.0, 0.5, 500}), mesh = generate(Rectangle{2.0, 0.5, 500, 0.2});
  EXPECT_EQ(mesh.triangles, even.triangles);
  EXPECT_NEAR(flat_area(mesh), 1.0, 1e-12);
  const double cell = 2.0 / std::round(2.0 * std::sqrt(even.rest.size()));
  std::set<double> moved;
  for (std::size_t i = 0; i < mesh.rest.size(); ++i) {
    const Vector &x = mesh.rest[i], &was = even.rest[i];
    const bool side = was[0] == 0.0 || was[0] == 2.0 || was[1] == 0.0 || was[1] == 0.5;
    for (std::size_t axis = 0; axis < 2; ++axis)
      EXPECT_LE(std::abs(x[axis] - was[axis]), side ? 0.0 : 0.5 * cell);
    if (!side) moved.insert(x[0] - was[0]);
  }
  EXPECT_GT(moved.size(), 350U);
  EXPECT_GT(*moved.rbegin() - *moved.begin(), 0.3 * 0.045);
}

TEST(Mesh, DiskUsesTheNearestNumberOfRings) {
  for (const auto& [asked, got] :
       {std::pair{7, 7U}, {12, 7U}, {14, 19U}, {266, 271U}, {3169, 3169U}, {3790, 3781U}}) {
    const Mesh mesh = generate(Disk{0.4, asked});
    EXPECT_EQ(mesh.rest.size(), got);
    expect_simply_connected(mesh);
    for (std::size_t i = 0; i < mesh.rest.size(); ++i)
      EXPECT_LT(std::hypot(mesh.rest[i][0], mesh.rest[i][1]), 0.4 + 1e-15);
  }
  // A polygon of 6 n corners.
  const int sides = 6 * 32;
  EXPECT_NEAR(flat_area(generate(Disk{1.0, 3169})), 0.5 * sides * std::sin(2.0 * M_PI / sides), 1e-12);
}

TEST(Mesh, StripHasNearlyEquilateralTrianglesAndStraightEnds) {
  for (const int vertices : {4, 7, 60, 4000}) {
    const Mesh mesh = generate(Strip{0.1, 0.02, vertices});
    EXPECT_NEAR(flat_area(mesh), 0.002, 1e-15);
    expect_simply_connected(mesh);
    double low = 1.0, high = 0.0;
    for (const Vector& x : mesh.rest) low = std::min(low, x[0]), high = std::max(high, x[0]);
    EXPECT_EQ(low, 0.0);
    EXPECT_NEAR(high, 0.1, 1e-16);
    if (vertices < 50) continue;
    EXPECT_NEAR(static_cast<double>(mesh.rest.size()) / vertices, 1.0, 0.1);
    const double equilateral =
        std::sqrt(4.0 * 0.002 / (std::sqrt(3.0) * static_cast<double>(mesh.triangles.size())));
    EXPECT_NEAR(largest_edge(mesh) / equilateral, 1.0, 0.2);
  }
}

TEST(Mesh, TriangleIsDividedIntoEqualTriangles) {
  for (const int vertices : {3, 6, 1123}) {
    const Mesh mesh = generate(Triangle{2.0, vertices});
    EXPECT_NEAR(flat_area(mesh), std::sqrt(3.0), 1e-12);
    expect_simply_connected(mesh);
    const double n = std::sqrt(static_cast<double>(mesh.triangles.size()));
    EXPECT_NEAR(largest_edge(mesh), 2.0 / n, 1e-12);
  }
  EXPECT_EQ(generate(Triangle{1.0, 1123}).rest.size(), 1128U);
}

TEST(Mesh, StringHasEqualSegments) {
  const Mesh mesh = generate(String{{0.5, 0.85, 0.0}, {0.8, 0.35, 0.0}, 60});
  EXPECT_EQ(mesh.rest.size(), 60U);
  EXPECT_EQ(mesh.lines.size(), 59U);
  EXPECT_EQ(mesh.rest.back(), (Vector{0.8, 0.35, 0.0}));
  EXPECT_NEAR(largest_edge(mesh), std::hypot(0.3, 0.5) / 59, 1e-15);
}

/// Bandwidth: largest difference of the indices of two neighbours.
int bandwidth(const Mesh& mesh) {
  int widest = 0;
  for (const auto& [i, j] : edges_of(mesh)) widest = std::max(widest, j - i);
  return widest;
}

TEST(Mesh, RenumberingReducesTheBandwidth) {
  const Mesh disk = generate(Disk{1.0, 3169});
  // Random vertex numbers.
  std::vector<int> shuffled(disk.rest.size());
  for (std::size_t k = 0; k < shuffled.size(); ++k)
    shuffled[k] = static_cast<int>((k * 1013) % shuffled.size());
  const Mesh mesh = renumber(disk, shuffled);
  const std::vector<int> order = reverse_cuthill_mckee(mesh);
  EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), mesh.rest.size());
  const Mesh local = renumber(mesh, order);
  EXPECT_GT(bandwidth(mesh), 2000);
  EXPECT_LT(bandwidth(local), 250);
  EXPECT_NEAR(flat_area(local), flat_area(disk), 1e-13);
  for (std::size_t k = 0; k < order.size(); ++k)
    EXPECT_EQ(local.rest[k], mesh.rest[static_cast<std::size_t>(order[k])]);
}

TEST(Mesh, RenumberingKeepsTheValuesOfLines) {
  Mesh mesh;
  mesh.rest = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {3.0, 0.0, 0.0}};
  mesh.lines = {{0, 1}, {1, 2}};
  mesh.line_stiffness = {5.0, 6.0};
  mesh.line_density = {0.1, 0.2};
  mesh.line_length = {0.0, 1.5};
  const Mesh turned = renumber(mesh, {2, 1, 0});
  EXPECT_EQ(turned.lines, (std::vector<std::array<int, 2>>{{2, 1}, {1, 0}}));
  EXPECT_EQ(turned.line_stiffness, mesh.line_stiffness);
  EXPECT_EQ(turned.line_density, mesh.line_density);
  EXPECT_EQ(rest_length(turned, 0), 1.0) << "the distance of its ends";
  EXPECT_EQ(rest_length(turned, 1), 1.5);
}

TEST(Mesh, ReportListsAnglesAndAreas) {
  const std::string text = quality_report(generate(Triangle{1.0, 3}));
  EXPECT_NE(text.find("3 vertices, 1 triangles, 0 lines"), std::string::npos) << text;
  EXPECT_NE(text.find("60 .. 60, mean 60 degrees"), std::string::npos) << text;
  EXPECT_NE(text.find("0.433013 .. 0.433013"), std::string::npos) << text;
}

}  // namespace
}  // namespace drogue::mesh
