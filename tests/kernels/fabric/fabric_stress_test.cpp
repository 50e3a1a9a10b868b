#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kernels/fabric/solver.hpp"
#include "kernels/reference/fabric/stress.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/fabric_mesh.hpp"

// Stress against continuum formulas, and against the virial of the forces.

namespace drogue::fabric {
namespace {

using reference::Tensor;
using testing::random_patch;
using testing::shaken;

constexpr const auto& backend = testing::tested_backend;

Parameters fabric(Model model, const Mesh& mesh) {
  Parameters p;
  p.mesh = mesh;
  p.material.model = model;
  p.material.axial_stiffness = 300.0;
  p.mass.assign(mesh.rest.size(), 0.01);
  p.dt = 1e-4;
  return p;
}

std::unique_ptr<Solver> at(const Parameters& p, const std::vector<Vector>& now) {
  auto solver = create_solver(backend, p);
  solver->upload(now, std::vector<Vector>(now.size(), Vector{}));
  return solver;
}

std::vector<Stress> stress_of(const Parameters& p, const std::vector<Vector>& now, StressMeasure measure) {
  std::vector<Stress> stress(p.mesh.triangles.size());
  at(p, now)->stress(measure, stress);
  return stress;
}

std::array<Vector, 3> corners(const std::vector<Vector>& points, const std::array<int, 3>& t) {
  return {points[static_cast<std::size_t>(t[0])], points[static_cast<std::size_t>(t[1])],
          points[static_cast<std::size_t>(t[2])]};
}

Vector normal_of(const std::array<Vector, 3>& x) {
  Vector u, v;
  for (std::size_t k = 0; k < 3; ++k) u[k] = x[1][k] - x[0][k], v[k] = x[2][k] - x[0][k];
  Vector n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double size = std::hypot(n[0], n[1], n[2]);
  for (double& value : n) value /= size;
  return n;
}

/// Tensor with the principal values of `s` in the plane with unit normal `n`.
Tensor tensor_of(const Stress& s, const Vector& n) {
  const Vector& d = s.direction;
  const Vector e = {n[1] * d[2] - n[2] * d[1], n[2] * d[0] - n[0] * d[2], n[0] * d[1] - n[1] * d[0]};
  Tensor t;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) t[i][j] = s.major * d[i] * d[j] + s.minor * e[i] * e[j];
  return t;
}

void expect_same(const Tensor& a, const Tensor& b, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) ASSERT_NEAR(a[i][j], b[i][j], tolerance) << i << j;
}

/// Forces of triangle `t` on its three vertices, N, without those of its neighbours.
std::array<Vector, 3> forces_of_one(const Parameters& p, const std::vector<Vector>& now,
                                    const std::array<int, 3>& t) {
  Mesh one;
  for (const Vector& x : corners(p.mesh.rest, t)) one.rest.push_back(x);
  one.triangles = {{0, 1, 2}};
  const auto there = corners(now, t);
  const std::vector<Vector> f = reference::forces(p.material, one, {there[0], there[1], there[2]});
  return {f[0], f[1], f[2]};
}

TEST(FabricStress, MatchesTheReference) {
  const Mesh mesh = random_patch(7, 6, 4);
  const std::vector<Vector> now = shaken(mesh.rest, 0.25, 2);
  for (const Model model : {Model::quadratic, Model::biquadratic}) {
    const Parameters p = fabric(model, mesh);
    const std::vector<Stress> cauchy = stress_of(p, now, StressMeasure::cauchy),
                              nominal = stress_of(p, now, StressMeasure::nominal);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto rest = corners(mesh.rest, mesh.triangles[t]), there = corners(now, mesh.triangles[t]);
      const Vector n = normal_of(there);
      const Tensor virial = reference::virial_stress(forces_of_one(p, now, mesh.triangles[t]), there);
      const double tolerance = 1e-11 * p.material.membrane_modulus;
      expect_same(tensor_of(cauchy[t], n), virial, tolerance);
      if (model == Model::biquadratic)
        expect_same(tensor_of(cauchy[t], n), reference::cauchy_stress(p.material, rest, there), tolerance);
      expect_same(tensor_of(nominal[t], n), reference::nominal_stress(virial, rest, there), tolerance);
      const auto whole = cauchy[t].tensor();
      std::size_t place = 0;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = i; j < 3; ++j) EXPECT_NEAR(whole[place++], virial[i][j], tolerance) << i << j;
      EXPECT_GE(cauchy[t].major, cauchy[t].minor);
      EXPECT_NEAR(std::hypot(cauchy[t].direction[0], cauchy[t].direction[1], cauchy[t].direction[2]), 1.0,
                  1e-14);
    }
  }
}

TEST(FabricStress, StressOfEdgeSpringsSumsToTheVirial) {
  Parameters p = fabric(Model::edge, random_patch(7, 6, 4));
  p.mesh.lines.clear();
  const std::vector<Vector> now = shaken(p.mesh.rest, 0.2, 2);
  const std::vector<Stress> stress = stress_of(p, now, StressMeasure::cauchy);
  const std::vector<Vector> forces = reference::forces(p.material, p.mesh, now);
  Tensor sum{}, virial{};
  for (std::size_t t = 0; t < stress.size(); ++t) {
    const auto there = corners(now, p.mesh.triangles[t]);
    const Tensor part = tensor_of(stress[t], normal_of(there));
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        sum[i][j] += reference::area(there[0], there[1], there[2]) * part[i][j];
  }
  for (std::size_t vertex = 0; vertex < now.size(); ++vertex)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) virial[i][j] -= forces[vertex][i] * now[vertex][j];
  expect_same(sum, virial, 1e-9);
  EXPECT_GT(std::abs(virial[0][0]), 1.0);
}

/// Positions stretched by `along` in the direction at 0.5 rad to x and by `across` perpendicular to it, then
/// rotated about x and shifted.
std::vector<Vector> drawn(const std::vector<Vector>& rest, double along, double across) {
  const double c = std::cos(0.5), s = std::sin(0.5), ct = std::cos(1.1), st = std::sin(1.1);
  std::vector<Vector> now;
  for (const Vector& x : rest) {
    const double u = along * (c * x[0] + s * x[1]), v = across * (c * x[1] - s * x[0]);
    const double px = c * u - s * v, py = s * u + c * v;
    now.push_back({px, ct * py, st * py + 2.0});
  }
  return now;
}

TEST(FabricStress, IsUniformUnderUniformStretch) {
  Parameters p = fabric(Model::biquadratic, random_patch(9, 8, 6));
  p.mesh.lines.clear();
  p.mesh.rest.resize(72);  // without the line that hangs from the patch
  p.mass.resize(72);
  // Stress does not depend on the orientation of triangles.
  for (std::size_t t = 0; t < p.mesh.triangles.size(); t += 3)
    std::swap(p.mesh.triangles[t][1], p.mesh.triangles[t][2]);
  const double e = 1000.0, nu = 0.3, l = 1.2, e1 = 0.5 * (l * l - 1.0), w = std::sqrt(1.0 - 2.0 * nu * e1);
  const std::vector<Vector> now = drawn(p.mesh.rest, l, w);
  // Uniaxial stress: S = E e1, P = l S, sigma = l S / w.
  const Vector direction = {std::cos(0.5), std::sin(0.5) * std::cos(1.1), std::sin(0.5) * std::sin(1.1)};
  const auto solver = at(p, now);
  for (const StressMeasure measure : {StressMeasure::nominal, StressMeasure::cauchy}) {
    const double expected = e * e1 * l / (measure == StressMeasure::cauchy ? w : 1.0);
    std::vector<Stress> triangles(p.mesh.triangles.size()), vertices(p.mass.size());
    solver->stress(measure, triangles);
    solver->vertex_stress(measure, vertices);
    triangles.insert(triangles.end(), vertices.begin(), vertices.end());
    for (const Stress& s : triangles) {
      EXPECT_NEAR(s.major, expected, 1e-10);
      EXPECT_NEAR(s.minor, 0.0, 1e-10);
      EXPECT_NEAR(s.von_mises(), expected, 1e-10);
      double aligned = 0.0;
      for (std::size_t k = 0; k < 3; ++k) aligned += s.direction[k] * direction[k];
      EXPECT_NEAR(std::abs(aligned), 1.0, 1e-12);
    }
  }
}

TEST(FabricStress, IsTheAreaWeightedMeanAtAVertex) {
  // Two coplanar triangles of areas 1/2 and 1, stretched independently: the shared edge keeps its length.
  Parameters p;
  p.mesh.rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -2, 0}};
  p.mesh.triangles = {{0, 1, 2}, {0, 3, 1}};
  p.material.poisson = 0.0;
  p.mass.assign(4, 1.0);
  p.dt = 1e-3;
  const auto solver = at(p, {{0, 0, 0}, {1, 0, 0}, {0, 1.1, 0}, {0, -2.4, 0}});
  std::vector<Stress> triangles(2), vertices(4);
  solver->stress(StressMeasure::nominal, triangles);
  solver->vertex_stress(StressMeasure::nominal, vertices);
  const double first = 1000.0 * 0.5 * (1.21 - 1.0) * 1.1, second = 1000.0 * 0.5 * (1.44 - 1.0) * 1.2;
  EXPECT_NEAR(triangles[0].major, first, 1e-10);
  EXPECT_NEAR(triangles[1].major, second, 1e-10);
  EXPECT_NEAR(vertices[0].major, (first + 2.0 * second) / 3.0, 1e-10);
  EXPECT_NEAR(vertices[2].major, first, 1e-10);
  EXPECT_NEAR(vertices[3].major, second, 1e-10);
  // Both stresses act along y: component yy of the mean tensor, and the minor principal direction along x.
  EXPECT_NEAR(vertices[0].tensor()[3], (first + 2.0 * second) / 3.0, 1e-10);
  EXPECT_NEAR(std::abs(vertices[0].across[0]), 1.0, 1e-12);
}

TEST(FabricStress, AveragesTheStressOfBothLayersAtASharpFold) {
  // Stretched across the fold, with 10 degrees between the layers.
  Parameters p;
  p.mesh.rest = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}};
  p.mesh.triangles = {{0, 2, 1}, {0, 1, 3}};
  p.material.poisson = 0.0;
  p.mass.assign(4, 1.0);
  p.dt = 1e-3;
  const double l = 1.1, angle = std::numbers::pi / 18;
  const auto solver = at(p, {{0, 0, 0}, {0, 1, 0}, {l, 0, 0}, {l * std::cos(angle), 0, l * std::sin(angle)}});
  std::vector<Stress> vertices(4);
  solver->vertex_stress(StressMeasure::nominal, vertices);
  const double expected = 1000.0 * 0.5 * (l * l - 1.0) * l, leaning = std::cos(0.5 * angle);
  for (const std::size_t shared : {0, 1})
    EXPECT_NEAR(vertices[shared].major, expected * leaning * leaning, 1e-10);
}

TEST(FabricStress, VonMisesStressMatchesClosedForms) {
  EXPECT_NEAR((Stress{3.0, 0.0, {}, {}}.von_mises()), 3.0, 1e-15);
  EXPECT_NEAR((Stress{2.0, 2.0, {}, {}}.von_mises()), 2.0, 1e-15);
  EXPECT_NEAR((Stress{1.0, -1.0, {}, {}}.von_mises()), std::sqrt(3.0), 1e-15);
}

TEST(FabricStress, RejectsUndefinedStressAndStaysFiniteForCollapsedTriangles) {
  Parameters p = fabric(Model::linear_vector, random_patch(3, 3, 1));
  std::vector<Stress> triangles(p.mesh.triangles.size());
  EXPECT_THROW(at(p, p.mesh.rest)->stress(StressMeasure::cauchy, triangles), std::invalid_argument);
  p.material.model = Model::biquadratic;
  const auto solver = at(p, p.mesh.rest);
  triangles.pop_back();
  EXPECT_THROW(solver->stress(StressMeasure::cauchy, triangles), std::invalid_argument);
  EXPECT_THROW(solver->vertex_stress(StressMeasure::cauchy, triangles), std::invalid_argument);
  // Finite values at a collapsed triangle, and zero at the end of a line.
  std::vector<Stress> vertices(p.mass.size());
  std::vector<Vector> now = p.mesh.rest;
  now[0] = now[1] = now[3];
  at(p, now)->vertex_stress(StressMeasure::cauchy, vertices);
  for (const Stress& s : vertices) EXPECT_TRUE(std::isfinite(s.major) && std::isfinite(s.minor));
  EXPECT_EQ(vertices.back().major, 0.0);
}

}  // namespace
}  // namespace drogue::fabric
