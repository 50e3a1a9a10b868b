#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "kernels/device/captured_graph.hpp"
#include "kernels/fabric/fabric_views.hpp"
#include "kernels/fabric/surface/surface.hpp"
#include "kernels/mesh/generators.hpp"
#include "kernels/reference/coupling/surface.hpp"
#include "tests/support/fabric_mesh.hpp"
#include "tests/support/other_space.hpp"
#include "tests/support/profiled.hpp"

// Areas, normals and velocities of a surface against the oracle.

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
  const PointsView<E> positions = points_view(space, x), triangle_normal("normal", mesh.triangles.size()),
                      vertex_normal("normal", x.size());
  const ListView<E, double> triangle_area("area", mesh.triangles.size()), vertex_area("area", x.size());
  triangle_geometry(space, surface, positions, triangle_area, triangle_normal);
  vertex_geometry(space, surface, positions, vertex_area, vertex_normal);
  return {numbers(triangle_area), numbers(vertex_area), vectors(triangle_normal), vectors(vertex_normal)};
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
  expect_near(a.triangle_area, b.triangle_area, tolerance);
  expect_near(a.vertex_area, b.vertex_area, tolerance);
  expect_near(a.triangle_normal, b.triangle_normal, tolerance);
  expect_near(a.vertex_normal, b.vertex_normal, tolerance);
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
  const double vertices = std::accumulate(now.vertex_area.begin(), now.vertex_area.end(), 0.0),
               triangles = std::accumulate(now.triangle_area.begin(), now.triangle_area.end(), 0.0);
  EXPECT_NEAR(vertices, triangles, 1e-13);
  EXPECT_NEAR(vertices, 3.14159265, 0.01);
  expect_near(now.vertex_normal, std::vector<Vector>(mesh.rest.size(), {0.0, 0.0, 1.0}), 1e-15);
}

TEST(FabricSurface, StringsAndDegenerateTrianglesHaveNoAreaAndNoNormal) {
  Mesh mesh;
  mesh.rest = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 5}, {0, 0, 6}};
  mesh.triangles = {{0, 1, 2}};
  mesh.lines = {{3, 4}};
  const reference::SurfaceGeometry now = geometry<Space>(mesh, mesh.rest);
  EXPECT_EQ(now.triangle_area, std::vector<double>{0.0});
  EXPECT_EQ(now.triangle_normal, std::vector<Vector>{Vector{}});
  EXPECT_EQ(now.vertex_area, std::vector<double>(5, 0.0));
  EXPECT_EQ(now.vertex_normal, std::vector<Vector>(5, Vector{}));
}

TEST(FabricSurface, FoldCancelsTheNormalAndKeepsTheArea) {
  Mesh mesh;
  mesh.rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  const reference::SurfaceGeometry now = geometry<Space>(mesh, mesh.rest);
  EXPECT_NEAR(now.vertex_area[0], 1.0 / 3.0, 1e-16);
  EXPECT_EQ(now.vertex_normal[0], Vector{});
  EXPECT_NEAR(now.vertex_normal[2][2], 1.0, 1e-15);
}

TEST(FabricSurface, TriangleVelocitiesAreMeansOfCorners) {
  const Space space;
  const Mesh mesh = random_patch(7, 6, 2);
  const std::vector<Vector> v = shaken(std::vector<Vector>(mesh.rest.size(), Vector{}), 3.0, 8);
  const PointsView<Space> result("velocity", mesh.triangles.size());
  triangle_velocities(space, SurfaceViews<Space>(space, mesh), points_view(space, v), result);
  std::vector<Vector> expected;
  for (const auto& t : mesh.triangles) {
    Vector mean{};
    for (const int i : t)
      for (std::size_t k = 0; k < 3; ++k) mean[k] += v[static_cast<std::size_t>(i)][k] / 3.0;
    expected.push_back(mean);
  }
  expect_near(vectors(result), expected, 1e-15);
}

TEST(FabricSurface, ReadsPaddedViewsWithoutFenceAllocationOrCopyAndReplaysFromAGraph) {
  const device::Instance<Space> instance(1);
  const Space& space = instance.space();
  const Mesh mesh = random_patch(7, 6, 2);
  std::vector<Vector> x = shaken(mesh.rest, 0.1, 1), v(x.size(), Vector{1.0, 2.0, 3.0});
  // As the state of a solver: components are a whole number of slices apart.
  const std::size_t vertices = x.size();
  x.resize(64), v.resize(64);
  const auto state = [&](const std::vector<Vector>& rows) {
    return Kokkos::subview(points_view(space, rows), Kokkos::make_pair(std::size_t{0}, vertices),
                           Kokkos::ALL);
  };
  const PointsView<Space> positions = state(x), velocities = state(v);
  x.resize(vertices);
  const SurfaceViews<Space> surface(space, mesh);
  const ListView<Space, double> area("area", vertices), triangle_area("area", mesh.triangles.size());
  const PointsView<Space> normal("normal", vertices), triangle_normal("normal", mesh.triangles.size()),
      velocity("velocity", mesh.triangles.size());
  const auto enqueue = [&](const Space& on) {
    vertex_geometry(on, surface, positions, area, normal);
    triangle_geometry(on, surface, positions, triangle_area, triangle_normal);
    triangle_velocities(on, surface, velocities, velocity);
  };
  const auto before = drogue::testing::profiled();
  enqueue(space);
  const auto after = drogue::testing::profiled();
  EXPECT_EQ(after.fences, before.fences);
  EXPECT_EQ(after.allocations, before.allocations);
  EXPECT_EQ(after.copies, before.copies);
  EXPECT_LE(after.kernel_launches - before.kernel_launches, 3);
  const reference::SurfaceGeometry compact = geometry<Space>(mesh, x);
  expect_near(numbers(area), compact.vertex_area, 0.0);
  expect_near(vectors(triangle_normal), compact.triangle_normal, 0.0);
  expect_near(vectors(velocity), std::vector<Vector>(mesh.triangles.size(), {1.0, 2.0, 3.0}), 1e-15);
  const device::CapturedGraph<Space> graph(instance, enqueue);
  Kokkos::deep_copy(space, area, 0.0);
  graph.launch();
  expect_near(numbers(area), compact.vertex_area, 0.0);
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
  EXPECT_THROW(triangle_geometry(space, surface, rows, areas, few), std::invalid_argument);
  EXPECT_THROW(triangle_velocities(space, surface, rows, few), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::fabric
