#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "kernels/mesh/edges.hpp"
#include "kernels/mesh/round_surfaces.hpp"
#include "kernels/mesh/topology.hpp"

// Disks, spheres, hemispheres and cylinders.

namespace drogue::mesh {
namespace {

constexpr double pi = std::numbers::pi;

struct Measures {
  double area = 0.0, volume = 0.0;  ///< m^2, and m^3 that the normals point away from
  double longest = 0.0;             ///< edge, m
  std::size_t boundary = 0;         ///< edges of one triangle
};

/// Expects that neighbours have the same orientation and that no vertex is unused.
Measures measures_of(const Mesh& mesh) {
  Measures m;
  std::map<std::pair<int, int>, int> sides;
  std::vector<bool> used(mesh.rest.size());
  const auto at = [&](int i) -> const Vector& { return mesh.rest[static_cast<std::size_t>(i)]; };
  for (const auto& corners : mesh.triangles) {
    const Vector twice = doubled_area(mesh.rest, corners);
    m.area += 0.5 * std::hypot(twice[0], twice[1], twice[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = corners[k], b = corners[(k + 1) % 3];
      m.volume += twice[k] * at(corners[0])[k] / 6.0;
      ++sides[{a, b}];
      used[static_cast<std::size_t>(a)] = true;
      m.longest =
          std::max(m.longest, std::hypot(at(a)[0] - at(b)[0], at(a)[1] - at(b)[1], at(a)[2] - at(b)[2]));
    }
  }
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1) << "neighbours of the same orientation";
    if (!sides.contains({side.second, side.first})) ++m.boundary;
  }
  for (const bool is_used : used) EXPECT_TRUE(is_used);
  return m;
}

TEST(RoundSurfaces, SpheresAreClosedAndApproachTheirVolume) {
  double area_error = 0.0, volume_error = 0.0;
  for (const int n : {1, 5, 10, 20}) {
    const Mesh mesh = sphere(0.5, n);
    EXPECT_EQ(mesh.rest.size(), static_cast<std::size_t>(10 * n * n + 2));
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(20 * n * n));
    for (const Vector& x : mesh.rest) EXPECT_NEAR(std::hypot(x[0], x[1], x[2]), 0.5, 1e-15);
    const Measures m = measures_of(mesh);
    EXPECT_EQ(m.boundary, 0U);
    EXPECT_LE(m.longest, sphere_edge * 0.5 / n);
    const double area = 1.0 - m.area / pi, volume = 1.0 - m.volume / (pi / 6.0);
    EXPECT_GT(area, 0.0);
    if (n >= 10) {
      EXPECT_NEAR(area_error / area, 4.0, 0.1);
      EXPECT_NEAR(volume_error / volume, 4.0, 0.1);
    }
    area_error = area, volume_error = volume;
  }
}

TEST(RoundSurfaces, DisksAreFlatWithTheirRimAtTheEnd) {
  const int rings = 12;
  const Mesh mesh = disk(2.0, rings);
  EXPECT_EQ(mesh.rest.size(), static_cast<std::size_t>(1 + 3 * rings * (rings + 1)));
  const Measures m = measures_of(mesh);
  EXPECT_EQ(m.boundary, static_cast<std::size_t>(6 * rings));
  EXPECT_LE(m.longest, disk_edge * 2.0 / rings);
  EXPECT_NEAR(m.area / (4.0 * pi), 1.0, 0.01);
  for (std::size_t k = mesh.rest.size() - 6 * rings; k < mesh.rest.size(); ++k)
    EXPECT_NEAR(std::hypot(mesh.rest[k][0], mesh.rest[k][1]), 2.0, 1e-15);
  for (const auto& corners : mesh.triangles) EXPECT_GT(doubled_area(mesh.rest, corners)[2], 0.0);
}

TEST(RoundSurfaces, HemispheresAreOpenBelow) {
  const int rings = 16;
  const Mesh mesh = hemisphere(2.0, rings);
  const Measures m = measures_of(mesh);
  EXPECT_EQ(m.boundary, static_cast<std::size_t>(6 * rings));
  EXPECT_LE(m.longest, hemisphere_edge * 2.0 / rings);
  EXPECT_NEAR(m.area / (8.0 * pi), 1.0, 0.005);
  EXPECT_NEAR(m.volume / (16.0 / 3.0 * pi), 1.0, 0.01);  // the normals point away from the centre
  for (const Vector& x : mesh.rest) {
    EXPECT_NEAR(std::hypot(x[0], x[1], x[2]), 2.0, 1e-15);
    EXPECT_GE(x[2], -1e-15);
  }
}

TEST(RoundSurfaces, CylindersAreOpenOrClosed) {
  const Mesh open = tube(0.5, 3.0, 60, 30);
  EXPECT_EQ(open.rest.size(), 60U * 31U);
  const Measures of_tube = measures_of(open);
  EXPECT_EQ(of_tube.boundary, 120U);
  EXPECT_NEAR(of_tube.area / (3.0 * pi), 1.0, 0.001);
  for (const auto& corners : open.triangles) {
    const Vector twice = doubled_area(open.rest, corners),
                 x = open.rest[static_cast<std::size_t>(corners[0])];
    EXPECT_GT(twice[0] * x[0] + twice[1] * x[1], 0.0);
  }
  const Mesh closed = closed_cylinder(0.5, 3.0, 10, 30);
  EXPECT_EQ(closed.rest.size(), 60U * 29U + 2U * (1U + 3U * 10U * 11U));
  const Measures of_closed = measures_of(closed);
  EXPECT_EQ(of_closed.boundary, 0U);
  EXPECT_NEAR(of_closed.area / (3.5 * pi), 1.0, 0.003);
  EXPECT_NEAR(of_closed.volume / (0.75 * pi), 1.0, 0.003);
}

}  // namespace
}  // namespace drogue::mesh
