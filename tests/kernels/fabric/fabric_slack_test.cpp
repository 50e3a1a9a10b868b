#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/fabric/solver.hpp"
#include "kernels/reference/fabric/frequency.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/fabric_mesh.hpp"

// Tension-only materials: relaxed energy (Pipkin 1986), forces, stress, and frequency bound.

namespace drogue::fabric {
namespace {

using testing::random_patch;
using testing::shaken;

constexpr const auto& backend = testing::tested_backend;
constexpr Model models[] = {Model::edge, Model::quadratic, Model::biquadratic};

Parameters slack_cloth(Model model) {
  Parameters p;
  p.mesh = random_patch(8, 7, 3);
  p.material.model = model;
  p.material.axial_stiffness = 400.0;
  p.material.tension_only = true;
  p.mass.assign(p.mesh.rest.size(), 0.02);
  p.dt = 1e-4;
  return p;
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

std::vector<Vector> scaled(std::vector<Vector> points, double x, double y) {
  for (Vector& p : points) p[0] *= x, p[1] *= y;
  return points;
}

double largest(const std::vector<Vector>& vectors) {
  double most = 0.0;
  for (const Vector& v : vectors)
    for (const double value : v) most = std::max(most, std::abs(value));
  return most;
}

TEST(FabricSlack, MatchesForcesAndRelaxedEnergyOfTheReference) {
  for (const Model model : models)
    for (const double size : {1e-6, 0.05, 0.4})
      for (const double poisson : {0.3, 0.0, -0.4, 0.5}) {
        Parameters p = slack_cloth(model);
        p.material.poisson = poisson;
        // Some lines are shorter or longer than the distance of their ends at rest.
        if (poisson < 0.3) p.mesh.line_length.assign(p.mesh.lines.size(), 0.0);
        if (poisson < 0.0) p.mesh.line_length.front() = 0.3, p.mesh.line_length.back() = 2.0;
        const std::vector<Vector> now = shaken(p.mesh.rest, size, 5);
        const std::vector<Vector> mine = forces_at(p, now),
                                  exact = reference::forces(p.material, p.mesh, now);
        for (std::size_t i = 0; i < now.size(); ++i)
          for (std::size_t axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(mine[i][axis], exact[i][axis], 1e-12 * (largest(exact) + p.material.membrane_modulus))
                << "model " << static_cast<int>(model) << " vertex " << i;
        const double energy = reference::energy(p.material, p.mesh, now);
        EXPECT_NEAR(at(p, now)->totals().elastic, energy, 1e-11 * (energy + 1e-3));
        p.material.tension_only = false;
        EXPECT_GT(reference::energy(p.material, p.mesh, now), 1.02 * energy);
      }
}

TEST(FabricSlack, TautFabricMatchesTheFullModel) {
  for (const Model model : models) {
    Parameters p = slack_cloth(model);
    const std::vector<Vector> now = scaled(p.mesh.rest, 1.2, 1.15);
    p.mesh.lines.clear();
    const std::vector<Vector> slack = forces_at(p, now);
    p.material.tension_only = false;
    const std::vector<Vector> full = forces_at(p, now);
    for (std::size_t i = 0; i < now.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(slack[i][axis], full[i][axis], 1e-9);
  }
}

TEST(FabricSlack, CompressionStoresNoEnergy) {
  for (const Model model : models) {
    Parameters p = slack_cloth(model);
    const std::vector<Vector> now = scaled(p.mesh.rest, 0.7, 0.9);
    p.mesh.lines.clear();
    EXPECT_EQ(largest(forces_at(p, now)), 0.0);
    EXPECT_EQ(at(p, now)->totals().elastic, 0.0);
  }
}

TEST(FabricSlack, StressVanishesAcrossWrinkles) {
  // Stretched by 20 % and narrowed by half: uniaxial stress, as for free lateral contraction.
  Parameters p = slack_cloth(Model::biquadratic);
  const std::vector<Vector> now = scaled(p.mesh.rest, 1.2, 0.5);
  std::vector<Stress> nominal(p.mesh.triangles.size());
  at(p, now)->stress(StressMeasure::nominal, nominal);
  for (const Stress& s : nominal) {
    EXPECT_NEAR(s.major, 1000.0 * 0.22 * 1.2, 1e-9);
    EXPECT_NEAR(s.minor, 0.0, 1e-9);
    EXPECT_NEAR(std::abs(s.direction[0]), 1.0, 1e-12);
  }
  std::vector<Stress> cauchy(p.mesh.triangles.size());
  at(p, shaken(p.mesh.rest, 0.3, 6))->stress(StressMeasure::cauchy, cauchy);
  for (const Stress& s : cauchy) EXPECT_GT(s.minor, -1e-9);
  // Quadratic springs relax the strain of their lengths, which equals Green's strain to first order.
  p.material.model = Model::quadratic;
  double most = 0.0;
  at(p, shaken(p.mesh.rest, 0.01, 6))->stress(StressMeasure::cauchy, cauchy);
  for (const Stress& s : cauchy) most = std::max(most, s.major);
  for (const Stress& s : cauchy) EXPECT_GT(s.minor, -0.02 * most);
}

// ctest-label: no-sanitizer
TEST(FabricSlack, VerletConservesEnergy) {
  for (const Model model : models) {
    Parameters p = slack_cloth(model);
    p.integrator = Integrator::verlet;
    p.dt = 1e-5;
    const auto solver = at(p, shaken(p.mesh.rest, 0.3, 1));
    const double before = solver->totals().energy();
    EXPECT_TRUE(solver->enqueue_steps(5000));
    const Totals after = solver->totals();
    EXPECT_NEAR(after.energy(), before, 2e-4 * before) << static_cast<int>(model);
    EXPECT_GT(after.kinetic, 0.1 * before);
  }
}

TEST(FabricSlack, FrequencyBoundIncludesSlackElements) {
  for (const Model model : models) {
    Parameters p = slack_cloth(model), full = p;
    full.material.tension_only = false;
    const double at_rest = at(full, p.mesh.rest)->fastest_frequency();
    EXPECT_GE(at(p, p.mesh.rest)->fastest_frequency(), at_rest * (1.0 - 1e-12));
    EXPECT_GT(at(p, scaled(p.mesh.rest, 0.9, 0.9))->fastest_frequency(), 0.8 * at_rest);
    for (const auto& now : {shaken(p.mesh.rest, 0.2, 4), scaled(p.mesh.rest, 1.3, 0.8)}) {
      const double truth = reference::largest_frequency(p.material, p.mesh, p.mass, {}, now);
      const double bound = at(p, now)->fastest_frequency();
      EXPECT_GE(bound, truth * (1.0 - 1e-4)) << static_cast<int>(model);
      EXPECT_LE(bound, 2.0 * truth) << static_cast<int>(model);
    }
  }
}

TEST(FabricSlack, RejectsLinearVectorSprings) {
  EXPECT_THROW(static_cast<void>(create_solver(backend, slack_cloth(Model::linear_vector))),
               std::invalid_argument);
}

}  // namespace
}  // namespace drogue::fabric
