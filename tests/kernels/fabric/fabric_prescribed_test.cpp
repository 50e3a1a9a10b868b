#include <gtest/gtest.h>

#include <cmath>

#include "kernels/fabric/solver.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/expression_program.hpp"
#include "tests/support/fabric_mesh.hpp"

// Pins whose motion an expression prescribes.

namespace drogue::fabric {
namespace {

using testing::postfix;

constexpr const auto& backend = testing::tested_backend;
constexpr Integrator integrators[] = {Integrator::rk4, Integrator::verlet};

/// A mass of 1 kg on a spring of 16 N/m (omega = 4 rad/s), whose other end moves by 0.1 sin(3 t) m.
Parameters shaken_spring(Integrator integrator, double dt) {
  Parameters p;
  p.mesh.rest = {{0, 0, 0}, {1, 0, 0}};
  p.mesh.lines = {{0, 1}};
  p.material.axial_stiffness = 16.0;
  p.mass = {1.0, 1.0};
  p.motions = {{0, {0}, postfix({0.1, 3.0, "t", "*", "sin", "*"})}};
  p.pinned = {6, 6};
  p.integrator = integrator;
  p.dt = dt;
  return p;
}

struct Errors {
  double free, prescribed;  ///< positions of the free and of the prescribed end, m
  double velocity;          ///< of the prescribed end, m/s
};

/// Errors at 1.3 s after a start from rest. Exact displacement of the free end, m:
/// 0.1 * 16 / (16 - 9) * (sin(3 t) - 3/4 sin(4 t)).
Errors errors(Integrator integrator, int steps) {
  const double end = 1.3;
  const Parameters p = shaken_spring(integrator, end / steps);
  const auto solver = create_solver(backend, p);
  std::vector<Vector> x = p.mesh.rest, v(2, Vector{});
  solver->upload(x, v);
  EXPECT_TRUE(solver->enqueue_steps(steps));
  solver->download(x, v);
  const double exact = 1.6 / 7.0 * (std::sin(3.0 * end) - 0.75 * std::sin(4.0 * end));
  return {std::abs(x[1][0] - 1.0 - exact), std::abs(x[0][0] - 0.1 * std::sin(3.0 * end)),
          std::abs(v[0][0] - 0.3 * std::cos(3.0 * end))};
}

TEST(FabricPrescribed, MotionPreservesTheOrderOfTheMethod) {
  for (const Integrator integrator : integrators) {
    const double order = integrator == Integrator::rk4 ? 4.0 : 2.0;
    const Errors coarse = errors(integrator, 20), fine = errors(integrator, 160);
    EXPECT_NEAR(std::log2(coarse.free / fine.free) / 3.0, order, 0.15);
    EXPECT_LT(coarse.prescribed, 1e-15);
    EXPECT_LT(fine.prescribed, 1e-15);
    EXPECT_NEAR(std::log2(coarse.velocity / fine.velocity) / 3.0, 4.0, 0.15);
  }
}

TEST(FabricPrescribed, UploadAppliesTheMotionAtTheCurrentTime) {
  const Parameters p = shaken_spring(Integrator::rk4, 0.01);
  const auto solver = create_solver(backend, p);
  std::vector<Vector> x = {{7, 0, 0}, {1, 0, 0}}, v(2, Vector{9, 0, 0});
  solver->upload(x, v);
  solver->download(x, v);
  EXPECT_EQ(x[0][0], 0.0);
  EXPECT_NEAR(v[0][0], 0.3, 1e-4);
  EXPECT_EQ(v[1][0], 9.0);
  solver->set_time_state({50, 0.01, 50, 0.5});
  solver->download(x, v);
  EXPECT_NEAR(x[0][0], 0.1 * std::sin(1.5), 1e-15);
  EXPECT_NEAR(v[0][0], 0.3 * std::cos(1.5), 1e-7);
}

TEST(FabricPrescribed, PrescribesAxesIndependently) {
  // The motion depends on the rest position; z is free, so the vertices fall.
  for (const Integrator integrator : integrators) {
    Parameters p;
    p.mesh = testing::random_patch(6, 5, 2);
    p.mesh.lines.clear();
    p.material.membrane_modulus = 1.0;
    p.mass.assign(p.mesh.rest.size(), 1.0);
    p.gravity = {0.0, 0.0, -10.0};
    p.integrator = integrator;
    p.dt = 0.01;
    p.motions = {{0, {3, 4}, postfix({"y", "t", "*"})}, {1, {3}, postfix({"t", "t", "*", "negate"})}};
    const auto solver = create_solver(backend, p);
    std::vector<Vector> x = p.mesh.rest, v(x.size(), Vector{});
    solver->upload(x, v);
    EXPECT_TRUE(solver->enqueue_steps(50));
    solver->download(x, v);
    for (const std::size_t i : {std::size_t{3}, std::size_t{4}}) {
      EXPECT_NEAR(x[i][0], p.mesh.rest[i][0] + 0.5 * p.mesh.rest[i][1], 1e-15);
      EXPECT_NEAR(v[i][0], p.mesh.rest[i][1], 1e-12);
      EXPECT_LT(x[i][2], -1.0);
    }
    EXPECT_NEAR(x[3][1], p.mesh.rest[3][1] - 0.25, 1e-15);
    EXPECT_NEAR(v[3][1], -1.0, 1e-12);
    EXPECT_GT(x[4][1], p.mesh.rest[4][1] - 0.2) << "free along y";
  }
}

TEST(FabricPrescribed, ReportsTheVertexOfANonFiniteMotion) {
  for (const Integrator integrator : integrators) {
    Parameters p = shaken_spring(integrator, 0.01);
    std::swap(p.mesh.lines[0][0], p.mesh.lines[0][1]);
    p.motions = {{0, {1}, postfix({0.5, "t", "-", "sqrt"})}};
    const auto solver = create_solver(backend, p);
    std::vector<Vector> x = p.mesh.rest, v(2, Vector{});
    solver->upload(x, v);
    solver->enqueue_steps(100);
    const auto failure = solver->failure();
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->index, 1);
    EXPECT_NEAR(failure->time + failure->dt, 0.5, 0.0201);
    solver->download(x, v);
    EXPECT_TRUE(std::isfinite(x[1][0]) && std::isfinite(v[1][0]));
  }
}

TEST(FabricPrescribed, FailureBeforeTheFirstUploadReturnsToRest) {
  for (const Integrator integrator : integrators) {
    Parameters p = shaken_spring(integrator, 0.01);
    p.motions = {{0, {1}, postfix({-1.0, "sqrt"})}};
    const auto solver = create_solver(backend, p);
    solver->enqueue_steps(3);
    const auto failure = solver->failure();
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->step, 1);
    EXPECT_EQ(solver->time_state().step, 0);
    std::vector<Vector> x(2), v(2);
    solver->download(x, v);
    EXPECT_EQ(x, p.mesh.rest);
  }
}

TEST(FabricPrescribed, RejectsInvalidMotions) {
  const Parameters good = shaken_spring(Integrator::rk4, 0.01);
  const auto expect_rejected = [&](Motion motion) {
    Parameters p = good;
    p.motions.push_back(std::move(motion));
    EXPECT_THROW(static_cast<void>(create_solver(backend, p)), std::invalid_argument);
  };
  expect_rejected({3, {1}, postfix({"t"})});
  expect_rejected({0, {2}, postfix({"t"})});
  expect_rejected({0, {1}, {}});
  expect_rejected({0, {0}, postfix({"t"})});  // the axis has a motion already
}

}  // namespace
}  // namespace drogue::fabric
