#include <gtest/gtest.h>

#include <cmath>

#include "kernels/coupling/sheet/immersed_sheet.hpp"
#include "kernels/device/copy.hpp"
#include "kernels/mesh/generators.hpp"
#include "kernels/mesh/round_surfaces.hpp"
#include "kernels/reference/coupling/surface.hpp"
#include "tests/support/fabric_mesh.hpp"
#include "tests/support/other_space.hpp"

// Means along a surface, which smooth what sheets leak.

namespace drogue::coupling {
namespace {

using Space = DROGUE_TEST_SPACE;
using OtherSpace = drogue::testing::OtherHostSpace<Space>;
using drogue::testing::random_patch;
using drogue::testing::shaken;
using mesh::Mesh;
using mesh::Vector;

#if defined(DROGUE_EXACT)
constexpr double backend_tolerance = 0.0;
#else
constexpr double backend_tolerance = 1e-14;
#endif

template <class E>
fabric::PointsView<E> on_device(const std::vector<Vector>& points) {
  std::array<std::vector<double>, 3> columns;
  for (const Vector& point : points)
    for (std::size_t axis = 0; axis < 3; ++axis) columns[axis].push_back(point[axis]);
  return fabric::table_view(E(), "points", columns);
}

/// Numbers at the vertices of a surface at x, smoothed so many times on a device.
template <class E = Space>
std::vector<double> smoothed(const Mesh& mesh, const std::vector<Vector>& x,
                             const std::vector<double>& values, int times) {
  const E space;
  const fabric::SurfaceViews<E> surface(space, mesh);
  const fabric::ListView<E, double> area("area", mesh.triangles.size());
  device::launch_each(space, "area", surface.triangles(),
                      TriangleAreaFunctor<E>{surface, on_device<E>(x), area});
  SmoothDefectFunctor<E> smooth{surface, area, VertexValues<E>("from", x.size(), 1),
                                VertexValues<E>("to", x.size(), 1)};
  device::copy_in(space, smooth.from, values.data(), values.size());
  for (int k = 0; k < times; ++k) {
    device::launch_each(space, "smooth", surface.vertices(), smooth);
    std::swap(smooth.from, smooth.to);
  }
  std::vector<double> result(values.size());
  device::copy_out(space, result.data(), smooth.from, result.size());
  space.fence();
  return result;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance) << i;
}

std::vector<double> random_numbers(std::size_t count, unsigned seed) {
  std::vector<double> result;
  for (const Vector& each : shaken(std::vector<Vector>(count), 1.0, seed)) result.push_back(each[0]);
  return result;
}

/// A patch with strings, its crumpled places, and values between -1 and 1.
struct Crumpled {
  Mesh mesh = random_patch(13, 9, 5);
  std::vector<Vector> x = shaken(mesh.rest, 0.6, 3);
  std::vector<double> values = random_numbers(x.size(), 4), others = random_numbers(x.size(), 5);
};

TEST(SurfaceMean, MatchesTheOracleOnARandomPatchWithStrings) {
  const Crumpled c;
  for (const int times : {1, 2, 7})
    expect_near(smoothed(c.mesh, c.x, c.values, times),
                reference::smoothed_along(c.mesh, c.x, c.values, times), 1e-14);
}

TEST(SurfaceMean, BackendsAgree) {
  const Crumpled c;
  expect_near(smoothed<Space>(c.mesh, c.x, c.values, 3), smoothed<OtherSpace>(c.mesh, c.x, c.values, 3),
              backend_tolerance);
}

TEST(SurfaceMean, KeepsTheIntegralAndIsSymmetricBetweenZeroAndOne) {
  const Crumpled c;
  const std::vector<double> area = reference::surface_geometry(c.mesh, c.x).area;
  const auto product = [&](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += area[i] * a[i] * b[i];
    return sum;
  };
  const std::vector<double> ones(c.x.size(), 1.0), once = smoothed(c.mesh, c.x, c.values, 1),
                                                   other = smoothed(c.mesh, c.x, c.others, 1);
  EXPECT_NEAR(product(ones, once), product(ones, c.values), 1e-13);
  EXPECT_NEAR(product(c.others, once), product(other, c.values), 1e-13);
  EXPECT_GT(product(c.values, once), 0.0);
  EXPECT_LT(product(c.values, once), product(c.values, c.values));
}

TEST(SurfaceMean, SmoothsOverHalfACellWhateverTheDistanceOfVertices) {
  // A wave of k along a flat sheet becomes its product with exp(-k^2 (h / 2)^2 / 2) far from edges.
  constexpr double h = 0.2, k = 1.0 / h;
  StaggeredGrid grid;
  grid.spacing = {h, h, h};
  for (const double radius : {3.0, 1.5, 0.75}) {
    const Mesh mesh = mesh::disk(radius, 30);
    std::vector<double> wave;
    for (const Vector& place : mesh.rest) wave.push_back(std::cos(k * place[0]));
    const int sweeps = smoothing_sweeps(mesh, grid);
    const double factor = smoothed(mesh, mesh.rest, wave, sweeps)[0] / wave[0];
    EXPECT_NEAR(factor, std::exp(-0.125), 0.05) << radius << ' ' << sweeps;
  }
}

TEST(SurfaceMean, NeedsSweepsInInverseProportionToTheArea) {
  const Mesh mesh = mesh::disk(1.0, 20);
  StaggeredGrid grid;
  grid.spacing = {10.0, 10.0, 10.0};
  const int fine = smoothing_sweeps(mesh, grid);
  grid.spacing = {5.0, 5.0, 5.0};
  EXPECT_NEAR(fine / static_cast<double>(smoothing_sweeps(mesh, grid)), 4.0, 0.01);
  grid.spacing = {0.01, 0.01, 0.01};
  EXPECT_EQ(smoothing_sweeps(mesh, grid), 1);
  EXPECT_EQ(smoothing_sweeps({}, grid), 1);
}

}  // namespace
}  // namespace drogue::coupling
