#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "kernels/fabric/fabric_solver.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/expression_program.hpp"
#include "tests/support/fabric_mesh.hpp"
#include "tests/support/profiled.hpp"

// Pins whose motion is prescribed by kernels that write device Views.

namespace drogue::fabric {
namespace {

using device::ProfilingCounters;
using testing::postfix;
using testing::shaken;

using Space = DROGUE_TEST_SPACE;
using Points = PointsView<Space>;
constexpr std::size_t pinned_vertices[] = {0, 10};

struct Method {
  Integrator integrator;
  Driver driver;
};
constexpr Method methods[] = {{Integrator::rk4, Driver::plain},
                              {Integrator::rk4, Driver::graph},
                              {Integrator::rk4, Driver::stages},
                              {Integrator::rk4, Driver::automatic},
                              {Integrator::verlet, Driver::plain}};

/// Damped sheet with dashpots, so that forces depend on the velocities of the pins. Two corners are pinned.
Parameters pinned_sheet(const Method& method) {
  Parameters p;
  p.mesh = testing::random_patch(11, 9, 3);
  p.material.axial_stiffness = 50.0;
  p.mass.assign(p.mesh.rest.size(), 0.01);
  p.pinned.assign(p.mass.size(), 0);
  for (const std::size_t i : pinned_vertices) p.pinned[i] = 7;
  p.gravity = {0.0, 0.0, -9.81};
  p.relative_damping = 0.5;
  p.integrator = method.integrator;
  p.driver = method.driver;
  p.dt = 1e-4;
  return p;
}

struct SheetState {
  std::vector<Vector> x, v;
};

SheetState initial_state(const Parameters& p) {
  return {shaken(p.mesh.rest, 0.05, 1), std::vector<Vector>(p.mass.size(), Vector{})};
}

SheetState downloaded(FabricSolver<Space>& solver) {
  const auto n = static_cast<std::size_t>(solver.vertices());
  SheetState state{std::vector<Vector>(n), std::vector<Vector>(n)};
  solver.download(state.x, state.v);
  return state;
}

double largest_difference(const std::vector<Vector>& a, const std::vector<Vector>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      largest = std::max(largest, std::abs(a[i][axis] - b[i][axis]));
  return largest;
}

/// Sets the motion of all pins along x at `time`, s.
struct SetMotionFunctor {
  PrescribedMotion<Space> motion;
  double displacement, velocity, acceleration, time;

  KOKKOS_FUNCTION void operator()(const int i) const {
    motion.displacement(i, 0) = displacement;
    motion.velocity(i, 0) = velocity;
    motion.acceleration(i, 0) = acceleration;
    if (i == 0) motion.time() = time;
  }
};

void set_motion(const Space& space, const PrescribedMotion<Space>& motion, double displacement,
                double velocity, double acceleration, double time) {
  Kokkos::parallel_for("set motion",
                       Kokkos::RangePolicy<Space>(space, 0, static_cast<int>(motion.velocity.extent(0))),
                       SetMotionFunctor{motion, displacement, velocity, acceleration, time});
}

/// Initial state in which the pins are at rest positions and move along x at `velocity`, m/s.
SheetState with_moving_pins(const Parameters& p, double velocity) {
  SheetState state = initial_state(p);
  for (const std::size_t i : pinned_vertices) state.x[i] = p.mesh.rest[i], state.v[i] = {velocity, 0.0, 0.0};
  return state;
}

/// State after `steps` steps in which an expression moves the pins along x, first at `velocity`, m/s.
SheetState moved_by_expression(const Space& space, Parameters p,
                               const device::ExpressionProgram& displacement, double velocity,
                               std::int64_t steps) {
  for (const std::size_t i : pinned_vertices) p.motions.push_back({0, {static_cast<int>(i)}, displacement});
  const SheetState state = with_moving_pins(p, velocity);
  FabricSolver<Space> solver(space, p);
  solver.upload(state.x, state.v);
  EXPECT_TRUE(solver.enqueue_steps(steps));
  return downloaded(solver);
}

void start(FabricSolver<Space>& solver, const Parameters& p, double velocity) {
  const SheetState state = with_moving_pins(p, velocity);
  solver.upload(state.x, state.v);
}

TEST(FabricPins, PinsMatchAnExpressionInEveryDriver) {
  const device::Instance<Space> instance(1);
  const Space& space = instance.space();
  for (const Method& method : methods) {
    const Parameters p = pinned_sheet(method);
    FabricSolver<Space> solver(space, p);
    start(solver, p, 0.3);
    set_motion(space, solver.prescribed_motion(), 0.0, 0.3, 4.0, 0.0);
    const ProfilingCounters before = testing::profiled();
    EXPECT_TRUE(solver.enqueue_steps(200));
    const ProfilingCounters after = testing::profiled();
    EXPECT_EQ(after.fences, before.fences);
    EXPECT_EQ(after.copies, before.copies);
    const SheetState by_views = downloaded(solver);
    const SheetState expected =
        moved_by_expression(space, p, postfix({"t", 0.3, "*", "t", "t", "*", 2.0, "*", "+"}), 0.3, 200);
    // The solver differentiates expressions numerically, hence the wider tolerance of velocities.
    EXPECT_LT(largest_difference(by_views.x, expected.x), 1e-12) << solver.driver();
    EXPECT_LT(largest_difference(by_views.v, expected.v), 1e-9) << solver.driver();
    const double t = 200 * p.dt;
    for (const std::size_t i : pinned_vertices) {
      EXPECT_NEAR(by_views.x[i][0], p.mesh.rest[i][0] + 0.3 * t + 2.0 * t * t, 1e-15);
      EXPECT_NEAR(by_views.v[i][0], 0.3 + 4.0 * t, 1e-14);
      EXPECT_EQ(by_views.x[i][1], p.mesh.rest[i][1]);
    }
  }
}

TEST(FabricPins, PinsFollowViewsThatAKernelWritesBeforeEachStep) {
  const device::Instance<Space> instance(1);
  const Space& space = instance.space();
  const double amplitude = 0.1, omega = 40.0;
  for (const Method& method : methods) {
    const Parameters p = pinned_sheet(method);
    FabricSolver<Space> solver(space, p);
    start(solver, p, amplitude * omega);
    const PrescribedMotion<Space> motion = solver.prescribed_motion();
    const int steps = 300;
    for (int k = 0; k < steps; ++k) {
      const double t = k * p.dt, sine = std::sin(omega * t), cosine = std::cos(omega * t);
      set_motion(space, motion, amplitude * sine, amplitude * omega * cosine,
                 -amplitude * omega * omega * sine, t);
      solver.enqueue_steps(1);
    }
    EXPECT_FALSE(solver.failure());
    const SheetState by_views = downloaded(solver);
    const SheetState expected = moved_by_expression(
        space, p, postfix({amplitude, omega, "t", "*", "sin", "*"}), amplitude * omega, steps);
    // Views omit the third derivative of the motion within a step.
    const double jerk = amplitude * omega * omega * omega;
    EXPECT_LT(largest_difference(by_views.x, expected.x), jerk * std::pow(p.dt, 3)) << solver.driver();
    EXPECT_LT(largest_difference(by_views.v, expected.v), 10.0 * jerk * p.dt * p.dt) << solver.driver();
    EXPECT_GT(std::abs(by_views.x[0][0] - p.mesh.rest[0][0]), 0.02);
  }
}

TEST(FabricPins, PinsKeepTheirVelocityUntilViewsAreWritten) {
  const device::Instance<Space> instance(1);
  const Space& space = instance.space();
  for (const Method& method : methods) {
    const Parameters p = pinned_sheet(method);
    FabricSolver<Space> solver(space, p), without(space, p);
    SheetState state = initial_state(p);
    for (const std::size_t i : pinned_vertices) state.v[i] = {0.5, -0.25, 2.0};
    for (FabricSolver<Space>* each : {&solver, &without}) {
      each->upload(state.x, state.v);
      each->enqueue_steps(20);
    }
    const PrescribedMotion<Space> motion = solver.prescribed_motion();
    EXPECT_EQ(motion.displacement.extent(0), p.mass.size());
    EXPECT_STRNE(solver.driver(), "persistent");
    for (FabricSolver<Space>* each : {&solver, &without}) each->enqueue_steps(20);
    const SheetState a = downloaded(solver), b = downloaded(without);
    EXPECT_LT(largest_difference(a.x, b.x), 1e-13);
    for (const std::size_t i : pinned_vertices)
      EXPECT_NEAR(a.x[i][2], state.x[i][2] + 40 * p.dt * 2.0, 1e-13);
  }
}

TEST(FabricPins, PinsDoNotMoveFreeAxesOrAxesOfExpressions) {
  const device::Instance<Space> instance(1);
  const Space& space = instance.space();
  Parameters p = pinned_sheet({Integrator::rk4, Driver::automatic});
  p.pinned[10] = 6;
  p.motions = {{0, {0}, postfix({"t"})}};
  FabricSolver<Space> solver(space, p);
  start(solver, p, 0.0);
  set_motion(space, solver.prescribed_motion(), 5.0, 0.0, 0.0, 0.0);
  solver.enqueue_steps(10);
  const SheetState now = downloaded(solver);
  EXPECT_NEAR(now.x[0][0], p.mesh.rest[0][0] + 10 * p.dt, 1e-15);
  EXPECT_NEAR(now.x[10][0], p.mesh.rest[10][0], 0.1);
}

TEST(FabricPins, PinsAreAtRestIfViewsAreRequestedBeforeTheFirstUpload) {
  const device::Instance<Space> instance(1);
  for (const Method& method : methods) {
    const Parameters p = pinned_sheet(method);
    FabricSolver<Space> solver(instance.space(), p);
    static_cast<void>(solver.prescribed_motion());
    const SheetState state = initial_state(p);
    solver.upload(state.x, state.v);
    const SheetState now = downloaded(solver);
    for (const std::size_t i : pinned_vertices) EXPECT_EQ(now.x[i], p.mesh.rest[i]);
  }
}

TEST(FabricPins, FailureBeforeTheFirstUploadReturnsToRest) {
  const device::Instance<Space> instance(1);
  for (const Method& method : methods) {
    Parameters p = pinned_sheet(method);
    p.motions = {{0, {40}, postfix({-1.0, "sqrt"})}};
    FabricSolver<Space> solver(instance.space(), p);
    solver.enqueue_steps(3);
    const auto failure = solver.failure();
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->step, 1);
    EXPECT_EQ(solver.time_state().step, 0);
    EXPECT_EQ(largest_difference(downloaded(solver).x, p.mesh.rest), 0.0);
  }
}

TEST(FabricPins, RejectsPrescribedMotionWithoutPins) {
  const device::Instance<Space> instance(1);
  Parameters p = pinned_sheet({Integrator::rk4, Driver::automatic});
  p.pinned.assign(p.mass.size(), 0);
  p.motions = {{0, {0}, postfix({"t"})}};
  FabricSolver<Space> solver(instance.space(), p);
  EXPECT_THROW(static_cast<void>(solver.prescribed_motion()), std::logic_error);
}

}  // namespace
}  // namespace drogue::fabric
