#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "kernels/mesh/edges.hpp"
#include "kernels/mesh/topology.hpp"
#include "kernels/reference/fabric/frequency.hpp"
#include "kernels/reference/fabric/intersections.hpp"
#include "kernels/reference/fabric/membrane.hpp"
#include "miniapps/parachute/canopy/canopy.hpp"
#include "miniapps/parachute/canopy/stiffness.hpp"

// Meshes of canopies: cloth, lines and payload.

namespace drogue::parachute_app {
namespace {

using fabric::Vector;
using std::numbers::pi;

Canopy c9(double edge_length) {
  Canopy canopy;
  canopy.edge_length = edge_length;
  return canopy;
}

double distance_of(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double area_at(const std::vector<Vector>& points, const std::vector<std::array<int, 3>>& triangles) {
  double sum = 0.0;
  for (const auto& triangle : triangles) {
    const Vector twice = mesh::doubled_area(points, triangle);
    sum += 0.5 * std::hypot(twice[0], twice[1], twice[2]);
  }
  return sum;
}

TEST(Canopy, MeshIsSoundWithAndWithoutVent) {
  for (const double vent : {0.457, 0.0, 3.0})
    for (const int gores : {3, 7, 28, 29, 30})
      for (const double edge_length : {0.5, 0.28, 0.1}) {
        Canopy canopy = c9(edge_length);
        canopy.vent = vent;
        canopy.gores = gores;
        const CanopyMesh mesh = make_canopy(canopy);
        const fabric::Mesh& cloth = mesh.fabric.mesh;
        EXPECT_EQ(mesh.positions.size(), canopy.vertices());
        EXPECT_EQ(mesh.cloth_vertices + 1, canopy.vertices());
        EXPECT_FALSE(mesh::find_defect(cloth));
        EXPECT_FALSE(mesh::inconsistent_triangles(cloth));
        const auto edges = static_cast<long>(mesh::triangle_edges(cloth).size());
        const long euler =
            static_cast<long>(mesh.cloth_vertices) - edges + static_cast<long>(cloth.triangles.size());
        EXPECT_EQ(euler, vent > 0.0 ? 0 : 1) << "an annulus or a disk";
        // Polygons of at most `edge_length` per side inside of the circles.
        const double exact = 0.25 * pi * (canopy.diameter * canopy.diameter - vent * vent);
        EXPECT_NEAR(area_at(cloth.rest, cloth.triangles) / exact, 1.0, 0.5 * edge_length * edge_length);
        for (const auto& [a, b] : mesh::triangle_edges(cloth))
          EXPECT_LE(mesh::rest_distance(cloth, a, b), std::numbers::sqrt3 * edge_length);
      }
}

TEST(Canopy, NumbersOfVerticesOfRingsAreNestedAndBoundTheEdges) {
  for (const int gores : {28, 30, 120}) {
    Canopy canopy = c9(0.2);
    canopy.gores = gores;
    const std::vector<int> sizes = ring_sizes(canopy);
    EXPECT_EQ(sizes.back() % gores, 0);
    for (std::size_t k = 0; k + 1 < sizes.size(); ++k) {
      const int own = std::min(sizes[k], gores), next = std::min(sizes[k + 1], gores);
      EXPECT_EQ(next % own, 0) << "ring " << k;
      EXPECT_TRUE(sizes[k] < gores || sizes[k] % gores == 0);
    }
    EXPECT_LT(sizes.front(), gores) << "28 edges would be far shorter than needed at the vent";
  }
}

TEST(Canopy, PrimeNumbersOfGoresLeaveNoShortEdgesAtTheVent) {
  for (const int gores : {29, 31, 997}) {
    Canopy canopy = c9(0.2);
    canopy.gores = gores;
    canopy.reinforcement.seams = 1000.0;
    const std::vector<int> sizes = ring_sizes(canopy);
    EXPECT_EQ(sizes.back() % gores, 0) << "every line has a vertex";
    for (std::size_t k = 0; k + 1 < sizes.size(); ++k) {
      const double radius =
          0.2285 + (4.267 - 0.2285) * static_cast<double>(k) / static_cast<double>(sizes.size() - 1);
      EXPECT_LE(2.0 * pi * radius / sizes[k], 0.2 * (1.0 + 1e-9));
      EXPECT_GE(2.0 * pi * radius / std::max(sizes[k], 4), 0.2 / 3.01) << gores << " gores, ring " << k;
    }
    const CanopyMesh mesh = make_canopy(canopy);
    EXPECT_FALSE(mesh::find_defect(mesh.fabric.mesh));
    EXPECT_FALSE(mesh::inconsistent_triangles(mesh.fabric.mesh));
    const auto edges = mesh::triangle_edges(mesh.fabric.mesh);
    const std::set<mesh::Edge> known(edges.begin(), edges.end());
    for (const auto& [a, b] : mesh.fabric.mesh.lines)
      if (b != static_cast<int>(mesh.cloth_vertices)) {
        EXPECT_TRUE(known.contains(mesh::edge_between(a, b)));
      }
  }
}

/// A T-10.
Canopy t10(double edge_length) {
  Canopy canopy = c9(edge_length);
  canopy.kind = CanopyKind::extended_skirt;
  canopy.diameter = 9.144;
  canopy.gores = 30;
  canopy.vent = 0.508;
  canopy.skirt = {0.9144, 7.468};
  canopy.lines.length = 7.77;
  return canopy;
}

TEST(Canopy, ConicalSkirtsHaveTheirConstructedShape) {
  for (const double diameter : {7.468, 9.144, 10.0}) {
    Canopy canopy = t10(0.25);
    canopy.skirt.diameter = diameter;
    canopy.centre = {1.0, 2.0, 3.0};
    const CanopyMesh mesh = make_canopy(canopy);
    const fabric::Mesh& cloth = mesh.fabric.mesh;
    EXPECT_EQ(mesh.positions.size(), canopy.vertices());
    EXPECT_FALSE(mesh::find_defect(cloth));
    EXPECT_FALSE(mesh::inconsistent_triangles(cloth));
    for (const auto& [a, b] : mesh::triangle_edges(cloth))
      EXPECT_LE(mesh::rest_distance(cloth, a, b), std::numbers::sqrt3 * 0.25);
    // A disk and a frustum of a cone.
    const double disk = 0.25 * pi * 9.144 * 9.144, vent = 0.25 * pi * 0.508 * 0.508;
    const double whole = disk + 0.5 * pi * (9.144 + diameter) * 0.9144;
    EXPECT_NEAR(canopy.nominal_area(), whole, 1e-9);
    EXPECT_NEAR(area_at(cloth.rest, cloth.triangles) / (whole - vent), 1.0, 0.01);
    const double inwards = 0.5 * (9.144 - diameter);
    const double height = std::sqrt(0.9144 * 0.9144 - inwards * inwards);
    EXPECT_NEAR(cloth.rest.front()[2] - 3.0, height, 1e-12);
    ASSERT_EQ(mesh.skirt.size(), 30U);
    for (const int i : mesh.skirt) {
      const Vector& x = cloth.rest[static_cast<std::size_t>(i)];
      EXPECT_NEAR(std::hypot(x[0] - 1.0, x[1] - 2.0), 0.5 * diameter, 1e-12);
      EXPECT_NEAR(x[2], 3.0, 1e-12);
      EXPECT_NEAR(distance_of(x, cloth.rest.back()), 7.77, 1e-12) << "lines are straight";
    }
  }
  // The published nominal diameter of 35 ft follows from a flat diameter of 30 ft and a skirt of 3 ft.
  EXPECT_NEAR(std::sqrt(4.0 / pi * t10(0.25).nominal_area()) / 0.3048, 35.0, 0.1);
}

TEST(Canopy, TrianglesFaceAlongTheAxis) {
  for (const auto& [shape, angle] : {std::pair{CanopyShape::flat, 0.0},
                                     {CanopyShape::angled_15, 15.0},
                                     {CanopyShape::angled_60, 60.0},
                                     {CanopyShape::angled_75, 75.0}}) {
    Canopy canopy = c9(0.5);
    canopy.shape = shape;
    canopy.centre = {1.0, 2.0, 3.0};
    EXPECT_EQ(canopy.axis_angle(), angle);
    const Vector axis = {std::sin(angle * pi / 180.0), 0.0, std::cos(angle * pi / 180.0)};
    const CanopyMesh mesh = make_canopy(canopy);
    for (const auto& triangle : mesh.fabric.mesh.triangles) {
      const Vector twice = mesh::doubled_area(mesh.positions, triangle);
      const double along = twice[0] * axis[0] + twice[1] * axis[1] + twice[2] * axis[2];
      EXPECT_NEAR(along, std::hypot(twice[0], twice[1], twice[2]), 1e-14);
    }
    // The payload hangs against the axis.
    const double depth = std::sqrt(7.0 * 7.0 - 4.267 * 4.267);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(mesh.positions.back()[k], canopy.centre[k] - depth * axis[k], 1e-12);
  }
}

TEST(Canopy, LinesAreTautAtTheirLengthInAllShapes) {
  for (const CanopyShape shape : {CanopyShape::flat, CanopyShape::partly_closed, CanopyShape::angled_60}) {
    Canopy canopy = c9(0.3);
    canopy.shape = shape;
    const CanopyMesh mesh = make_canopy(canopy);
    ASSERT_EQ(mesh.skirt.size(), 28U);
    ASSERT_EQ(mesh.fabric.mesh.lines.size(), 28U);
    std::set<int> attached;
    for (const auto& [skirt, payload] : mesh.fabric.mesh.lines) {
      EXPECT_EQ(payload, static_cast<int>(mesh.cloth_vertices));
      attached.insert(skirt);
      const auto a = static_cast<std::size_t>(skirt), b = static_cast<std::size_t>(payload);
      EXPECT_NEAR(distance_of(mesh.fabric.mesh.rest[a], mesh.fabric.mesh.rest[b]), 7.0, 1e-12);
      EXPECT_NEAR(distance_of(mesh.positions[a], mesh.positions[b]), 7.0, 1e-12);
    }
    EXPECT_EQ(attached, std::set<int>(mesh.skirt.begin(), mesh.skirt.end()));
    for (std::size_t k = 0; k < 28; ++k)  // equally spaced
      EXPECT_NEAR(distance_of(mesh.fabric.mesh.rest[static_cast<std::size_t>(mesh.skirt[k])],
                              mesh.fabric.mesh.rest[static_cast<std::size_t>(mesh.skirt[(k + 1) % 28])]),
                  canopy.diameter * std::sin(pi / 28), 1e-12);
  }
}

TEST(Canopy, PleatedConeIsIsometricWithinItsPleats) {
  for (const double closure : {0.3, 0.5, 0.9, 1.0}) {
    Canopy canopy = c9(0.2);
    canopy.shape = CanopyShape::partly_closed;
    canopy.closure = closure;
    canopy.centre = {0.5, -1.0, 2.0};
    const CanopyMesh mesh = make_canopy(canopy);
    const fabric::Mesh& cloth = mesh.fabric.mesh;
    double shortest = 1.0;
    for (const auto& [a, b] : mesh::triangle_edges(cloth)) {
      const double ratio = distance_of(mesh.positions[static_cast<std::size_t>(a)],
                                       mesh.positions[static_cast<std::size_t>(b)]) /
                           mesh::rest_distance(cloth, a, b);
      EXPECT_LE(ratio, 1.0 + 1e-12) << "no edge is stretched at the start";
      shortest = std::min(shortest, ratio);
    }
    // Edges that cross folds, near the vent, are shorter than along the cloth.
    EXPECT_GT(shortest, closure - 0.1);
    for (const int i : mesh.skirt) {
      const Vector& x = mesh.positions[static_cast<std::size_t>(i)];
      EXPECT_NEAR(std::hypot(x[0] - 0.5, x[1] + 1.0), 4.267 * closure, 1e-12);
      EXPECT_NEAR(x[2], 2.0, 1e-12);
    }
    // Meridians keep their length but near the vent, where the mesh is coarser than the pleats.
    const Vector& vent = mesh.positions.front();
    const double height = (4.267 - 0.2285) * std::sqrt(1.0 - closure * closure);
    EXPECT_LE(vent[2] - 2.0, height + 1e-12);
    EXPECT_GE(vent[2] - 2.0, height - 0.03);
  }
  // With an even number of edges per gore, each fold has vertices and no edge crosses it.
  Canopy canopy = c9(0.12);
  canopy.shape = CanopyShape::partly_closed;
  canopy.vent = 7.6;
  const CanopyMesh mesh = make_canopy(canopy);
  ASSERT_EQ(ring_sizes(canopy), std::vector<int>(5, 28 * 8));
  for (const auto& [a, b] : mesh::triangle_edges(mesh.fabric.mesh))
    EXPECT_NEAR(
        distance_of(mesh.positions[static_cast<std::size_t>(a)], mesh.positions[static_cast<std::size_t>(b)]),
        mesh::rest_distance(mesh.fabric.mesh, a, b), 1e-12);
}

TEST(Canopy, PleatedConeStartsWithoutElasticEnergy) {
  for (const double closure : {0.125, 0.25, 0.5, 0.95})
    for (const double edge_length : {0.28, 0.42, 0.7})
      for (const double vent : {0.0, 0.457})
        for (const int gores : {28, 29}) {
          Canopy canopy = c9(edge_length);
          canopy.shape = CanopyShape::partly_closed;
          canopy.closure = closure, canopy.vent = vent, canopy.gores = gores;
          canopy.reinforcement = {5000.0, 5000.0, vent > 0.0 ? 5000.0 : 0.0};
          const Sheets sheets = make_all_sheets({}, {canopy}, 1.225, 1.8e-5);
          const fabric::Parameters& p = sheets.fabric;
          const double energy = reference::energy(p.material, p.mesh, sheets.positions);
          // 1 % of strain in all of the 57 m^2 has 57 J.
          EXPECT_LT(energy, closure > 0.25 ? 0.3 : 0.004) << closure << ", " << edge_length << ", " << gores;
        }
  // Nearly closed, as before a reefing line is cut.
  Canopy reefed = c9(0.42);
  reefed.shape = CanopyShape::partly_closed, reefed.closure = 0.25;
  const Sheets sheets = make_all_sheets({}, {reefed}, 1.225, 1.8e-5);
  EXPECT_LT(reference::energy(sheets.fabric.material, sheets.fabric.mesh, sheets.positions), 1e-3);
  EXPECT_TRUE(reference::intersections(sheets.positions, sheets.fabric.mesh.triangles, {}).empty());
}

TEST(Canopy, MassIsThatOfClothLinesAndPayload) {
  Canopy canopy = c9(0.28);
  canopy.lines.line_density = 0.0066;
  const CanopyMesh mesh = make_canopy(canopy);
  const double cloth = 0.0373 * area_at(mesh.fabric.mesh.rest, mesh.fabric.mesh.triangles);
  const double total = std::accumulate(mesh.fabric.mass.begin(), mesh.fabric.mass.end(), 0.0);
  EXPECT_NEAR(total, cloth + 28 * 7.0 * 0.0066 + 100.0, 1e-9);
  EXPECT_NEAR(cloth, 2.1, 0.05) << "a C-9 weighs 2.1 kg";
  EXPECT_NEAR(mesh.fabric.mass.back(), 100.0 + 14 * 7.0 * 0.0066, 1e-12);
}

TEST(Canopy, FixedPayloadIsTheOnlyPinnedVertex) {
  Canopy canopy = c9(0.5);
  EXPECT_EQ(make_canopy(canopy).fabric.pinned.back(), 0);
  canopy.payload.fixed = true;
  const CanopyMesh mesh = make_canopy(canopy);
  EXPECT_EQ(mesh.fabric.pinned.back(), 7);
  EXPECT_EQ(std::accumulate(mesh.fabric.pinned.begin(), mesh.fabric.pinned.end(), 0), 7);
}

TEST(Canopy, GuidedPayloadMovesAlongZAlone) {
  Canopy canopy = c9(0.5);
  canopy.payload.guided = true;
  const CanopyMesh mesh = make_canopy(canopy);
  EXPECT_EQ(mesh.fabric.pinned.back(), 1 + 2) << "x and y";
  EXPECT_EQ(std::accumulate(mesh.fabric.pinned.begin(), mesh.fabric.pinned.end(), 0), 3);
}

TEST(Canopy, VentLinesCrossInTheMiddleOfTheVent) {
  for (const double edge_length : {0.5, 0.1, 0.02}) {
    Canopy canopy = c9(edge_length);
    const std::vector<double> bare_masses = make_canopy(canopy).fabric.mass;
    const double bare = std::accumulate(bare_masses.begin(), bare_masses.end(), 0.0);
    canopy.vent_lines = VentLines{5000.0, 0.01};
    canopy.centre = {1.0, 2.0, 3.0};
    canopy.angle = 30.0;
    const CanopyMesh mesh = make_canopy(canopy);
    EXPECT_EQ(mesh.positions.size(), canopy.vertices());
    EXPECT_FALSE(mesh::find_defect(mesh.fabric.mesh));
    const auto crossing = static_cast<int>(mesh.cloth_vertices);
    const int ring = ring_sizes(canopy).front(), per_seam = std::max(1, ring / 28);
    const auto seams = static_cast<std::size_t>(ring / per_seam);
    EXPECT_LE(seams, 28U);
    EXPECT_EQ(edge_length<0.05, per_seam> 1) << "the finest mesh has vertices between the seams";
    ASSERT_EQ(mesh.vent_lines.size(), seams);
    double stiffness = 0.0;
    for (std::size_t k = 0; k < seams; ++k) {
      const auto seam = k * static_cast<std::size_t>(per_seam);
      const auto line = static_cast<std::size_t>(mesh.vent_lines[k]);
      EXPECT_EQ(mesh.fabric.mesh.lines[line], (std::array{static_cast<int>(seam), crossing}));
      EXPECT_NEAR(mesh::rest_length(mesh.fabric.mesh, line), 0.5 * 0.457, 1e-12);
      EXPECT_NEAR(distance_of(mesh.positions[seam], mesh.positions[mesh.cloth_vertices]), 0.5 * 0.457, 1e-12);
      stiffness += mesh.fabric.mesh.line_stiffness[line];
    }
    EXPECT_NEAR(stiffness, 28 * 5000.0, 1e-8) << "as many half lines as gores";
    const double total = std::accumulate(mesh.fabric.mass.begin(), mesh.fabric.mass.end(), 0.0);
    EXPECT_NEAR(total - bare, 14 * 0.457 * 0.01, 1e-12) << "14 lines across the vent";
    EXPECT_NEAR(mesh.fabric.mass[mesh.cloth_vertices], 7 * 0.457 * 0.01, 1e-15);
    for (const int k : mesh.suspension)
      EXPECT_EQ(mesh.fabric.mesh.lines[static_cast<std::size_t>(k)][1], crossing + 1) << "the payload";
  }
}

TEST(Canopy, VentLinesAreSlackInAPleatedCone) {
  for (const double closure : {0.12, 0.25, 0.5, 0.9}) {
    Canopy canopy = c9(0.14);
    canopy.shape = CanopyShape::partly_closed;
    canopy.closure = closure;
    canopy.vent_lines = VentLines{};
    const CanopyMesh mesh = make_canopy(canopy);
    for (const int k : mesh.vent_lines) {
      const auto& [edge, crossing] = mesh.fabric.mesh.lines[static_cast<std::size_t>(k)];
      EXPECT_LE(distance_of(mesh.positions[static_cast<std::size_t>(edge)],
                            mesh.positions[static_cast<std::size_t>(crossing)]),
                0.5 * 0.457 * std::min(1.0, closure + 0.12));
    }
  }
}

TEST(Canopy, VerticesBeyondTheClothAreNamed) {
  Canopy canopy = c9(0.5);
  canopy.vent_lines = VentLines{};
  canopy.riser = Riser{3.0, 2e5, 0.5};
  const Sheets sheets = make_all_sheets({}, {canopy}, 1.225, 1.8e-5);
  const CanopyRows& rows = sheets.canopies.front();
  ASSERT_EQ(rows.end, rows.cloth_end + 3);
  EXPECT_STREQ(rows.part_of(rows.cloth_end - 1), "cloth");
  EXPECT_STREQ(rows.part_of(rows.cloth_end), "vent lines");
  EXPECT_STREQ(rows.part_of(rows.cloth_end + 1), "riser");
  EXPECT_STREQ(rows.part_of(rows.end - 1), "payload");
}

TEST(Canopy, ReinforcementFollowsEdgesOfTheCloth) {
  Canopy canopy = c9(0.1);
  canopy.reinforcement = {1000.0, 2000.0, 3000.0};
  const CanopyMesh mesh = make_canopy(canopy);
  const fabric::Mesh& cloth = mesh.fabric.mesh;
  const auto edges = mesh::triangle_edges(cloth);
  const std::set<mesh::Edge> known(edges.begin(), edges.end());
  double length[3] = {};
  for (std::size_t k = 0; k < cloth.lines.size(); ++k) {
    const auto& [a, b] = cloth.lines[k];
    if (b == static_cast<int>(mesh.cloth_vertices)) {
      EXPECT_EQ(cloth.line_stiffness[k], canopy.lines.stiffness);
      continue;
    }
    EXPECT_TRUE(known.contains(mesh::edge_between(a, b)));
    const int band = static_cast<int>(cloth.line_stiffness[k] / 1000.0) - 1;
    ASSERT_TRUE(band >= 0 && band < 3);
    length[band] += mesh::rest_distance(cloth, a, b);
  }
  EXPECT_NEAR(length[1], pi * canopy.diameter, 1e-2);
  EXPECT_NEAR(length[2], pi * canopy.vent, 2e-2);
  const double seams = length[0] / (0.5 * (canopy.diameter - canopy.vent));
  EXPECT_GT(seams, 27.0);  // all of them but for a short way near the vent
  EXPECT_LE(seams, 28.0 + 1e-9);
  EXPECT_FALSE(mesh::find_defect(cloth));
}

TEST(Canopy, SheetHasNeitherLinesNorPayload) {
  Canopy canopy = c9(0.3);
  canopy.kind = CanopyKind::sheet;
  canopy.vent = 0.0;
  const Sheets sheets = make_all_sheets({}, {canopy}, 1.225, 1.8e-5);
  EXPECT_EQ(sheets.positions.size(), canopy.vertices());
  EXPECT_EQ(sheets.canopies[0].cloth_end, canopy.vertices());
  EXPECT_FALSE(sheets.canopies[0].payload);
  EXPECT_TRUE(sheets.fabric.mesh.lines.empty());
  EXPECT_EQ(std::accumulate(sheets.fabric.pinned.begin(), sheets.fabric.pinned.end(), 0), 0);
}

TEST(Canopy, DrumHasItsTensionAndAFixedRim) {
  Canopy drum = c9(0.1);
  drum.kind = CanopyKind::drum;
  drum.diameter = 2.0, drum.vent = 0.0, drum.gores = 6;
  drum.centre = {1.0, 2.0, 3.0};
  drum.area_density = 0.25, drum.membrane_modulus = 2000.0, drum.tension = 100.0, drum.deflection = 0.01;
  // St Venant-Kirchhoff: E / (1 - nu) times the Green strain (l^2 - 1) / 2, the Cauchy stress of equal
  // stretches.
  EXPECT_NEAR(2000.0 / 0.7 * 0.5 * (drum.stretch() * drum.stretch() - 1.0), 100.0, 1e-10);
  const CanopyMesh mesh = make_canopy(drum);
  EXPECT_TRUE(mesh.fabric.mesh.lines.empty());
  ASSERT_EQ(mesh.positions.size(), drum.vertices());
  EXPECT_NEAR(mesh.positions[0][2], 3.01, 1e-15) << "the centre, where J0 is 1";
  double mass = 0.0;
  int fixed = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const fabric::Vector &at = mesh.positions[i], &rest = mesh.fabric.mesh.rest[i];
    const double radius = std::hypot(at[0] - 1.0, at[1] - 2.0);
    EXPECT_NEAR(radius, drum.stretch() * std::hypot(rest[0] - 1.0, rest[1] - 2.0), 1e-14);
    EXPECT_EQ(rest[2], 3.0);
    EXPECT_LE(std::abs(at[2] - 3.0 - 0.01 * std::cyl_bessel_j(0.0, 2.4048255577 * radius)), 1e-12);
    EXPECT_EQ(mesh.fabric.pinned[i], radius > 0.999 ? 7 : 0);
    fixed += mesh.fabric.pinned[i] / 7;
    mass += mesh.fabric.mass[i];
  }
  EXPECT_GE(fixed, 62);
  EXPECT_NEAR(mass, 0.25 * pi, 2e-3);
}

TEST(Canopy, ReefingLineClosesARingOfItsLength) {
  Canopy canopy = c9(0.2);
  canopy.shape = CanopyShape::partly_closed;
  canopy.reefing = ReefingLine{14.0, 5000.0, 1.5};
  const Sheets sheets = make_all_sheets({}, {canopy, canopy}, 1.225, 1.8e-5);
  const fabric::Mesh& mesh = sheets.fabric.mesh;
  for (const CanopyRows& rows : sheets.canopies) {
    ASSERT_EQ(rows.reefing.size(), 28U);
    double length = 0.0;
    for (std::size_t k = 0; k < 28; ++k) {
      const auto line = static_cast<std::size_t>(rows.reefing[k]),
                 next = static_cast<std::size_t>(rows.reefing[(k + 1) % 28]);
      length += mesh::rest_length(mesh, line);
      EXPECT_EQ(mesh.line_stiffness[line], 5000.0);
      EXPECT_EQ(mesh.lines[line][1], mesh.lines[next][0]);
      const auto i = static_cast<std::size_t>(mesh.lines[line][0]);
      EXPECT_NEAR(std::hypot(sheets.positions[i][0], sheets.positions[i][1]), 0.5 * 4.267, 1e-12);
    }
    EXPECT_NEAR(length, 14.0, 1e-12);
    for (const int line : rows.suspension)
      EXPECT_NEAR(mesh::rest_length(mesh, static_cast<std::size_t>(line)), 7.0, 1e-12);
  }
  ASSERT_EQ(sheets.cuts.size(), 2U);
  EXPECT_EQ(sheets.cuts[1].time, 1.5);
  EXPECT_EQ(sheets.cuts[1].lines, sheets.canopies[1].reefing);
}

TEST(Canopy, RisersLeadToASharedPayload) {
  std::vector<Canopy> canopies(3, c9(0.4));
  for (std::size_t k = 0; k < 3; ++k) {
    Canopy& canopy = canopies[k];
    canopy.shape = CanopyShape::partly_closed;
    canopy.angle = 20.0;
    canopy.azimuth = 120.0 * static_cast<double>(k);
    canopy.riser = Riser{3.0, 2e5, 0.5};
    canopy.lines.line_density = 0.01;
    canopy.payload.mass = 300.0;
    canopy.payload.release = 2.0;
    if (k > 0) canopy.payload.shared = 0;
  }
  canopies[0].centre = {3.0, -1.0, 5.0};
  place_at_shared_payloads(canopies);
  const Sheets sheets = make_all_sheets({}, canopies, 1.225, 1.8e-5);
  const fabric::Mesh& mesh = sheets.fabric.mesh;
  ASSERT_EQ(sheets.positions.size(),
            canopies[0].vertices() + canopies[1].vertices() + canopies[2].vertices());
  EXPECT_EQ(canopies[0].vertices(), canopies[1].vertices() + 1);
  const std::size_t payload = sheets.canopies[0].payload.value();
  Vector sum{};
  for (const CanopyRows& rows : sheets.canopies) {
    EXPECT_EQ(rows.payload, payload);
    ASSERT_TRUE(rows.riser);
    const auto riser = static_cast<std::size_t>(*rows.riser);
    EXPECT_EQ(mesh.lines[riser][1], static_cast<int>(payload));
    const auto meeting = static_cast<std::size_t>(mesh.lines[riser][0]);
    EXPECT_EQ(meeting, rows.cloth_end);
    EXPECT_NEAR(mesh::rest_length(mesh, riser), 3.0, 1e-12);
    EXPECT_NEAR(distance_of(sheets.positions[meeting], sheets.positions[payload]), 3.0, 1e-12);
    EXPECT_NEAR(sheets.fabric.mass[meeting], 0.5 + 28 * 3.5 * 0.01, 1e-12);
    for (const int k : rows.suspension) {
      const auto& [skirt, end] = mesh.lines[static_cast<std::size_t>(k)];
      EXPECT_EQ(end, static_cast<int>(meeting));
      EXPECT_NEAR(distance_of(sheets.positions[static_cast<std::size_t>(skirt)], sheets.positions[meeting]),
                  7.0, 1e-12);
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum[axis] += sheets.positions[meeting][axis] - sheets.positions[payload][axis];
  }
  // Three axes 20 degrees from z, 120 degrees apart.
  EXPECT_NEAR(sum[0], 0.0, 1e-12);
  EXPECT_NEAR(sum[1], 0.0, 1e-12);
  EXPECT_NEAR(sum[2], 9.0 * std::cos(20.0 * pi / 180.0), 1e-12);
  EXPECT_EQ(sheets.fabric.mass[payload], 300.0);
  ASSERT_EQ(sheets.cuts.size(), 3U);
  EXPECT_EQ(sheets.cuts[2].lines, std::vector<int>{*sheets.canopies[2].riser});
}

TEST(Canopy, SheetsOfASceneAreOneMeshInTheirOrder) {
  Body plate;
  plate.lengths = {1.0, 1.0};
  plate.edge_length = 0.5;
  Canopy first = c9(0.5), second = c9(0.6);
  second.centre = {20.0, 0.0, 0.0};
  second.porosity = {PorosityLaw::none, 0.0, 0.0};
  const Sheets sheets = make_all_sheets({plate}, {first, second}, 1.225, 1.8e-5);
  ASSERT_EQ(sheets.canopies.size(), 2U);
  EXPECT_EQ(sheets.canopies[0].begin, 9U);
  EXPECT_EQ(sheets.canopies[0].payload, 9 + first.vertices() - 1);
  EXPECT_EQ(sheets.canopies[1].begin, 9 + first.vertices());
  const std::size_t vertices = 9 + first.vertices() + second.vertices();
  const fabric::Parameters& p = sheets.fabric;
  for (const std::size_t size :
       {p.mesh.rest.size(), p.mass.size(), p.pinned.size(), sheets.positions.size(), sheets.laws.size()})
    EXPECT_EQ(size, vertices);
  EXPECT_EQ(p.mesh.line_stiffness.size(), p.mesh.lines.size());
  EXPECT_FALSE(mesh::find_defect(p.mesh));
  EXPECT_FALSE(mesh::inconsistent_triangles(p.mesh));
  EXPECT_FALSE(sheets.laws[9].impermeable);
  EXPECT_TRUE(sheets.laws.back().impermeable);
  EXPECT_EQ(sheets.canopies[0].triangles_begin, 8U);
  EXPECT_EQ(sheets.canopies[1].triangles_end, p.mesh.triangles.size());
  for (std::size_t t = sheets.canopies[1].triangles_begin; t < sheets.canopies[1].triangles_end; ++t)
    for (const int i : p.mesh.triangles[t]) EXPECT_GE(i, static_cast<int>(sheets.canopies[1].begin));
  EXPECT_EQ(p.mesh.rest[sheets.canopies[1].payload.value()][0], 20.0);
}

TEST(Canopy, PerturbationsDisplaceTheClothAlongItsAxisAlone) {
  Canopy canopy;
  canopy.edge_length = 0.5;
  canopy.angle = 90.0;  // along x
  const CanopyMesh still = make_canopy(canopy);
  canopy.perturbation = {0.02, 3};
  const CanopyMesh one = make_canopy(canopy), again = make_canopy(canopy);
  canopy.perturbation.seed = 4;
  const CanopyMesh other = make_canopy(canopy);
  EXPECT_EQ(one.positions, again.positions);
  EXPECT_NE(one.positions, other.positions);
  EXPECT_EQ(one.fabric.mesh.rest, still.fabric.mesh.rest);
  double largest = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < one.positions.size(); ++i) {
    const double moved = one.positions[i][0] - still.positions[i][0];
    EXPECT_NEAR(one.positions[i][1], still.positions[i][1], 1e-15);
    EXPECT_NEAR(one.positions[i][2], still.positions[i][2], 1e-15);
    if (i >= one.cloth_vertices) {
      EXPECT_EQ(moved, 0.0) << "the payload stays";
      continue;
    }
    largest = std::max(largest, std::abs(moved)), sum += moved;
  }
  EXPECT_GT(largest, 0.019);
  EXPECT_LE(largest, 0.02);
  EXPECT_LT(std::abs(sum) / static_cast<double>(one.cloth_vertices), 0.002);
}

TEST(Canopy, StiffestPartBoundsTheFrequenciesOfTheCloth) {
  Canopy canopy;
  canopy.edge_length = 0.6;
  // So soft that the cloth sets the frequency.
  canopy.lines.stiffness = 1.0;
  canopy.poisson = 0.2;
  const auto expect_bound = [&](const char* key) {
    const Sheets sheets = make_all_sheets({}, {canopy}, 1.225, 1.8e-5);
    const fabric::Parameters& p = sheets.fabric;
    const double largest = reference::largest_frequency(p.material, p.mesh, p.mass, p.pinned, p.mesh.rest);
    const StiffPart part = stiffest_part(canopy, make_canopy(canopy));
    EXPECT_GT(part.frequency, largest) << key;
    EXPECT_LT(part.frequency, 2.05 * largest) << key;
    EXPECT_EQ(part.key, key);
  };
  expect_bound("membrane_modulus");
  canopy.vent = 0.02;
  expect_bound("vent");
  canopy.vent = 0.5;
  canopy.kind = CanopyKind::extended_skirt;
  canopy.skirt = {1.0, 8.0};
  expect_bound("membrane_modulus");
  canopy.lines.stiffness = 1e9;
  EXPECT_EQ(stiffest_part(canopy, make_canopy(canopy)).key, "lines.stiffness");
}

}  // namespace
}  // namespace drogue::parachute_app
