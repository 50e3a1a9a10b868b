#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/fabric/solver.hpp"
#include "kernels/reference/fabric/bending.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/fabric_mesh.hpp"

// Bending forces and energies against the reference, and against closed forms for folds and cylinders.

namespace drogue::fabric {
namespace {

using testing::random_patch;
using testing::shaken;

constexpr const auto& backend = testing::tested_backend;

/// Fabric with bending stiffness only, N m: no membrane stiffness.
Parameters sheet(const Mesh& mesh, double stiffness) {
  Parameters p;
  p.mesh = mesh;
  p.material.membrane_modulus = 0.0;
  p.material.bending_stiffness = stiffness;
  p.mass.assign(mesh.rest.size(), 0.02);
  p.dt = 1e-3;
  return p;
}

Mesh patch() {
  Mesh mesh = random_patch(6, 5, 3);
  mesh.rest.resize(30);
  mesh.lines.clear();
  return mesh;
}

std::unique_ptr<Solver> at(const Parameters& p, const std::vector<Vector>& now) {
  auto solver = create_solver(backend, p);
  solver->upload(now, std::vector<Vector>(now.size(), Vector{}));
  return solver;
}

std::vector<Vector> forces_at(const Parameters& p, const std::vector<Vector>& now) {
  std::vector<Vector> forces(now.size());
  at(p, now)->forces(forces);
  return forces;
}

TEST(FabricBending, MatchesForcesAndEnergyOfTheReference) {
  const Mesh mesh = patch();
  const std::vector<Vector> now = shaken(mesh.rest, 0.4, 2);
  const std::vector<Vector> mine = forces_at(sheet(mesh, 0.7), now),
                            exact = reference::bending_forces(0.7, mesh, now);
  double largest = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(mine[i][axis], exact[i][axis], 1e-10);
      largest = std::max(largest, std::abs(mine[i][axis]));
    }
  EXPECT_GT(largest, 1.0);
  EXPECT_NEAR(at(sheet(mesh, 0.7), now)->totals().elastic, reference::bending_energy(0.7, mesh, now), 1e-11);
}

TEST(FabricBending, VanishesForFlatFabricAndExertsNoNetForceOrTorque) {
  const Mesh mesh = patch();
  std::vector<Vector> turned;
  for (const Vector& x : mesh.rest)
    turned.push_back({std::cos(1.0) * x[0] + 3.0, 1.5 * x[1] + 0.2 * x[0], std::sin(1.0) * x[0]});
  for (const Vector& f : forces_at(sheet(mesh, 2.0), turned))
    for (const double value : f) EXPECT_NEAR(value, 0.0, 1e-12);
  const std::vector<Vector> now = shaken(mesh.rest, 0.4, 2), f = forces_at(sheet(mesh, 2.0), now);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double sum = 0.0, torque = 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      sum += f[i][axis];
      torque += now[i][(axis + 1) % 3] * f[i][(axis + 2) % 3] - now[i][(axis + 2) % 3] * f[i][(axis + 1) % 3];
    }
    EXPECT_NEAR(sum, 0.0, 1e-11);
    EXPECT_NEAR(torque, 0.0, 1e-10);
  }
}

TEST(FabricBending, MatchesTheClosedFormOfAFold) {
  // Two triangles share an edge of length 2; their heights and areas are 1 and 3.
  Mesh mesh;
  mesh.rest = {{0, 0, 0}, {2, 0, 0}, {0.5, 1, 0}, {1.5, -3, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  for (const double angle : {0.1, 1.0, 3.0}) {
    std::vector<Vector> now = mesh.rest;
    now[2] = {0.5, std::cos(angle), std::sin(angle)};
    const double sine = 2.0 * std::sin(0.5 * angle);
    EXPECT_NEAR(at(sheet(mesh, 0.3), now)->totals().elastic, 0.5 * 0.3 * 4.0 / 4.0 * sine * sine, 1e-13);
  }
}

/// Bending energy of a sheet rolled to a cylinder, over the energy k A / (2 R^2) of the continuum. The mesh
/// consists of equilateral triangles, or of squares with alternating diagonals.
double rolled(int n, bool equilateral) {
  Mesh mesh;
  std::vector<Vector> now;
  const double radius = 1.5, h = 2.0 / n, height = equilateral ? std::sqrt(0.75) * h : h;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = h * (i + (equilateral && j % 2 == 1 ? 0.5 : 0.0)), y = height * j;
      mesh.rest.push_back({x, y, 0.0});
      now.push_back({radius * std::sin(x / radius), y, radius * (1.0 - std::cos(x / radius))});
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      const bool falling = equilateral ? j % 2 == 0 : (i + j) % 2 == 1;
      mesh.triangles.push_back({a, b, falling ? c : d});
      mesh.triangles.push_back({falling ? b : a, d, c});
    }
  return at(sheet(mesh, 0.8), now)->totals().elastic / (0.5 * 0.8 * 2.0 * height * n / (radius * radius));
}

TEST(FabricBending, ConvergesToTheEnergyOfACylinder) {
  for (const bool equilateral : {false, true}) {
    // First-order error: edges of the boundary have no hinge.
    EXPECT_NEAR(rolled(64, equilateral), 1.0, 0.03);
    EXPECT_NEAR(rolled(32, equilateral) - 1.0, 2.0 * (rolled(64, equilateral) - 1.0), 0.004);
  }
}

TEST(FabricBending, EntersTheFrequencyBound) {
  // Without membrane stiffness, the step at the bound is stable and twice that step is not.
  Parameters p = sheet(patch(), 5.0);
  const std::vector<Vector> start = shaken(p.mesh.rest, 1e-6, 3);
  const double bound = at(p, start)->fastest_frequency();
  const auto is_stable = [&](double dt) {
    p.dt = dt;
    const auto solver = at(p, start);
    const double before = solver->totals().elastic;
    return solver->enqueue_steps(2000) && !solver->failure() && solver->totals().elastic < 100.0 * before;
  };
  EXPECT_TRUE(is_stable(stability_limit(Integrator::rk4) / bound));
  EXPECT_FALSE(is_stable(2.0 * stability_limit(Integrator::rk4) / bound));
}

TEST(FabricBending, RejectsCurvedRestShapesAndNegativeStiffness) {
  Mesh mesh = patch();
  mesh.rest[14][2] = 0.1;
  EXPECT_THROW(static_cast<void>(create_solver(backend, sheet(mesh, 1.0))), std::invalid_argument);
  EXPECT_NO_THROW(static_cast<void>(create_solver(backend, sheet(mesh, 0.0))));
  EXPECT_THROW(static_cast<void>(create_solver(backend, sheet(patch(), -1.0))), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::fabric
