#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/coupling/sheet/edge_inset.hpp"
#include "kernels/mesh/generators.hpp"
#include "kernels/mesh/round_surfaces.hpp"
#include "kernels/reference/coupling/edge_inset.hpp"
#include "tests/support/fabric_mesh.hpp"

// Places near free edges at which sheets exchange forces with the air.

namespace drogue::coupling {
namespace {

using Space = DROGUE_TEST_SPACE;
using drogue::testing::random_patch;
using drogue::testing::shaken;
using mesh::Mesh;
using mesh::Vector;

constexpr double cell = 0.5, inset = 0.55;

/// Box of cells of 0.5 m about the origin.
StaggeredGrid box(int cells, int layers) {
  StaggeredGrid grid;
  grid.cells = {cells, cells, layers};
  grid.spacing = {cell, cell, cell};
  grid.origin = {-0.5 * cells * cell, -0.5 * cells * cell, -0.5 * layers * cell};
  return grid;
}

fabric::PointsView<Space> on_device(const std::vector<Vector>& points) {
  std::array<std::vector<double>, 3> columns;
  for (const Vector& point : points)
    for (std::size_t axis = 0; axis < 3; ++axis) columns[axis].push_back(point[axis]);
  return fabric::table_view(Space(), "points", columns);
}

/// Points of a surface at positions x and velocities v, m and m/s, after a time, s.
std::vector<Vector> moved(const Mesh& mesh, const std::vector<Vector>& x, const std::vector<Vector>& v,
                          double time, double by) {
  std::vector<Vector> after = x;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) after[i][axis] += time * v[i][axis];
  const Space space;
  const fabric::PointsView<Space> points = on_device(after);
  EdgeInset<Space>(space, mesh, box(64, 64), by)(space, {on_device(x), on_device(v)}, time, points);
  space.fence();
  const auto mirror = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, points);
  for (std::size_t i = 0; i < x.size(); ++i) after[i] = {mirror(i, 0), mirror(i, 1), mirror(i, 2)};
  return after;
}

double radius_of(const Vector& x) { return std::hypot(x[0], x[1]); }

TEST(EdgeInset, MovesPointsAsTheReference) {
  for (Mesh mesh : {random_patch(14, 9, 3), mesh::disk(5.0, 24), mesh::hemisphere(4.0, 20)}) {
    // The distances of edges and triangles differ, so that one is the nearest.
    mesh.rest = shaken(mesh.rest, 0.02, 2);
    const std::vector<Vector> x = shaken(mesh.rest, 0.1, 5), v = shaken(mesh.rest, 2.0, 7);
    std::vector<Vector> after = x;
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) after[i][axis] += 0.01 * v[i][axis];
    const std::vector<Vector> expected = reference::inset_positions(
                                  mesh, [](const Vector&) { return false; }, inset * cell, inset_band * cell,
                                  after),
                              found = moved(mesh, x, v, 0.01, inset);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[i][axis], expected[i][axis], 1e-12) << i;
      if (found[i] != after[i]) ++changed;
    }
    EXPECT_GT(changed, 20U);
    EXPECT_LT(changed, x.size());
    EXPECT_EQ(moved(mesh, x, v, 0.01, 0.0), after) << "without an inset";
  }
}

TEST(EdgeInset, MovesRimsInwardsAndVentsOutwards) {
  // Rings 0.05 m apart from the vent of 1 m to the rim of 4 m.
  constexpr double vent = 1.0, rim = 4.0, rings = 60.0, band = inset_band * cell;
  constexpr int columns = 500;
  Mesh mesh = mesh::rectangle(1.0, 1.0, static_cast<int>(rings), columns);
  for (Vector& point : mesh.rest) {
    const double r = vent + (rim - vent) * point[0], phi = 2.0 * std::numbers::pi * point[1];
    point = {r * std::cos(phi), r * std::sin(phi), 0.0};
  }
  const std::vector<Vector> found = moved(mesh, mesh.rest, std::vector<Vector>(mesh.rest.size()), 0.0, inset);
  int tested = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    // The seam of the rectangle is an edge, too.
    if (std::abs(mesh.rest[i][1]) < 2.0 * band && mesh.rest[i][0] > 0.0) continue;
    const double r = radius_of(mesh.rest[i]),
                 taper = [&](double distance) { return std::max(0.0, 1.0 - distance / band); }(
                             std::min(r - vent, rim - r)),
                 expected = r + (r - vent < rim - r ? 1.0 : -1.0) * inset * cell * taper;
    EXPECT_NEAR(radius_of(found[i]), expected, 1e-3) << r;
    ++tested;
  }
  EXPECT_GT(tested, 1000);
}

/// Places at rest of the points that move.
std::vector<std::pair<Vector, Vector>> before_and_after(const Mesh& mesh, const StaggeredGrid& grid,
                                                        double by) {
  std::vector<std::pair<Vector, Vector>> pairs;
  for (const mesh::SurfacePoint& point : inset_points(mesh, grid, by)) {
    Vector place{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis)
        place[axis] += point.weight[k] * mesh.rest[static_cast<std::size_t>(point.corner[k])][axis];
    pairs.emplace_back(mesh.rest[static_cast<std::size_t>(point.vertex)], place);
  }
  return pairs;
}

/// Strip along y across a box of one layer, m, of four triangles along z.
Mesh strip(double length, int segments) {
  Mesh mesh = mesh::rectangle(length, cell, segments, 4);
  for (Vector& point : mesh.rest) point = {0.1, point[0] - 0.5 * length, point[1] - 0.5 * cell};
  return mesh;
}

TEST(EdgeInset, LeavesClosedSurfacesAndEndsAtSides) {
  EXPECT_TRUE(inset_points(mesh::sphere(2.0, 8), box(16, 16), inset).empty());
  EXPECT_FALSE(inset_points(mesh::hemisphere(2.0, 8), box(16, 16), inset).empty());
  // A strip in two dimensions ends at its tips, unless these lie at sides as well.
  const auto places = before_and_after(strip(4.0, 32), box(16, 1), inset);
  EXPECT_EQ(places.size(), 2U * 8U * 5U) << "eight lines within two cells of each tip";
  for (const auto& [before, after] : places) {
    EXPECT_LT(std::abs(after[1]), std::abs(before[1])) << "along the strip";
    EXPECT_NEAR(after[2], before[2], 1e-12);
  }
  EXPECT_TRUE(inset_points(strip(8.0, 64), box(16, 1), inset).empty()) << "it closes the channel";
}

TEST(EdgeInset, TakesASheetAlongASideAsElsewhere) {
  const auto places_at = [](double height) {
    Mesh mesh = mesh::disk(2.0, 10);
    for (Vector& point : mesh.rest) point[2] += height;
    auto places = before_and_after(mesh, box(16, 16), inset);
    for (auto& [before, after] : places) before[2] -= height, after[2] -= height;
    return places;
  };
  const auto inside = places_at(0.0), beside = places_at(-4.0);
  ASSERT_EQ(inside.size(), beside.size());
  EXPECT_GT(inside.size(), 60U);
  for (std::size_t k = 0; k < inside.size(); ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(inside[k].second[axis], beside[k].second[axis], 1e-12);
}

TEST(EdgeInset, CountsCellsAlongItsDirection) {
  // A grid and a mesh that are stretched together.
  constexpr std::array<double, 3> stretch{3.0, 0.7, 2.0};
  Mesh mesh = mesh::disk(2.0, 10);
  mesh.rest = shaken(mesh.rest, 0.02, 2);
  const auto expected = before_and_after(mesh, box(16, 16), inset);
  StaggeredGrid grid = box(16, 16);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.spacing[axis] *= stretch[axis];
    grid.origin[axis] *= stretch[axis];
    for (Vector& point : mesh.rest) point[axis] *= stretch[axis];
  }
  const auto found = before_and_after(mesh, grid, inset);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(found[k].second[axis], stretch[axis] * expected[k].second[axis], 1e-12);
}

TEST(EdgeInset, KeepsTheOrderOfPointsOfWideAndNarrowStrips) {
  constexpr double apart = 0.05;
  // Half of their widths, m: those of less than a metre are less than four cells wide.
  for (const double half : {3.0, 1.0, 0.75, 0.5, 0.25, 0.1}) {
    const double width = std::min(half, inset_band * cell);
    for (const double by : {0.55, 1.0}) {
      const Mesh mesh = strip(2.0 * half, static_cast<int>(std::lround(2.0 * half / apart)));
      std::vector<std::pair<double, double>> line;
      for (const auto& [before, after] : before_and_after(mesh, box(64, 1), by))
        if (before[2] == 0.0) line.emplace_back(before[1], after[1]);
      std::ranges::sort(line);
      ASSERT_GE(line.size(), 4U);
      for (std::size_t k = 0; k < line.size(); ++k) {
        EXPECT_NEAR(line[k].second, -line[line.size() - 1 - k].second, 1e-12) << "symmetric";
        if (k == 0 || line[k].first - line[k - 1].first > 1.5 * apart) continue;
        EXPECT_GE(line[k].second - line[k - 1].second, 0.5 * apart - 1e-12) << half << ' ' << k;
      }
      EXPECT_NEAR(line.back().second, half - std::min(by * cell, 0.5 * width), 1e-12) << half;
    }
  }
}

TEST(EdgeInset, MovesNarrowSheetsAsTheReference) {
  // Three cells wide.
  Mesh mesh = mesh::rectangle(5.0, 3.0 * cell, 40, 12);
  mesh.rest = shaken(mesh.rest, 0.02, 2);
  const std::vector<Vector> still(mesh.rest.size()),
      found = moved(mesh, mesh.rest, still, 0.0, inset),
      expected = reference::inset_positions(
          mesh, [](const Vector&) { return false; }, inset * cell, inset_band * cell, mesh.rest);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[i][axis], expected[i][axis], 1e-12) << i;
}

/// Ring of cloth about a vent, m, of which four, or more, vertices lie on the vent.
Mesh ring(double vent, int columns) {
  Mesh mesh;
  constexpr int rings = 12;
  for (int row = 0; row <= rings; ++row)
    for (int k = 0; k < columns; ++k) {
      const double r = vent + 0.2 * row, phi = 2.0 * std::numbers::pi * k / columns;
      mesh.rest.push_back({r * std::cos(phi), r * std::sin(phi), 0.0});
    }
  for (int row = 0; row < rings; ++row)
    for (int k = 0; k < columns; ++k) {
      const int a = row * columns + k, b = row * columns + (k + 1) % columns;
      mesh.triangles.push_back({a, a + columns, b});
      mesh.triangles.push_back({a + columns, b + columns, b});
    }
  return mesh;
}

TEST(EdgeInset, WidensSmallVentsRadially) {
  for (const auto& [vent, columns] : {std::pair{0.2, 28}, {0.2, 4}, {0.55, 14}, {0.75, 60}})
    for (const auto& [before, after] : before_and_after(ring(vent, columns), box(64, 64), inset)) {
      const double r = radius_of(before);
      if (r > vent + 1e-9) continue;
      // Between vertices, the cloth is a polygon.
      const double sagitta = 1.0 - std::cos(std::numbers::pi / columns);
      EXPECT_NEAR(radius_of(after), vent + inset * cell, (vent + inset * cell) * sagitta + 1e-12) << vent;
      EXPECT_NEAR(before[0] * after[1] - before[1] * after[0], 0.0, 1e-9) << "along the radius";
    }
}

}  // namespace
}  // namespace drogue::coupling
