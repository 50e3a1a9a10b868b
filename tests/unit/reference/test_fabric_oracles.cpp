#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kernels/reference/fabric/bending.hpp"
#include "kernels/reference/fabric/frequency.hpp"
#include "kernels/reference/fabric/loads.hpp"
#include "kernels/reference/fabric/mass.hpp"
#include "kernels/reference/fabric/stress.hpp"
#include "kernels/reference/fabric/totals.hpp"

// Reference functions of fabric against closed forms.

namespace drogue::reference {
namespace {

TEST(ReferenceFrequency, ChainHasTheAnalyticFrequency) {
  // A free chain of N masses: 2 sqrt(k / m) cos(pi / (2 N)).
  Mesh mesh;
  for (int i = 0; i < 6; ++i) mesh.rest.push_back({0.5 * i, 0, 0});
  for (int i = 0; i < 5; ++i) mesh.lines.push_back({i, i + 1});
  fabric::Material material;
  material.axial_stiffness = 40.0;
  const double expected = 2.0 * std::sqrt(80.0 / 0.2) * std::cos(std::numbers::pi / 12.0);
  EXPECT_NEAR(largest_frequency(material, mesh, std::vector<double>(6, 0.2), {}, mesh.rest), expected,
              1e-4 * expected);
  // Both ends fixed: 2 sqrt(k / m) cos(pi / (2 (N + 1))) with N = 4 free masses.
  const double fixed = 2.0 * std::sqrt(80.0 / 0.2) * std::cos(std::numbers::pi / 10.0);
  EXPECT_NEAR(largest_frequency(material, mesh, std::vector<double>(6, 0.2), {7, 0, 0, 0, 0, 7}, mesh.rest),
              fixed, 1e-4 * fixed);
}

const std::array<Vector, 3> unit_triangle = {Vector{0, 0, 0}, Vector{1, 0, 0}, Vector{0, 1, 0}};

TEST(ReferenceStress, MatchesUniaxialTension) {
  fabric::Material material;
  material.membrane_modulus = 500.0, material.poisson = 0.25;
  const double l = 1.1, strain = 0.5 * (l * l - 1.0), w = std::sqrt(1.0 - 2.0 * 0.25 * strain);
  const std::array<Vector, 3> now = {Vector{0, 0, 0}, Vector{0, 0, l}, Vector{0, w, 0}};
  const Tensor cauchy = cauchy_stress(material, unit_triangle, now);
  EXPECT_NEAR(cauchy[2][2], 500.0 * strain * l / w, 1e-11);
  EXPECT_NEAR(cauchy[1][1], 0.0, 1e-11);
  EXPECT_NEAR(nominal_stress(cauchy, unit_triangle, now)[2][2], 500.0 * strain * l, 1e-11);
  // Forces in equilibrium with this stress.
  const double half = 0.5 * 500.0 * strain * l;
  const Tensor virial = virial_stress({Vector{0, 0, half}, Vector{0, 0, -half}, Vector{}}, now);
  EXPECT_NEAR(virial[2][2], cauchy[2][2], 1e-11);
}

TEST(ReferenceMembrane, RelaxedEnergyCoversTautWrinkledAndSlackStates) {
  fabric::Material material;
  material.membrane_modulus = 800.0, material.poisson = 0.3, material.tension_only = true;
  const auto energy = [&](double x, double y) {
    return triangle_energy<double>(material, unit_triangle,
                                   {Vector{0, 0, 0}, Vector{x, 0, 0}, Vector{0, y, 0}});
  };
  EXPECT_EQ(energy(0.9, 0.8), 0.0);
  const double strain = 0.5 * (1.21 - 1.0);
  for (const double y : {0.5, 0.8, 0.9}) EXPECT_NEAR(energy(1.1, y), 0.25 * 800.0 * strain * strain, 1e-12);
  material.tension_only = false;
  const double full = energy(1.1, 1.05);
  material.tension_only = true;
  EXPECT_EQ(energy(1.1, 1.05), full);
}

TEST(ReferenceLoads, ComputesVolumeAndAreasOfATetrahedron) {
  Mesh mesh;
  mesh.rest = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  EXPECT_NEAR(enclosed_volume(mesh, mesh.rest), 1.0, 1e-15);
  const std::vector<Vector> f = pressure_forces(mesh, {3, 3, 3, 3}, mesh.rest);
  // Vertex 3 touches faces of areas seen along x: -3 and 3, along z: 1.
  EXPECT_NEAR(f[3][2], 1.0, 1e-15);
  EXPECT_NEAR(f[0][0] + f[1][0] + f[2][0] + f[3][0], 0.0, 1e-14);
}

TEST(ReferenceLoads, DashpotActsAlongItsEdge) {
  Mesh mesh;
  mesh.rest = {{0, 0, 0}, {3, 4, 0}};
  mesh.lines = {{0, 1}};
  // It lengthens by 5 m/s; the reduced mass of 2 and 2 kg is 1.
  const std::vector<Vector> f = dashpot_forces(mesh, {2.0, 2.0}, 0.5, mesh.rest, {Vector{}, Vector{3, 4, 9}});
  EXPECT_NEAR(f[0][0], 1.5, 1e-15);
  EXPECT_NEAR(f[0][1], 2.0, 1e-15);
  EXPECT_EQ(f[0][2], 0.0);
  EXPECT_EQ(f[1][0], -f[0][0]);
}

TEST(ReferenceBending, FoldHasTheEnergyOfItsAngle) {
  Mesh mesh;
  mesh.rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, -1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  std::vector<Vector> now = mesh.rest;
  now[2] = {0, 0, 1};
  // |e|^2 / (A_0 + A_1) = 1, 2 sin(45 degrees) squared is 2.
  EXPECT_NEAR(bending_energy(7.0, mesh, now), 7.0, 1e-13);
  const std::vector<Vector> f = bending_forces(7.0, mesh, now);
  EXPECT_NEAR(f[2][2], -7.0, 1e-12);
}

TEST(ReferenceTotals, SumsEnergyAndMomentumOfOneMass) {
  const Sums s = sums({2.0}, {0, 0, -10}, {Vector{1, 0, 0}}, {Vector{1, 2, 3}}, {Vector{4, 5, 6}});
  EXPECT_EQ(static_cast<double>(s.kinetic), 77.0);
  EXPECT_EQ(static_cast<double>(s.gravity), 60.0);
  EXPECT_EQ(static_cast<double>(s.load), -1.0);
  EXPECT_EQ(static_cast<double>(s.angular_momentum[2]), 2.0 * (1.0 * 5.0 - 2.0 * 4.0));
  EXPECT_EQ(static_cast<double>(s.momentum[1]), 10.0);
}

TEST(ReferenceMass, LumpsTheMassOfATriangleAndALine) {
  Mesh mesh;
  mesh.rest = {unit_triangle[0], unit_triangle[1], unit_triangle[2], {0, 4, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.lines = {{2, 3}};
  const std::vector<double> mass = row_sum_masses(mesh, 6.0, 2.0);
  EXPECT_NEAR(mass[0], 1.0, 1e-15);
  EXPECT_NEAR(mass[2], 4.0, 1e-15);
  EXPECT_NEAR(mass[3], 3.0, 1e-15);
}

}  // namespace
}  // namespace drogue::reference
