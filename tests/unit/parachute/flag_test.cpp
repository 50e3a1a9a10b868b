#include "miniapps/parachute/flags/flag.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kernels/mesh/topology.hpp"

// Meshes of flags.

namespace drogue::parachute_app {
namespace {

Flag flag_at(double x, double angle) {
  Flag flag;
  flag.leading_edge = {x, 2.0};
  flag.length = 1.5;
  flag.angle = angle;
  flag.area_density = 0.8;
  flag.bending_stiffness = 0.01;
  flag.membrane_modulus = 300.0;
  flag.edge_length = 0.26;
  flag.span = {-0.1, 0.3};
  return flag;
}

TEST(Flags, AreStripsThatSpanTheDomain) {
  fabric::Parameters sheets;
  std::vector<fabric::Vector> positions;
  const std::vector<FlagRows> rows = append_flags({flag_at(1.0, 0.0), flag_at(5.0, 30.0)}, sheets, positions);
  ASSERT_EQ(rows.size(), 2U);
  ASSERT_EQ(rows[1].begin, 14U);
  ASSERT_EQ(rows[1].end, 28U);
  ASSERT_EQ(sheets.mesh.rest.size(), 28U);
  ASSERT_EQ(sheets.mesh.triangles.size(), 24U);
  EXPECT_FALSE(mesh::find_defect(sheets.mesh));
  double area = 0.0, mass = 0.0;
  for (const auto& corners : sheets.mesh.triangles)
    area += 0.5 * std::abs(mesh::doubled_area(sheets.mesh.rest, corners)[1]);
  for (const double one : sheets.mass) mass += one;
  EXPECT_NEAR(area, 2.0 * 1.5 * 0.4, 1e-14);
  EXPECT_NEAR(mass, 0.8 * area, 1e-14);
  for (std::size_t i = 0; i < 28; ++i) {
    EXPECT_EQ(sheets.pinned[i], i % 14 < 2 ? 7 : 4);
    EXPECT_EQ(positions[i][2], i % 2 == 0 ? -0.1 : 0.3);
  }
  EXPECT_EQ(positions[5], sheets.mesh.rest[5]) << "the first one is straight along x";
  const double angle = std::numbers::pi / 6.0;
  EXPECT_NEAR(positions[27][0], 5.0 + 1.5 * std::cos(angle), 1e-14);
  EXPECT_NEAR(positions[27][1], 2.0 + 1.5 * std::sin(angle), 1e-14);
  EXPECT_EQ(sheets.material.bending_stiffness, 0.01);
  EXPECT_EQ(sheets.material.membrane_modulus, 300.0);
  EXPECT_EQ(sheets.material.poisson, 0.0);
  EXPECT_FALSE(sheets.material.tension_only);
}

TEST(Flags, WithAWidthAreSymmetricAndFreeBehindTheirLeadingEdge) {
  Flag flag = flag_at(1.0, 30.0);
  flag.width = 0.7;
  flag.middle = 0.2;
  fabric::Parameters sheets;
  std::vector<fabric::Vector> positions;
  const std::vector<FlagRows> rows = append_flags({flag, flag_at(5.0, 0.0)}, sheets, positions);
  // Six edges along, and across twice as many as half of the width needs.
  constexpr std::size_t along = 6, across = 4, vertices = (along + 1) * (across + 1);
  ASSERT_EQ(rows[0].end, vertices);
  ASSERT_EQ(rows[1].end, vertices + 14U);
  EXPECT_FALSE(mesh::find_defect(sheets.mesh));
  EXPECT_EQ(flag.vertices(), vertices);
  const std::size_t tip = vertices - 1 - across / 2;
  EXPECT_EQ(rows[0].tip, (std::array<std::size_t, 2>{tip, tip}));
  EXPECT_EQ(rows[1].tip, (std::array<std::size_t, 2>{vertices + 12, vertices + 13}));
  EXPECT_NEAR(positions[tip][0], 1.0 + 1.5 * std::cos(std::numbers::pi / 6.0), 1e-14);
  EXPECT_EQ(positions[tip][2], 0.2);
  double mass = 0.0;
  for (std::size_t i = 0; i < vertices; ++i) {
    mass += sheets.mass[i];
    EXPECT_EQ(sheets.pinned[i], i <= across ? 7 : 0) << i;
    const std::size_t mirrored = i / (across + 1) * (across + 1) + across - i % (across + 1);
    EXPECT_NEAR(positions[i][2] + positions[mirrored][2], 0.4, 1e-14);
    EXPECT_NEAR(sheets.mass[i], sheets.mass[mirrored], 1e-15) << "the diagonals are mirror images";
  }
  EXPECT_NEAR(mass, 0.8 * 1.5 * 0.7, 1e-14);
  EXPECT_EQ(positions[0][2], 0.2 - 0.35);
  EXPECT_EQ(positions[across][2], 0.2 + 0.35);
}

}  // namespace
}  // namespace drogue::parachute_app
