#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/fabric/solver.hpp"
#include "kernels/reference/fabric/membrane.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/fabric_mesh.hpp"

// Forces of the kernels against derivatives of the reference energies by complex steps.

namespace drogue::fabric {
namespace {

using testing::random_patch;
using testing::shaken;

constexpr const auto& backend = testing::tested_backend;
constexpr Model models[] = {Model::linear_vector, Model::edge, Model::quadratic, Model::biquadratic};

Parameters cloth_of(Model model, const Mesh& mesh) {
  Parameters p;
  p.mesh = mesh;
  p.material.model = model;
  p.material.axial_stiffness = 300.0;
  p.mass.assign(mesh.rest.size(), 0.01);
  p.dt = 1e-4;
  return p;
}

std::vector<Vector> kernel_forces(const Parameters& p, const std::vector<Vector>& now) {
  const auto solver = create_solver(backend, p);
  std::vector<Vector> forces(now.size());
  solver->upload(now, forces);
  solver->forces(forces);
  return forces;
}

double largest(const std::vector<Vector>& vectors) {
  double most = 0.0;
  for (const Vector& v : vectors)
    for (const double value : v) most = std::max(most, std::abs(value));
  return most;
}

// ctest-label: smoke
TEST(FabricForce, IsTheDerivativeOfTheReferenceEnergy) {
  for (const Model model : models)
    for (const auto& [nx, ny] : {std::pair{2, 2}, {5, 4}, {9, 13}, {33, 7}, {41, 60}})
      for (const double size : {1e-6, 0.05, 0.4}) {
        const Mesh mesh = random_patch(nx, ny, 7U + static_cast<unsigned>(nx));
        const Parameters p = cloth_of(model, mesh);
        const std::vector<Vector> now = shaken(mesh.rest, size, 3);
        const std::vector<Vector> mine = kernel_forces(p, now),
                                  exact = reference::forces(p.material, mesh, now);
        // Rounding acts on tensions and squared lengths of order one, also where strains are of order `size`.
        const double tolerance = 1e-13 * (largest(exact) + p.material.membrane_modulus);
        for (std::size_t i = 0; i < now.size(); ++i)
          for (std::size_t axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(mine[i][axis], exact[i][axis], tolerance)
                << "model " << static_cast<int>(model) << " vertex " << i;
      }
}

TEST(FabricForce, SumAndTorqueVanish) {
  const Mesh mesh = random_patch(12, 9, 5);
  for (const Model model : models) {
    const std::vector<Vector> now = shaken(mesh.rest, 0.3, 1);
    const std::vector<Vector> f = kernel_forces(cloth_of(model, mesh), now);
    Vector sum{}, torque{};
    for (std::size_t i = 0; i < f.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t next = (axis + 1) % 3, after = (axis + 2) % 3;
        sum[axis] += f[i][axis];
        torque[axis] += now[i][next] * f[i][after] - now[i][after] * f[i][next];
      }
    EXPECT_LT(largest({sum}), 1e-13 * largest(f) * static_cast<double>(f.size()));
    // Model I is not invariant under rotation and exerts a torque.
    if (model == Model::linear_vector)
      EXPECT_GT(largest({torque}), 1e-3 * largest(f));
    else
      EXPECT_LT(largest({torque}), 1e-12 * largest(f) * static_cast<double>(f.size()));
  }
}

TEST(FabricForce, VanishesUnderRigidMotionOfInvariantModels) {
  const Mesh mesh = random_patch(12, 9, 5);
  std::vector<Vector> turned;
  const double c = std::cos(1.0), s = std::sin(1.0);
  for (const Vector& x : mesh.rest)
    turned.push_back({c * x[0] - s * x[2] + 3.0, x[1] - 5.0, s * x[0] + c * x[2]});
  for (const Model model : {Model::edge, Model::quadratic, Model::biquadratic})
    EXPECT_LT(largest(kernel_forces(cloth_of(model, mesh), turned)), 1e-10) << static_cast<int>(model);
  EXPECT_GT(largest(kernel_forces(cloth_of(Model::linear_vector, mesh), turned)), 100.0);
}

TEST(FabricForce, AddsDeadLoads) {
  const Mesh mesh = random_patch(4, 4, 2);
  for (const Model model : models) {
    Parameters p = cloth_of(model, mesh);
    const std::vector<Vector> now = shaken(mesh.rest, 0.1, 4), without = kernel_forces(p, now);
    p.load = shaken(std::vector<Vector>(mesh.rest.size(), Vector{}), 2.0, 9);
    const std::vector<Vector> with = kernel_forces(p, now);
    for (std::size_t i = 0; i < now.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(with[i][axis] - without[i][axis], p.load[i][axis], 1e-11);
  }
}

TEST(FabricForce, RejectsInvalidParameters) {
  const Parameters good = cloth_of(Model::biquadratic, random_patch(3, 3, 1));
  const auto expect_rejected = [&](auto change) {
    Parameters p = good;
    change(p);
    EXPECT_THROW(static_cast<void>(create_solver(backend, p)), std::invalid_argument);
  };
  expect_rejected([](Parameters& p) { p.mesh.triangles[0][1] = 99; });
  expect_rejected([](Parameters& p) { p.mesh.lines[0][1] = -1; });
  expect_rejected([](Parameters& p) { p.mass[2] = 0.0; });
  expect_rejected([](Parameters& p) { p.mass.pop_back(); });
  expect_rejected([](Parameters& p) { p.pinned.assign(2, 7); });
  expect_rejected([](Parameters& p) { p.load.assign(2, Vector{}); });
  expect_rejected([](Parameters& p) { p.dt = 0.0; });
  expect_rejected([](Parameters& p) { p.material.poisson = 0.6; });
  expect_rejected([](Parameters& p) { p.mesh.triangles[0][1] = p.mesh.triangles[0][0]; });
  expect_rejected([](Parameters& p) { p.mesh.rest[4] = {1.0, std::nan(""), 0.0}; });
  expect_rejected([](Parameters& p) {
    for (Vector& x : p.mesh.rest) x[1] = 0.0;
  });
  expect_rejected([](Parameters& p) { p.mesh.lines[0] = {3, 3}; });
  expect_rejected([](Parameters& p) { p.damping = -1.0; });
  expect_rejected([](Parameters& p) { p.dt = INFINITY; });
  expect_rejected([](Parameters& p) { p.gravity[2] = NAN; });
  expect_rejected([](Parameters& p) { p.material.membrane_modulus = -1.0; });
  const auto solver = create_solver(backend, good);
  std::vector<Vector> vectors(good.mass.size() + 1);
  EXPECT_THROW(solver->upload(vectors, vectors), std::invalid_argument);
  EXPECT_THROW(solver->download(vectors, vectors), std::invalid_argument);
  vectors.resize(3);
  EXPECT_THROW(solver->forces(vectors), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::fabric
