#include <gtest/gtest.h>

#include <cmath>

#include "kernels/fabric/solver.hpp"
#include "kernels/reference/fabric/loads.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/expression_program.hpp"
#include "tests/support/fabric_mesh.hpp"

// Timed loads, follower pressures, dashpots, and stiffness per line.

namespace drogue::fabric {
namespace {

using testing::postfix;
using testing::random_patch;
using testing::shaken;

constexpr const auto& backend = testing::tested_backend;
constexpr Integrator integrators[] = {Integrator::rk4, Integrator::verlet};
constexpr Model models[] = {Model::edge, Model::quadratic, Model::biquadratic};

struct State {
  std::vector<Vector> x, v;
};

State moved(const Parameters& p, State state, std::int64_t steps) {
  const auto solver = create_solver(backend, p);
  solver->upload(state.x, state.v);
  EXPECT_TRUE(solver->enqueue_steps(steps));
  solver->download(state.x, state.v);
  return state;
}

std::vector<Vector> still(std::size_t n) { return std::vector<Vector>(n, Vector{}); }

Parameters fabric(Model model) {
  Parameters p;
  p.mesh = random_patch(7, 6, 3);
  p.material.model = model;
  p.material.axial_stiffness = 400.0;
  for (std::size_t i = 0; i < p.mesh.rest.size(); ++i)
    p.mass.push_back(0.01 + 0.001 * static_cast<double>(i % 7));
  p.dt = 1e-4;
  return p;
}

std::vector<Vector> forces_at(const Parameters& p, const std::vector<Vector>& x, double time) {
  const auto solver = create_solver(backend, p);
  solver->upload(x, still(x.size()));
  solver->set_time_state({0, p.dt, 0, time});
  std::vector<Vector> forces(x.size());
  solver->forces(forces);
  return forces;
}

void expect_near(const std::vector<Vector>& a, const std::vector<Vector>& b, double tolerance) {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_NEAR(a[i][axis], b[i][axis], tolerance) << i;
}

TEST(FabricLoad, UsesTheStiffnessOfEachLine) {
  for (const Model model : models) {
    Parameters p = fabric(model);
    p.mesh.line_stiffness = {100.0, 0.0, 700.0, 2000.0};
    const std::vector<Vector> x = shaken(p.mesh.rest, 0.2, 2);
    expect_near(forces_at(p, x, 0.0), reference::forces(p.material, p.mesh, x), 1e-9);
    p.mesh.line_stiffness[3] = 0.0;
    const std::vector<Vector> other = reference::forces(p.material, p.mesh, x);
    EXPECT_GT(std::abs(forces_at(p, x, 0.0)[41][0] - forces_at(fabric(model), x, 0.0)[41][0]), 1.0);
    expect_near(forces_at(p, x, 0.0), other, 1e-9);
  }
}

TEST(FabricLoad, PressureFollowsCurrentNormals) {
  for (const Model model : models) {
    Parameters p = fabric(model);
    std::vector<double> weight, total;
    for (std::size_t i = 0; i < p.mass.size(); ++i) weight.push_back(i % 3 == 0 ? 0.0 : 0.5 * double(i % 5));
    p.follower_pressures = {{postfix({30.0, "x", "t", "*", "+"}), {}}, {postfix({-20.0, "y", "*"}), weight}};
    p.load = shaken(still(p.mass.size()), 2.0, 9);
    const double time = 1.5;
    for (std::size_t i = 0; i < p.mass.size(); ++i)
      total.push_back(30.0 + p.mesh.rest[i][0] * time - 20.0 * p.mesh.rest[i][1] * weight[i]);
    const std::vector<Vector> x = shaken(p.mesh.rest, 0.3, 2);
    std::vector<Vector> expected = reference::forces(p.material, p.mesh, x);
    const std::vector<Vector> pressure = reference::pressure_forces(p.mesh, total, x);
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) expected[i][axis] += pressure[i][axis] + p.load[i][axis];
    expect_near(forces_at(p, x, time), expected, 1e-9);
  }
}

TEST(FabricLoad, PressureInAClosedSurfaceEqualsTheVolumeGradient) {
  Parameters p;
  p.mesh.rest = {{1, 0, 0}, {-1, 0, 0}, {0, 1.2, 0}, {0, -0.8, 0}, {0.1, 0, 1}, {0, 0.3, -1.1}};
  p.mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  p.mass.assign(6, 1.0);
  p.dt = 1e-3;
  p.follower_pressures = {{postfix({100.0}), {}}};
  const std::vector<Vector> x = shaken(p.mesh.rest, 0.2, 3);
  const std::vector<Vector> all = forces_at(p, x, 0.0), elastic = reference::forces(p.material, p.mesh, x);
  EXPECT_GT(reference::enclosed_volume(p.mesh, x), 0.5);
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<Vector> more = x, less = x;
      more[i][axis] += 1e-4, less[i][axis] -= 1e-4;
      const double slope =
          (reference::enclosed_volume(p.mesh, more) - reference::enclosed_volume(p.mesh, less)) / 2e-4;
      EXPECT_NEAR(all[i][axis] - elastic[i][axis], 100.0 * slope, 1e-8);
    }
}

/// Error, m, at 1.7 s of a particle that starts at rest in (0, 2, 0): 0.5 x'' = y cos(3 t), with the exact
/// solution x = y (1 - cos(3 t)) / 4.5.
double driven_error(Integrator integrator, int steps) {
  Parameters p;
  p.mesh.rest = {{0, 2, 0}, {1, 3, 0}};
  p.mass = {0.5, 0.5};
  p.timed_loads = {{postfix({"y", 3.0, "t", "*", "cos", "*"}), {{1, 0, 0}, {0, 0, 0}}}};
  p.integrator = integrator;
  p.dt = 1.7 / steps;
  const State end = moved(p, {p.mesh.rest, still(2)}, steps);
  EXPECT_EQ(end.x[1], p.mesh.rest[1]) << "its direction is zero";
  return std::abs(end.x[0][0] - 2.0 * (1.0 - std::cos(3.0 * 1.7)) / 4.5);
}

TEST(FabricLoad, TimedLoadsPreserveTheOrderOfTheMethod) {
  // A load at a wrong time of the stages would reduce the order to one.
  EXPECT_NEAR(std::log2(driven_error(Integrator::rk4, 10) / driven_error(Integrator::rk4, 160)) / 4.0, 4.0,
              0.15);
  EXPECT_NEAR(std::log2(driven_error(Integrator::verlet, 20) / driven_error(Integrator::verlet, 320)) / 4.0,
              2.0, 0.05);
}

TEST(FabricLoad, TimeContinuesAcrossCallsAndStepChanges) {
  Parameters p;
  p.mesh.rest = {{0, 0, 0}};
  p.mass = {1.0};
  p.timed_loads = {{postfix({"t"}), {{6, 0, 0}}}};  // x = t^3
  p.dt = 0.125;
  const auto solver = create_solver(backend, p);
  std::vector<Vector> x = still(1), v = x;
  solver->upload(x, v);
  solver->enqueue_steps(3);
  solver->enqueue_steps(5);
  solver->set_dt(0.25);
  solver->enqueue_steps(4);
  solver->download(x, v);
  EXPECT_NEAR(x[0][0], 8.0, 1e-14);
  EXPECT_NEAR(v[0][0], 12.0, 1e-14);
}

// ---- dashpots ----

TEST(FabricDashpot, MatchesForcesOfTheReference) {
  // Without elastic forces, the velocity gained in a step of 1e-8 s gives the force of the dashpots.
  Parameters p = fabric(Model::biquadratic);
  p.material.membrane_modulus = 0.0, p.material.axial_stiffness = 0.0;
  p.relative_damping = 35.0;
  p.dt = 1e-8;
  const State start{shaken(p.mesh.rest, 0.2, 2), shaken(still(p.mass.size()), 3.0, 5)};
  const std::vector<Vector> f =
      reference::dashpot_forces(p.mesh, p.mass, p.relative_damping, start.x, start.v);
  for (const Integrator integrator : integrators) {
    p.integrator = integrator;
    const State end = moved(p, start, 1);
    for (std::size_t i = 0; i < p.mass.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR((end.v[i][axis] - start.v[i][axis]) / p.dt, f[i][axis] / p.mass[i], 2e-4);
  }
}

/// Error, m/s, of the relative velocity along an edge after 0.4 s, exp(-2) of the initial 1 m/s. Also expects
/// that the relative velocity of 3 m/s across the edge is unchanged.
double pair_error(Integrator integrator, int steps) {
  Parameters p;
  p.mesh.rest = {{0, 0, 0}, {1e6, 0, 0}};
  p.mesh.lines = {{0, 1}};
  p.mass = {0.3, 1.2};
  p.relative_damping = 5.0;
  p.integrator = integrator;
  p.dt = 0.4 / steps;
  const State end = moved(p, {p.mesh.rest, {{0, 0, 0}, {1, 3, 0}}}, steps);
  EXPECT_NEAR(end.v[1][1] - end.v[0][1], 3.0, 1e-5);
  return std::abs(end.v[1][0] - end.v[0][0] - std::exp(-2.0));
}

TEST(FabricDashpot, DampsRelativeVelocityAtItsRate) {
  EXPECT_LT(pair_error(Integrator::rk4, 40), 1e-5);
  EXPECT_LT(pair_error(Integrator::verlet, 4000), 1e-4);
  EXPECT_NEAR(std::log2(pair_error(Integrator::verlet, 40) / pair_error(Integrator::verlet, 320)) / 3.0, 1.0,
              0.05);
}

// ctest-label: no-sanitizer
TEST(FabricDashpot, ConservesMomentaAndDissipatesEnergy) {
  for (const Integrator integrator : integrators) {
    Parameters p = fabric(Model::biquadratic);
    p.integrator = integrator;
    p.relative_damping = 50.0;
    const auto solver = create_solver(backend, p);
    solver->upload(shaken(p.mesh.rest, 0.1, 1), shaken(still(p.mass.size()), 1.0, 2));
    const Totals before = solver->totals();
    EXPECT_TRUE(solver->enqueue_steps(2000));
    const Totals after = solver->totals();
    EXPECT_LT(after.energy(), 0.5 * before.energy());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(after.momentum[axis], before.momentum[axis], 1e-12);
      // Verlet applies both forces of a dashpot along one line, before it moves the vertices.
      EXPECT_NEAR(after.angular_momentum[axis], before.angular_momentum[axis],
                  integrator == Integrator::verlet ? 1e-11 : 1e-6);
    }
  }
}

TEST(FabricDashpot, DecayAndFrequencyLimitTheStableStep) {
  Parameters p;
  p.mesh.rest = {{0, 0, 0}, {1, 0, 0}};
  p.mesh.lines = {{0, 1}};
  p.mass = {0.5, 0.5};
  p.relative_damping = 200.0;
  p.dt = 1.0;
  const auto decays = [&](double dt) {
    p.dt = dt;
    const auto solver = create_solver(backend, p);
    solver->upload(p.mesh.rest, std::vector<Vector>{{0, 0, 0}, {1e-9, 0, 0}});
    if (!solver->enqueue_steps(600) || solver->failure()) return false;
    std::vector<Vector> x(2), v(2);
    solver->download(x, v);
    return std::abs(v[1][0] - v[0][0]) < 1e-8;
  };
  const auto decay = [&] { return create_solver(backend, p)->fastest_decay(); };
  EXPECT_NEAR(decay(), 200.0, 1e-12) << "exact for equal masses";
  EXPECT_TRUE(decays(stable_dt(p.integrator, 0.0, decay())));
  EXPECT_FALSE(decays(2.85 / 200.0));
  p.integrator = Integrator::verlet;
  EXPECT_TRUE(decays(stable_dt(p.integrator, 0.0, decay())));
  EXPECT_FALSE(decays(2.05 / 200.0));
  EXPECT_EQ(stable_dt(Integrator::verlet, 10.0, 0.0), 0.2);
  EXPECT_EQ(stable_dt(Integrator::verlet, 10.0, 20.0), 0.05);
  EXPECT_EQ(stable_dt(Integrator::rk4, 10.0, 0.0), stability_limit(Integrator::rk4) / 10.0);
  EXPECT_EQ(stable_dt(Integrator::rk4, 10.0, 20.0), 2.61 / 20.0);
  EXPECT_EQ(stable_dt(Integrator::verlet, 0.0, 0.0), INFINITY);
}

TEST(FabricLoad, PressureStiffnessRaisesTheFrequencyBound) {
  Parameters p = fabric(Model::biquadratic);
  const auto bound = [&] {
    const auto solver = create_solver(backend, p);
    solver->upload(p.mesh.rest, still(p.mass.size()));
    return solver->fastest_frequency();
  };
  const double without = bound();
  p.follower_pressures = {{postfix({5000.0}), {}}};
  EXPECT_GT(bound(), 1.2 * without);
  p.follower_pressures[0].strength = postfix({1e-6});
  EXPECT_NEAR(bound(), without, 1e-6 * without);
}

/// Fabric with damping, dashpots, and all quantities that depend on time: loads, pressures, motions.
Parameters fully_loaded(Integrator integrator) {
  Parameters p = fabric(Model::biquadratic);
  p.integrator = integrator;
  p.damping = 3.0, p.relative_damping = 20.0;
  p.follower_pressures = {{postfix({30.0, "x", "t", "*", "+"}), {}}};
  p.timed_loads = {{postfix({"t", "sin"}), shaken(still(p.mass.size()), 2.0, 9)}};
  p.motions = {{2, {0, 5}, postfix({"t", 0.1, "*", "sin"})}};
  return p;
}

State initial_state(const Parameters& p) {
  return {shaken(p.mesh.rest, 0.1, 1), shaken(still(p.mass.size()), 1.0, 2)};
}

TEST(FabricLoad, SplitCallsGiveIdenticalBits) {
  for (const Integrator integrator : integrators) {
    const Parameters p = fully_loaded(integrator);
    const State once = moved(p, initial_state(p), 300);
    const auto solver = create_solver(backend, p);
    State cut = initial_state(p);
    solver->upload(cut.x, cut.v);
    for (const std::int64_t steps : {1, 0, 5, 250, 44}) solver->enqueue_steps(steps);
    solver->download(cut.x, cut.v);
    EXPECT_EQ(once.x, cut.x);
    EXPECT_EQ(once.v, cut.v);
  }
}

TEST(FabricLoad, RestartsFromStateAndTimeWithIdenticalBits) {
  for (const Integrator integrator : integrators) {
    const Parameters p = fully_loaded(integrator);
    const auto first = create_solver(backend, p), second = create_solver(backend, p);
    State state = initial_state(p);
    first->upload(state.x, state.v);
    first->enqueue_steps(70);
    first->set_dt(0.9e-4);
    first->enqueue_steps(80);
    first->download(state.x, state.v);
    second->upload(state.x, state.v);
    second->set_time_state(first->time_state());
    first->enqueue_steps(150), second->enqueue_steps(150);
    State there = state;
    first->download(state.x, state.v);
    second->download(there.x, there.v);
    EXPECT_EQ(state.x, there.x);
    EXPECT_EQ(state.v, there.v);
    EXPECT_EQ(first->time_state().time(), second->time_state().time());
  }
}

TEST(FabricLoad, RejectsInvalidLoads) {
  const Parameters good = fabric(Model::biquadratic);
  const auto expect_rejected = [&](auto change) {
    Parameters p = good;
    change(p);
    EXPECT_THROW(static_cast<void>(create_solver(backend, p)), std::invalid_argument);
  };
  expect_rejected([](Parameters& p) { p.mesh.line_stiffness = {1.0}; });
  expect_rejected([](Parameters& p) { p.mesh.line_stiffness = {1.0, -1.0, 1.0, 1.0}; });
  expect_rejected([](Parameters& p) { p.relative_damping = -1.0; });
  expect_rejected([](Parameters& p) { p.timed_loads = {{postfix({"t"}), {Vector{}}}}; });
  expect_rejected([](Parameters& p) { p.timed_loads = {{{}, still(p.mass.size())}}; });
  expect_rejected([](Parameters& p) { p.follower_pressures = {{postfix({"t"}), {1.0}}}; });
  expect_rejected([](Parameters& p) { p.follower_pressures = {{{}, {}}}; });
}

}  // namespace
}  // namespace drogue::fabric
