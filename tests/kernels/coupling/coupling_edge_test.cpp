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
    const std::vector<Vector> expected = reference::inset_positions(mesh, mesh::open_edges(mesh),
                                                                    inset * cell, inset_band * cell, after),
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

TEST(EdgeInset, LeavesClosedSurfacesAndEdgesAlongSides) {
  EXPECT_TRUE(inset_points(mesh::sphere(2.0, 8), box(16, 16), inset).empty());
  EXPECT_FALSE(inset_points(mesh::hemisphere(2.0, 8), box(16, 16), inset).empty());
  // A strip in two dimensions ends at its tips, unless these lie at sides as well.
  const Mesh free = strip(4.0, 32);
  EXPECT_EQ(free_edges(free, box(16, 1)).size(), 8U) << "two tips of four edges";
  const auto places = before_and_after(free, box(16, 1), inset);
  EXPECT_FALSE(places.empty());
  for (const auto& [before, after] : places) {
    EXPECT_LT(std::abs(after[1]), std::abs(before[1])) << "along the strip";
    EXPECT_NEAR(after[2], before[2], 1e-12);
  }
  EXPECT_TRUE(free_edges(strip(8.0, 64), box(16, 1)).empty()) << "it closes the channel";
}

TEST(EdgeInset, KeepsTheOrderOfPoints) {
  // With the largest inset, points come nearer by the half.
  constexpr double apart = 0.05;
  auto places = before_and_after(strip(6.0, 120), box(16, 1), 1.0);
  std::erase_if(places, [](const auto& pair) { return pair.first[2] != 0.0 || pair.first[1] < 0.0; });
  std::ranges::sort(places);
  ASSERT_EQ(places.size(), 20U) << "the distances of 0 to 0.95 m";
  EXPECT_NEAR(places.back().second[1], 3.0 - cell, 1e-12);
  for (std::size_t k = 1; k < places.size(); ++k)
    EXPECT_NEAR(places[k].second[1] - places[k - 1].second[1], 0.5 * apart, 1e-12) << k;
}

}  // namespace
}  // namespace drogue::coupling
