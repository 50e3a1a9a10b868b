#include <gtest/gtest.h>

#include <cmath>
#include <span>

#include "kernels/fabric/solver.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/fabric_mesh.hpp"

// Failure of a state: its report and the restored checkpoint.

namespace drogue::fabric {
namespace {

using testing::random_patch;
using testing::shaken;

constexpr const auto& backend = testing::tested_backend;
struct StepMethod {
  Integrator integrator;
  Driver driver = Driver::automatic;
};
constexpr StepMethod all_methods[] = {{Integrator::rk4},
                                      {Integrator::verlet},
                                      {Integrator::rk4, Driver::graph},
                                      {Integrator::rk4, Driver::plain}};
/// The drivers differ on CUDA only.
const std::span<const StepMethod> methods(all_methods, backend == device::Backend::cuda ? 4 : 2);

/// A hundred vertices without elements.
Parameters free_vertices(const StepMethod& method) {
  Parameters p;
  p.mesh.rest.assign(100, Vector{});
  p.mass.assign(100, 1.0);
  p.integrator = method.integrator;
  p.driver = method.driver;
  p.dt = 0.1;
  return p;
}

TEST(FabricFailure, ReportsTheFirstFailedStepAndItsLowestVertex) {
  for (const StepMethod& method : methods) {
    const auto solver = create_solver(backend, free_vertices(method));
    const std::vector<Vector> x(100, Vector{});
    std::vector<Vector> v = x;
    v[20] = {0.0, -0.5e100, 0.0};         // overflows when 0.5 + 0.05 n reaches 1: at step 10
    v[83] = v[71] = {0.6e100, 0.0, 0.0};  // 0.6 + 0.06 n: at step 7
    solver->upload(x, v);
    EXPECT_TRUE(solver->enqueue_steps(6));
    EXPECT_FALSE(solver->failure());
    solver->enqueue_steps(20);
    const std::optional<StepFailure> failure = solver->failure();
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->index, 71);
    EXPECT_EQ(failure->step, 7);
    EXPECT_NEAR(failure->time + failure->dt, 0.7, 1e-15);
    EXPECT_EQ(solver->time_state().step, 0) << "the uploaded state is the last checkpoint";
  }
}

/// A patch and a separate vertex whose position overflows after about a thousand steps.
Parameters patch_and_escaping_vertex(const StepMethod& method) {
  Parameters p;
  p.mesh = random_patch(11, 8, 3);
  p.mesh.rest.push_back({0.0, 0.0, 5.0});
  p.material.axial_stiffness = 500.0;
  p.mass.assign(p.mesh.rest.size(), 0.01);
  p.integrator = method.integrator;
  p.driver = method.driver;
  p.dt = 1e-3;
  return p;
}

struct State {
  std::vector<Vector> x, v;
};

State state_of(Solver& solver, std::size_t n) {
  State s{std::vector<Vector>(n), std::vector<Vector>(n)};
  solver.download(s.x, s.v);
  return s;
}

std::unique_ptr<Solver> started(const Parameters& p) {
  auto solver = create_solver(backend, p);
  std::vector<Vector> v(p.mass.size(), Vector{});
  v.back() = {0.0, 0.0, 0.5e100};
  solver->upload(shaken(p.mesh.rest, 0.1, 4), v);
  return solver;
}

TEST(FabricFailure, RestoresTheLastCheckpoint) {
  for (const StepMethod& method : methods) {
    const Parameters p = patch_and_escaping_vertex(method);
    const auto solver = started(p);
    solver->enqueue_steps(700);
    solver->enqueue_steps(1700);
    const std::optional<StepFailure> failure = solver->failure();
    ASSERT_TRUE(failure);
    const TimeState clock = solver->time_state();
    EXPECT_EQ(failure->index, 91);
    EXPECT_NEAR(static_cast<double>(failure->step), 1000.0, 1.0);
    EXPECT_EQ(clock.step, 768) << "a multiple of 256";
    const State kept = state_of(*solver, p.mass.size());
    // A solver that stops at the checkpoint has the same bits.
    const auto stopped = started(p);
    EXPECT_TRUE(stopped->enqueue_steps(clock.step));
    const State there = state_of(*stopped, p.mass.size());
    EXPECT_EQ(kept.x, there.x);
    EXPECT_EQ(kept.v, there.v);
    // The step before the failure still succeeds.
    EXPECT_TRUE(stopped->enqueue_steps(failure->step - 1 - clock.step));
    EXPECT_FALSE(stopped->failure());
    EXPECT_FALSE(stopped->enqueue_steps(1) && !stopped->failure());
    EXPECT_EQ(stopped->failure()->index, failure->index);
    EXPECT_EQ(stopped->failure()->step, failure->step);
    // A failed solver takes no further steps.
    EXPECT_FALSE(solver->enqueue_steps(10));
    EXPECT_EQ(solver->time_state().step, clock.step);
    EXPECT_EQ(state_of(*solver, p.mass.size()).x, kept.x);
  }
}

TEST(FabricFailure, UploadClearsTheFailure) {
  const Parameters p = free_vertices({Integrator::verlet});
  const auto solver = create_solver(backend, p);
  std::vector<Vector> x(100, Vector{}), v = x;
  v[3] = {0.9e100, 0.0, 0.0};
  solver->upload(x, v);
  solver->enqueue_steps(5);
  ASSERT_TRUE(solver->failure());
  v[3] = {1.0, 0.0, 0.0};
  solver->upload(x, v);
  EXPECT_FALSE(solver->failure());
  EXPECT_TRUE(solver->enqueue_steps(5));
  solver->download(x, v);
  EXPECT_NEAR(x[3][0], 0.5, 1e-15);
}

TEST(FabricFailure, KeepsTheTimeOfTheRestoredCheckpoint) {
  const Parameters p = patch_and_escaping_vertex({Integrator::rk4});
  const auto solver = started(p);
  solver->enqueue_steps(2400);
  solver->set_dt(2e-3);
  EXPECT_EQ(solver->time_state().step, 768);
  EXPECT_NEAR(solver->time_state().time(), 0.768, 1e-13);
  EXPECT_FALSE(solver->enqueue_steps(1));
}

TEST(FabricFailure, RejectsNonFiniteAndOverflowingStates) {
  const auto solver = create_solver(backend, free_vertices({Integrator::rk4}));
  const std::vector<Vector> good(100, Vector{});
  for (const double wrong : {std::nan(""), static_cast<double>(INFINITY), -1e101}) {
    std::vector<Vector> bad = good;
    bad[99][2] = wrong;
    EXPECT_THROW(solver->upload(bad, good), std::invalid_argument);
    EXPECT_THROW(solver->upload(good, bad), std::invalid_argument);
  }
}

// ---- time ----

TEST(FabricTimeState, CountsStepsAndKeepsTimeWhenTheStepChanges) {
  const auto solver = create_solver(backend, free_vertices({Integrator::rk4}));
  std::vector<Vector> x(100, Vector{}), v(100, Vector{1.0, 0.0, 0.0});
  solver->upload(x, v);
  solver->enqueue_steps(5);
  EXPECT_EQ(solver->time_state().step, 5);
  EXPECT_NEAR(solver->time_state().time(), 0.5, 1e-15);
  solver->set_dt(0.25);
  solver->enqueue_steps(2);
  EXPECT_EQ(solver->time_state().step, 7);
  EXPECT_NEAR(solver->time_state().time(), 1.0, 1e-15);
  solver->download(x, v);
  EXPECT_NEAR(x[50][0], 1.0, 1e-15);
  for (const double wrong : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(solver->set_dt(wrong), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::fabric
