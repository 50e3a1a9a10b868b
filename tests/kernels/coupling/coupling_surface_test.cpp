#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "kernels/device/captured_graph.hpp"
#include "kernels/fabric/fabric_views.hpp"
#include "kernels/fabric/surface/surface.hpp"
#include "kernels/mesh/generators.hpp"
#include "kernels/reference/coupling/surface.hpp"
#include "tests/support/fabric_mesh.hpp"
#include "tests/support/other_space.hpp"
#include "tests/support/profiled.hpp"

// Areas and normals of a surface against the oracle.

namespace drogue::fabric {
namespace {

using Space = DROGUE_TEST_SPACE;
using OtherSpace = drogue::testing::OtherHostSpace<Space>;
using drogue::testing::random_patch;
using drogue::testing::shaken;

#if defined(DROGUE_EXACT)
constexpr double backend_tolerance = 0.0;
#else
constexpr double backend_tolerance = 1e-14;
#endif

template <class E>
PointsView<E> points_view(const E& space, const std::vector<Vector>& points) {
  std::array<std::vector<double>, 3> columns;
  for (const Vector& point : points)
    for (std::size_t axis = 0; axis < 3; ++axis) columns[axis].push_back(point[axis]);
  return table_view(space, "points", columns);
}

template <class View>
std::vector<Vector> vectors(const View& view) {
  Kokkos::fence();
  const auto mirror = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, view);
  std::vector<Vector> rows(view.extent(0));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = {mirror(i, 0), mirror(i, 1), mirror(i, 2)};
  return rows;
}

template <class View>
std::vector<double> numbers(const View& view) {
  Kokkos::fence();
  const auto mirror = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, view);
  return {mirror.data(), mirror.data() + mirror.extent(0)};
}

template <class E>
reference::SurfaceGeometry geometry(const Mesh& mesh, const std::vector<Vector>& x) {
  const E space;
  const SurfaceViews<E> surface(space, mesh);
  const PointsView<E> normal("normal", x.size());
  const ListView<E, double> area("area", x.size());
  vertex_geometry(space, surface, points_view(space, x), area, normal);
  return {numbers(area), vectors(normal)};
}

void expect_near(const std::vector<Vector>& a, const std::vector<Vector>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(a[i][k], b[i][k], tolerance) << i << ' ' << k;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance) << i;
}

void expect_near(const reference::SurfaceGeometry& a, const reference::SurfaceGeometry& b, double tolerance) {
  expect_near(a.area, b.area, tolerance);
  expect_near(a.normal, b.normal, tolerance);
}

TEST(FabricSurface, GeometryMatchesTheOracleOnARandomPatchWithStrings) {
  const Mesh mesh = random_patch(13, 9, 5);
  const std::vector<Vector> x = shaken(mesh.rest, 0.6, 3);
  expect_near(geometry<Space>(mesh, x), reference::surface_geometry(mesh, x), 1e-13);
}

TEST(FabricSurface, BackendsAgree) {
  const Mesh mesh = random_patch(40, 31, 6);
  const std::vector<Vector> x = shaken(mesh.rest, 0.6, 4);
  expect_near(geometry<Space>(mesh, x), geometry<OtherSpace>(mesh, x), backend_tolerance);
}

TEST(FabricSurface, VertexAreasAddUpToTheAreaOfADisk) {
  const Mesh mesh = mesh::generate(mesh::Disk{1.0, 1000});
  const reference::SurfaceGeometry now = geometry<Space>(mesh, mesh.rest);
  const double flat_area = std::transform_reduce(
      mesh.triangles.begin(), mesh.triangles.end(), 0.0, std::plus<>(), [&](const auto& t) {
        const auto corner = [&](std::size_t k) { return mesh.rest[static_cast<std::size_t>(t[k])]; };
        return 0.5 * ((corner(1)[0] - corner(0)[0]) * (corner(2)[1] - corner(0)[1]) -
                      (corner(2)[0] - corner(0)[0]) * (corner(1)[1] - corner(0)[1]));
      });
  EXPECT_NEAR(std::accumulate(now.area.begin(), now.area.end(), 0.0), flat_area, 1e-13);
  EXPECT_NEAR(flat_area, 3.14159265, 0.01);
  expect_near(now.normal, std::vector<Vector>(mesh.rest.size(), {0.0, 0.0, 1.0}), 1e-15);
}

TEST(FabricSurface, StringsAndDegenerateTrianglesHaveNoAreaAndNoNormal) {
  Mesh mesh;
  mesh.rest = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 5}, {0, 0, 6}};
  mesh.triangles = {{0, 1, 2}};
  mesh.lines = {{3, 4}};
  const reference::SurfaceGeometry now = geometry<Space>(mesh, mesh.rest);
  EXPECT_EQ(now.area, std::vector<double>(5, 0.0));
  EXPECT_EQ(now.normal, std::vector<Vector>(5, Vector{}));
}

TEST(FabricSurface, FoldCancelsTheNormalAndKeepsTheArea) {
  Mesh mesh;
  mesh.rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  const reference::SurfaceGeometry now = geometry<Space>(mesh, mesh.rest);
  EXPECT_NEAR(now.area[0], 1.0 / 3.0, 1e-16);
  EXPECT_EQ(now.normal[0], Vector{});
  EXPECT_NEAR(now.normal[2][2], 1.0, 1e-15);
}

TEST(FabricSurface, ReadsPaddedViewsWithoutFenceAllocationOrCopyAndReplaysFromAGraph) {
  const device::Instance<Space> instance(1);
  const Space& space = instance.space();
  const Mesh mesh = random_patch(7, 6, 2);
  std::vector<Vector> x = shaken(mesh.rest, 0.1, 1);
  // As the state of a solver: components are a whole number of slices apart.
  const std::size_t vertices = x.size();
  x.resize(64);
  const PointsView<Space> positions =
      Kokkos::subview(points_view(space, x), Kokkos::make_pair(std::size_t{0}, vertices), Kokkos::ALL);
  x.resize(vertices);
  const SurfaceViews<Space> surface(space, mesh);
  const ListView<Space, double> area("area", vertices);
  const PointsView<Space> normal("normal", vertices);
  const auto enqueue = [&](const Space& on) { vertex_geometry(on, surface, positions, area, normal); };
  const auto before = drogue::testing::profiled();
  enqueue(space);
  const auto after = drogue::testing::profiled();
  EXPECT_EQ(after.fences, before.fences);
  EXPECT_EQ(after.allocations, before.allocations);
  EXPECT_EQ(after.copies, before.copies);
  EXPECT_LE(after.kernel_launches - before.kernel_launches, 1);
  const reference::SurfaceGeometry compact = geometry<Space>(mesh, x);
  expect_near(numbers(area), compact.area, 0.0);
  expect_near(vectors(normal), compact.normal, 0.0);
  const device::CapturedGraph<Space> graph(instance, enqueue);
  Kokkos::deep_copy(space, area, 0.0);
  graph.launch();
  expect_near(numbers(area), compact.area, 0.0);
}

TEST(FabricSurface, RejectsTrianglesOfVerticesThatDoNotExist) {
  const Mesh valid = random_patch(4, 3, 2);
  for (const int vertex : {-1, static_cast<int>(valid.rest.size())}) {
    Mesh mesh = valid;
    mesh.triangles[1][2] = vertex;
    EXPECT_THROW((SurfaceViews<Space>(Space(), mesh)), std::invalid_argument);
  }
}

TEST(FabricSurface, RejectsViewsWithTooFewRows) {
  const Space space;
  const Mesh mesh = random_patch(4, 3, 2);
  const SurfaceViews<Space> surface(space, mesh);
  const PointsView<Space> rows("rows", 100), few("few", 5);
  const ListView<Space, double> areas("areas", 100), few_areas("few", 5);
  EXPECT_THROW(vertex_geometry(space, surface, few, areas, rows), std::invalid_argument);
  EXPECT_THROW(vertex_geometry(space, surface, rows, few_areas, rows), std::invalid_argument);
  EXPECT_THROW(vertex_geometry(space, surface, rows, areas, few), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::fabric
