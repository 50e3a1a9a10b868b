#include <gtest/gtest.h>

#include <cmath>

#include "kernels/fabric/solver.hpp"
#include "kernels/reference/fabric/totals.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/fabric_mesh.hpp"

// Energies and momenta against the reference, and their conservation by steps.

namespace drogue::fabric {
namespace {

using testing::random_patch;
using testing::shaken;

constexpr const auto& backend = testing::tested_backend;

Parameters fabric(Model model, int nx, int ny) {
  Parameters p;
  p.mesh = random_patch(nx, ny, 4);
  p.material.model = model;
  p.material.axial_stiffness = 300.0;
  for (std::size_t i = 0; i < p.mesh.rest.size(); ++i)
    p.mass.push_back(0.01 + 0.001 * static_cast<double>(i % 7));
  p.gravity = {0.5, -1.0, -9.81};
  p.dt = 1e-4;
  return p;
}

std::vector<Vector> random_vectors(std::size_t n, double size, unsigned seed) {
  return shaken(std::vector<Vector>(n, Vector{}), size, seed);
}

TEST(FabricTotals, MatchTheReference) {
  for (const Model model : {Model::linear_vector, Model::edge, Model::quadratic, Model::biquadratic})
    for (const auto& [nx, ny] : {std::pair{2, 2}, {9, 7}, {90, 71}})
      for (const bool loaded : {false, true}) {
        Parameters p = fabric(model, nx, ny);
        const std::size_t n = p.mass.size();
        if (loaded) p.load = random_vectors(n, 2.0, 9);
        const std::vector<Vector> x = shaken(p.mesh.rest, 0.2, 1), v = random_vectors(n, 3.0, 2);
        const auto solver = create_solver(backend, p);
        solver->upload(x, v);
        const Totals mine = solver->totals();
        const reference::Sums exact = reference::sums(p.mass, p.gravity, p.load, x, v);
        const auto expect = [&](double value, long double truth) {
          EXPECT_NEAR(value, static_cast<double>(truth), 1e-11 * (1.0 + std::abs(static_cast<double>(truth))))
              << "model " << static_cast<int>(model) << " vertices " << n;
        };
        expect(mine.kinetic, exact.kinetic);
        // Wider for linear vector springs: cancellation of squares of coordinates far from the origin.
        EXPECT_NEAR(mine.elastic, reference::energy(p.material, p.mesh, x),
                    (model == Model::linear_vector ? 1e-10 : 1e-13) * static_cast<double>(n) * 1000.0);
        expect(mine.gravity, exact.gravity);
        EXPECT_NEAR(mine.load, static_cast<double>(exact.load),
                    (model == Model::linear_vector ? 1e-9 : 1e-12) * static_cast<double>(n) * 100.0);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          expect(mine.momentum[axis], exact.momentum[axis]);
          expect(mine.angular_momentum[axis], exact.angular_momentum[axis]);
        }
        EXPECT_EQ(mine.energy(), mine.kinetic + mine.elastic + mine.gravity + mine.load);
      }
}

TEST(FabricTotals, VerletConservesTheEnergyOfAFallingLoadedPatch) {
  for (const Model model : {Model::edge, Model::quadratic, Model::biquadratic}) {
    Parameters p = fabric(model, 9, 7);
    p.integrator = Integrator::verlet;
    p.dt = 2e-5;
    p.gravity = {50.0, -100.0, -981.0};
    p.load = random_vectors(p.mass.size(), 50.0, 9);
    const auto solver = create_solver(backend, p);
    solver->upload(shaken(p.mesh.rest, 0.1, 1), random_vectors(p.mass.size(), 3.0, 2));
    const Totals before = solver->totals();
    EXPECT_TRUE(solver->enqueue_steps(5000));
    const Totals after = solver->totals();
    EXPECT_NEAR(after.energy(), before.energy(), 1e-3 * before.elastic) << static_cast<int>(model);
    // Single terms of the energy change far more than its sum.
    EXPECT_GT(std::abs(after.gravity - before.gravity), 0.1 * before.elastic);
    EXPECT_GT(std::abs(after.load - before.load), 0.1 * before.elastic);
  }
}

TEST(FabricTotals, RepeatedQueriesGiveIdenticalBits) {
  const Parameters p = fabric(Model::biquadratic, 60, 41);
  const auto solver = create_solver(backend, p);
  solver->upload(shaken(p.mesh.rest, 0.2, 1), random_vectors(p.mass.size(), 3.0, 2));
  const Totals once = solver->totals(), again = solver->totals();
  EXPECT_EQ(once.energy(), again.energy());
  EXPECT_EQ(once.angular_momentum, again.angular_momentum);
}

}  // namespace
}  // namespace drogue::fabric
