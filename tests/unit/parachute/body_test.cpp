#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "kernels/mesh/topology.hpp"
#include "miniapps/parachute/bodies/body.hpp"

// Meshes and laws of rigid bodies.

namespace drogue::parachute_app {
namespace {

using std::numbers::pi;

Body body_of(BodyKind kind, int axis) {
  Body body;
  body.kind = kind;
  body.axis = axis;
  body.centre = {1.0, 2.0, 3.0};
  body.lengths = {0.4, 0.75};
  body.radius = 0.4;
  body.length = 1.1;
  body.edge_length = 0.05;
  return body;
}

/// Sum of the area vectors of the triangles, m^2, and of their areas.
struct Areas {
  fabric::Vector directed{};
  double sum = 0.0, outward = 0.0;  ///< m^2, and m^3: three times the volume that normals point away from
  double longest = 0.0;             ///< edge, m
};

Areas areas_of(const mesh::Mesh& mesh, const fabric::Vector& centre) {
  Areas areas;
  for (const auto& corners : mesh.triangles) {
    const fabric::Vector twice = mesh::doubled_area(mesh.rest, corners);
    areas.sum += 0.5 * std::hypot(twice[0], twice[1], twice[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = [&](std::size_t k) -> const fabric::Vector& {
        return mesh.rest[static_cast<std::size_t>(corners[k])];
      };
      areas.directed[axis] += 0.5 * twice[axis];
      areas.outward += 0.5 * twice[axis] * (at(0)[axis] - centre[axis]);
      const fabric::Vector &a = at(axis), &b = at((axis + 1) % 3);
      areas.longest = std::max(areas.longest, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    }
  }
  return areas;
}

TEST(Bodies, MeshesLieWithinTheirExtents) {
  for (const BodyKind kind :
       {BodyKind::plate, BodyKind::disk, BodyKind::sphere, BodyKind::cylinder, BodyKind::cup})
    for (int axis = 0; axis < 3; ++axis)
      for (const bool variant : {false, true}) {
        Body body = body_of(kind, axis);
        body.has_ends = body.opens_to_high = variant;
        const mesh::Mesh mesh = mesh_of(body);
        EXPECT_EQ(static_cast<double>(mesh.rest.size()), body.vertices());
        const auto extents = body.extents();
        for (std::size_t k = 0; k < 3; ++k) {
          double low = 0.0, high = 0.0;
          for (const fabric::Vector& x : mesh.rest) {
            low = std::max(low, body.centre[k] - x[k]);
            high = std::max(high, x[k] - body.centre[k]);
          }
          // Polygons and geodesic grids need not have a vertex on each axis.
          EXPECT_LE(low, extents[k][0] + 1e-12);
          EXPECT_LE(high, extents[k][1] + 1e-12);
          EXPECT_NEAR(low, extents[k][0], 0.003) << static_cast<int>(kind) << ' ' << axis << ' ' << k;
          EXPECT_NEAR(high, extents[k][1], 0.003) << static_cast<int>(kind) << ' ' << axis << ' ' << k;
        }
      }
}

TEST(Bodies, PlatesAndDisksFaceTheirAxis) {
  for (int axis = 0; axis < 3; ++axis)
    for (const BodyKind kind : {BodyKind::plate, BodyKind::disk}) {
      const Body body = body_of(kind, axis);
      const Areas areas = areas_of(mesh_of(body), body.centre);
      const double area = kind == BodyKind::plate ? 0.4 * 0.75 : 0.16 * pi;
      EXPECT_NEAR(areas.directed[static_cast<std::size_t>(axis)], areas.sum, 1e-12);
      EXPECT_NEAR(areas.sum, area, 0.01 * area);
      EXPECT_LE(areas.longest, (1.0 + 1e-12) * (kind == BodyKind::plate ? 0.05 * std::numbers::sqrt2 : 0.05));
    }
}

TEST(Bodies, ClosedBodiesHaveOutwardNormals) {
  for (int axis = 0; axis < 3; ++axis) {
    Body sphere = body_of(BodyKind::sphere, axis), cylinder = body_of(BodyKind::cylinder, axis);
    cylinder.has_ends = true;
    for (const Body& body : {sphere, cylinder}) {
      const Areas areas = areas_of(mesh_of(body), body.centre);
      for (const double sum : areas.directed) EXPECT_NEAR(sum, 0.0, 1e-12);
      const double volume =
          body.kind == BodyKind::sphere ? 4.0 / 3.0 * pi * std::pow(0.4, 3) : 0.16 * pi * 1.1;
      EXPECT_NEAR(areas.outward / 3.0, volume, 0.02 * volume);
    }
    EXPECT_LE(areas_of(mesh_of(sphere), sphere.centre).longest, 0.05);
  }
}

TEST(Bodies, RetractionShortensTheAxesByPartsOfACell) {
  constexpr fabric::Vector spacing = {0.1, 0.05, 0.08};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool has_ends : {false, true}) {
      Body sphere = body_of(BodyKind::sphere, axis), cylinder = body_of(BodyKind::cylinder, axis),
           cup = body_of(BodyKind::cup, axis);
      cylinder.has_ends = cup.opens_to_high = has_ends;
      for (Body body : {sphere, cylinder, cup}) {
        const mesh::Mesh whole = mesh_of(body);
        body.retraction = 0.3;
        body.spacing = spacing;
        const mesh::Mesh mesh = mesh_of(body);
        ASSERT_EQ(mesh.rest.size(), whole.rest.size());
        EXPECT_EQ(mesh.triangles, whole.triangles);
        for (std::size_t k = 0; k < 3; ++k) {
          const bool along = body.kind == BodyKind::cylinder && static_cast<int>(k) == axis;
          const double half = along ? 0.55 : 0.4, retreat = along && !has_ends ? 0.0 : 0.3 * spacing[k];
          for (std::size_t i = 0; i < mesh.rest.size(); ++i)
            ASSERT_NEAR(mesh.rest[i][k] - body.centre[k],
                        (whole.rest[i][k] - body.centre[k]) * (half - retreat) / half, 1e-14);
        }
      }
    }
}

TEST(Bodies, CupsOpenToTheGivenSide) {
  for (int axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true}) {
      Body cup = body_of(BodyKind::cup, axis);
      cup.opens_to_high = high;
      const Areas areas = areas_of(mesh_of(cup), cup.centre);
      // The normals point away from the centre, so the sum of their areas points away from the opening.
      EXPECT_NEAR(areas.directed[static_cast<std::size_t>(axis)], (high ? -1.0 : 1.0) * 0.16 * pi, 0.005);
      EXPECT_GT(areas.outward, 0.0);
      EXPECT_LE(areas.longest, 0.05);
    }
}

TEST(Bodies, SeveralBodiesAreOneMeshInTheirOrder) {
  Body first, second;
  first.lengths = second.lengths = {1.0, 1.0};
  first.edge_length = 0.5, second.edge_length = 0.25;
  second.centre = {7.0, 0.0, 0.0};
  second.motion = {"0.1*sin(t)", "", "2"};
  const fabric::Parameters sheets = make_sheets({first, second});
  EXPECT_EQ(vertices_of({first, second}), 9U + 25U);
  ASSERT_EQ(sheets.mesh.rest.size(), 34U);
  EXPECT_EQ(sheets.mesh.rest[8][0], 0.0);
  EXPECT_EQ(sheets.mesh.rest[9][0], 7.0);
  for (const std::uint8_t axes : sheets.pinned) EXPECT_EQ(axes, 7);
  ASSERT_EQ(sheets.motions.size(), 2U);
  EXPECT_EQ(sheets.motions[1].axis, 2);
  EXPECT_EQ(sheets.motions[1].vertices.size(), 25U);
  EXPECT_EQ(sheets.motions[1].vertices.front(), 9);
  EXPECT_FALSE(first.moves());
  EXPECT_TRUE(second.moves());
}

TEST(Bodies, PlatesOnSpringsShareMassAndStiffnessByArea) {
  Body first, second;
  first.lengths = second.lengths = {1.0, 1.0};
  first.edge_length = second.edge_length = 0.5;
  second.axis = 1;
  second.centre = {7.0, 2.0, 0.0};
  second.mount = Mount{3.0, 50.0, 0.125};
  const fabric::Parameters sheets = make_sheets({first, second});
  ASSERT_EQ(sheets.mesh.rest.size(), 9U + 9U + 9U);
  ASSERT_EQ(sheets.mesh.lines.size(), 9U);
  double mass = 0.0, stiffness = 0.0;
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_EQ(sheets.pinned[k], 7);
    EXPECT_EQ(sheets.pinned[9 + k], 5) << "free along y";
    EXPECT_EQ(sheets.pinned[18 + k], 7);
    EXPECT_EQ(sheets.mesh.lines[k], (std::array<int, 2>{9 + static_cast<int>(k), 18 + static_cast<int>(k)}));
    EXPECT_EQ(sheets.mesh.rest[9 + k][0], sheets.mesh.rest[18 + k][0]);
    EXPECT_EQ(sheets.mesh.rest[9 + k][2], sheets.mesh.rest[18 + k][2]);
    mass += sheets.mass[9 + k];
    stiffness += sheets.mesh.line_stiffness[k] / (sheets.mesh.rest[9 + k][1] - sheets.mesh.rest[18 + k][1]);
    EXPECT_NEAR(sheets.mesh.line_stiffness[k] / sheets.mass[9 + k],
                sheets.mesh.line_stiffness[0] / sheets.mass[9], 1e-9);
  }
  EXPECT_NEAR(mass, 3.0, 1e-14);
  EXPECT_NEAR(stiffness, 50.0, 1e-12);
  std::vector<fabric::Vector> positions = sheets.mesh.rest;
  set_offsets({first, second}, positions);
  EXPECT_EQ(positions[8], sheets.mesh.rest[8]);
  EXPECT_EQ(positions[9][1], 2.125);
  EXPECT_EQ(positions[18], sheets.mesh.rest[18]) << "the end of a spring stays";
}

TEST(Bodies, FlatSheetsSlipByDefault) {
  EXPECT_FALSE(body_of(BodyKind::sphere, 0).slips());
  EXPECT_FALSE(body_of(BodyKind::cylinder, 0).slips());
  EXPECT_FALSE(body_of(BodyKind::cup, 0).slips());
  EXPECT_TRUE(body_of(BodyKind::disk, 0).slips());
  Body plate = body_of(BodyKind::plate, 0);
  EXPECT_TRUE(plate.slips());
  plate.slip = false;
  EXPECT_FALSE(plate.slips());
}

TEST(Bodies, PorosityLawsGiveAlphaAndBeta) {
  Porosity p;
  EXPECT_TRUE(law_of(p, 1.2, 1.8e-5).impermeable);
  p.law = PorosityLaw::kim_peskin;
  p.pores = 2e6, p.conductance = 4e-9;
  EXPECT_DOUBLE_EQ(law_of(p, 1.2, 1.8e-5).alpha, 125.0);
  EXPECT_EQ(law_of(p, 1.2, 1.8e-5).beta, 0.0);
  p.law = PorosityLaw::ergun;
  p.void_fraction = 0.5, p.thickness = 1e-3, p.grain = 1e-4;
  // 150 mu (1 - e)^2 / e^3 L / d^2 and 1.75 rho (1 - e) / e^3 L / d
  EXPECT_NEAR(law_of(p, 1.2, 1.8e-5).alpha, 150.0 * 1.8e-5 * 2.0 * 1e5, 1e-9);
  EXPECT_NEAR(law_of(p, 1.2, 1.8e-5).beta, 1.75 * 1.2 * 4.0 * 10.0, 1e-9);
}

}  // namespace
}  // namespace drogue::parachute_app
