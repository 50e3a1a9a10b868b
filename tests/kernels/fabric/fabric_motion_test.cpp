#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/fabric/solver.hpp"
#include "kernels/reference/fabric/membrane.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/expression_program.hpp"
#include "tests/support/fabric_mesh.hpp"

// Motion of vertices: orders of accuracy, conservation, stability limits, pins, and damping.

namespace drogue::fabric {
namespace {

using testing::random_patch;
using testing::shaken;

constexpr const auto& backend = testing::tested_backend;

struct State {
  std::vector<Vector> x, v;
};

State moved(const Parameters& p, State state, std::int64_t steps) {
  const auto solver = create_solver(backend, p);
  solver->upload(state.x, state.v);
  solver->enqueue_steps(steps);
  solver->download(state.x, state.v);
  return state;
}

/// Two masses of 2 kg at the ends of a string of 1 m and 25 N: they oscillate at 5 rad/s about their middle.
Parameters oscillator(Integrator integrator, double dt) {
  Parameters p;
  p.mesh.rest = {{0, 0, 0}, {1, 0, 0}};
  p.mesh.lines = {{0, 1}};
  p.material.axial_stiffness = 25.0;
  p.mass = {2.0, 2.0};
  p.integrator = integrator;
  p.dt = dt;
  return p;
}

/// Error of the elongation 0.2 cos(5 t), m, at t = 4 pi / 5 + 0.1 s.
double oscillator_error(Integrator integrator, int steps) {
  const double end = 0.8 * std::numbers::pi + 0.1;
  const State start{{{-0.1, 0, 0}, {1.1, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}};
  const State now = moved(oscillator(integrator, end / steps), start, steps);
  return std::abs(now.x[1][0] - now.x[0][0] - 1.0 - 0.2 * std::cos(5.0 * end));
}

TEST(FabricMotion, DriversAgree) {
  if (backend != device::Backend::cuda) GTEST_SKIP() << "hosts have one driver";
  Parameters p;
  p.mesh = random_patch(70, 60, 3);
  p.material.axial_stiffness = 300.0;
  p.mass.assign(p.mesh.rest.size(), 0.01);
  p.gravity = {0.0, 0.0, -9.81};
  p.dt = 1e-4;
  const State start{shaken(p.mesh.rest, 0.1, 1), std::vector<Vector>(p.mass.size(), Vector{})};
  p.driver = Driver::plain;
  const State expected = moved(p, start, 300);
  const auto expect_same = [&](Driver driver, int patch_size, const std::string& name) {
    p.driver = driver, p.patch = patch_size;
    EXPECT_EQ(create_solver(backend, p)->driver(), name);
    const State now = moved(p, start, 300);
    for (std::size_t i = 0; i < now.x.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(now.x[i][axis], expected.x[i][axis], 1e-9);
  };
  expect_same(Driver::graph, 0, "graph");
  // Every stage evaluates a timed load, even if it is zero.
  p.timed_loads = {{testing::postfix({0.0}), std::vector<Vector>(p.mass.size(), Vector{})}};
  expect_same(Driver::plain, 0, "plain");
  p.timed_loads.clear();
  expect_same(Driver::automatic, 0, "persistent");
  expect_same(Driver::persistent, 500, "persistent");
  p.relative_damping = 1.0;
  EXPECT_STREQ(create_solver(backend, p)->driver(), "graph");
}

double order(Integrator integrator) {
  return std::log2(oscillator_error(integrator, 100) / oscillator_error(integrator, 1600)) / 4.0;
}

TEST(FabricMotion, RungeKuttaIsOfFourthOrder) { EXPECT_NEAR(order(Integrator::rk4), 4.0, 0.1); }

// ctest-label: no-sanitizer
TEST(FabricMotion, VerletIsOfSecondOrder) { EXPECT_NEAR(order(Integrator::verlet), 2.0, 0.05); }

double energy_of(const Parameters& p, const State& s) {
  double sum = reference::energy(p.material, p.mesh, s.x);
  for (std::size_t i = 0; i < s.v.size(); ++i)
    for (const double v : s.v[i]) sum += 0.5 * p.mass[i] * v * v;
  return sum;
}

// ctest-label: no-sanitizer
TEST(FabricMotion, RungeKuttaDissipatesEnergyByItsAmplificationFactor) {
  // |G|^2 = 1 - z^6/72 + z^8/576 with z = omega dt.
  const State start{{{-0.1, 0, 0}, {1.1, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}};
  for (const double z : {0.2, 0.5, 1.0}) {
    const Parameters p = oscillator(Integrator::rk4, z / 5.0);
    const int steps = 200;
    const double energy_ratio = energy_of(p, moved(p, start, steps)) / energy_of(p, start);
    const double expected = std::pow(1.0 - std::pow(z, 6) / 72.0 + std::pow(z, 8) / 576.0, steps);
    EXPECT_NEAR(energy_ratio, expected, 1e-10);
  }
}

// ctest-label: no-sanitizer
TEST(FabricMotion, VerletBoundsTheEnergyError) {
  const State start{{{-0.1, 0, 0}, {1.1, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}};
  const Parameters p = oscillator(Integrator::verlet, 0.2 / 5.0);
  const auto solver = create_solver(backend, p);
  solver->upload(start.x, start.v);
  double least = 1.0, most = 1.0;
  for (int k = 0; k < 100; ++k) {
    solver->enqueue_steps(1000);
    State now = start;
    solver->download(now.x, now.v);
    const double energy_ratio = energy_of(p, now) / energy_of(p, start);
    least = std::min(least, energy_ratio), most = std::max(most, energy_ratio);
  }
  EXPECT_GT(least, 1.0 - 0.2 * 0.2 / 4.0);
  EXPECT_LT(most, 1.0 + 0.2 * 0.2 / 4.0);
}

TEST(FabricMotion, EnergyGrowsBeyondTheStabilityLimit) {
  const State start{{{-0.1, 0, 0}, {1.1, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}};
  const auto grows = [&](Integrator integrator, double z) {
    const Parameters p = oscillator(integrator, z / 5.0);
    return energy_of(p, moved(p, start, 400)) > 10.0 * energy_of(p, start);
  };
  EXPECT_FALSE(grows(Integrator::rk4, 2.82));
  EXPECT_TRUE(grows(Integrator::rk4, 2.86));
  EXPECT_FALSE(grows(Integrator::verlet, 1.99));
  EXPECT_TRUE(grows(Integrator::verlet, 2.01));
  // Near the limit, the energy of the symplectic Euler method oscillates by a factor of 1 / (1 - z^2 / 4).
  EXPECT_FALSE(grows(Integrator::symplectic_euler, 1.8));
  EXPECT_TRUE(grows(Integrator::symplectic_euler, 2.01));
}

Parameters patch(Model model, Integrator integrator) {
  Parameters p;
  p.mesh = random_patch(11, 8, 3);
  p.material.model = model;
  p.material.axial_stiffness = 500.0;
  for (std::size_t i = 0; i < p.mesh.rest.size(); ++i)
    p.mass.push_back(0.01 + 0.001 * static_cast<double>(i % 7));
  p.integrator = integrator;
  p.dt = 2e-4;
  return p;
}

/// Change of the linear momentum, kg m/s, and of the angular momentum, kg m^2/s, of a free patch in 0.1 s:
/// the largest components.
std::pair<double, double> momenta_gained(Parameters p, std::int64_t steps) {
  p.dt = 0.1 / static_cast<double>(steps);
  const State start{shaken(p.mesh.rest, 0.1, 1),
                    shaken(std::vector<Vector>(p.mesh.rest.size(), Vector{}), 1.0, 2)};
  const State end = moved(p, start, steps);
  std::pair<double, double> gained{0.0, 0.0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t next = (axis + 1) % 3, after = (axis + 2) % 3;
    double momentum = 0.0, angular = 0.0;
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      momentum += p.mass[i] * (end.v[i][axis] - start.v[i][axis]);
      angular += p.mass[i] * (end.x[i][next] * end.v[i][after] - end.x[i][after] * end.v[i][next] -
                              start.x[i][next] * start.v[i][after] + start.x[i][after] * start.v[i][next]);
    }
    gained.first = std::max(gained.first, std::abs(momentum));
    gained.second = std::max(gained.second, std::abs(angular));
  }
  return gained;
}

// ctest-label: no-sanitizer
TEST(FabricMotion, ConservesMomentaOfAFreePatch) {
  for (const Model model : {Model::edge, Model::quadratic, Model::biquadratic}) {
    for (const Integrator integrator : {Integrator::verlet, Integrator::symplectic_euler}) {
      const auto [momentum, angular] = momenta_gained(patch(model, integrator), 500);
      EXPECT_LT(momentum, 1e-12);
      EXPECT_LT(angular, 1e-11);
    }
    // The Runge-Kutta method conserves angular momentum to its order of accuracy.
    const auto coarse = momenta_gained(patch(model, Integrator::rk4), 1000);
    const auto fine = momenta_gained(patch(model, Integrator::rk4), 2000);
    EXPECT_LT(coarse.first, 1e-12);
    EXPECT_GT(std::log2(coarse.second / fine.second), 3.8) << coarse.second;
  }
}

/// The velocities of the symplectic Euler method are those of Verlet's half a step before.
TEST(FabricMotion, SymplecticEulerFollowsVerletFromALaggingVelocity) {
  for (const Model model : {Model::linear_vector, Model::edge, Model::quadratic, Model::biquadratic}) {
    Parameters p = patch(model, Integrator::verlet);
    p.gravity = {1.0, 0.0, -9.81};
    const State start{shaken(p.mesh.rest, 0.1, 1), std::vector<Vector>(p.mass.size(), Vector{})};
    State lagging = start;
    const auto solver = create_solver(backend, p);
    solver->upload(start.x, start.v);
    std::vector<Vector> force(p.mass.size());
    solver->forces(force);
    for (std::size_t i = 0; i < force.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        lagging.v[i][axis] = -0.5 * p.dt * (force[i][axis] / p.mass[i] + p.gravity[axis]);
    const State verlet = moved(p, start, 100);
    p.integrator = Integrator::symplectic_euler;
    const State euler = moved(p, lagging, 100);
    for (std::size_t i = 0; i < force.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(euler.x[i][axis], verlet.x[i][axis], 1e-11) << static_cast<int>(model);
  }
}

TEST(FabricMotion, SplitCallsGiveIdenticalBits) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::verlet, Integrator::symplectic_euler}) {
    Parameters p = patch(Model::biquadratic, integrator);
    p.damping = 40.0;
    p.gravity = {0.0, 0.0, -9.81};
    State once{shaken(p.mesh.rest, 0.1, 1), shaken(std::vector<Vector>(p.mass.size(), Vector{}), 1.0, 2)},
        cut = once;
    once = moved(p, once, 17);
    for (const std::int64_t steps : {1, 0, 5, 3, 8}) cut = moved(p, cut, steps);
    EXPECT_EQ(once.x, cut.x);
    EXPECT_EQ(once.v, cut.v);
  }
}

TEST(FabricMotion, PinnedAxesKeepTheirVelocityAndOthersFall) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::verlet, Integrator::symplectic_euler}) {
    Parameters p = patch(Model::biquadratic, integrator);
    p.gravity = {0.0, 0.0, -10.0};
    p.damping = 3.0;
    p.pinned.assign(p.mass.size(), 0);
    p.pinned[5] = 7;
    p.pinned[9] = 2;
    State start{p.mesh.rest, std::vector<Vector>(p.mass.size(), Vector{})};
    start.v[5] = {0.5, -0.25, 1.0};
    const State end = moved(p, start, 100);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(end.v[5][axis], start.v[5][axis]);
      // Rounding of a hundred sums.
      EXPECT_NEAR(end.x[5][axis], start.x[5][axis] + 0.02 * start.v[5][axis], 100 * 2.2e-16 * 8.0);
    }
    EXPECT_EQ(end.x[9][1], start.x[9][1]);
    EXPECT_NE(end.x[9][0], start.x[9][0]);
    EXPECT_LT(end.x.back()[2], start.x.back()[2] - 1e-3);
  }
}

TEST(FabricMotion, DampedFallMatchesTheClosedForm) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::verlet}) {
    Parameters p;
    p.mesh.rest = {{0, 0, 0}};
    p.mass = {0.3};
    p.gravity = {0.0, 1.0, -9.81};
    p.damping = 2.0;
    p.integrator = integrator;
    p.dt = 1e-3;
    const State end = moved(p, {{{0, 0, 0}}, {{1.0, 0, 0}}}, 1000);
    const double decay = std::exp(-2.0), tolerance = integrator == Integrator::rk4 ? 1e-12 : 1e-6;
    EXPECT_NEAR(end.v[0][0], decay, tolerance);
    EXPECT_NEAR(end.v[0][2], -9.81 / 2.0 * (1.0 - decay), 5 * tolerance);
    EXPECT_NEAR(end.x[0][1], 0.5 * (1.0 - 0.5 * (1.0 - decay)), 2 * tolerance);
  }
}

}  // namespace
}  // namespace drogue::fabric
