#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernels/fabric/payload.hpp"
#include "kernels/fabric/solver.hpp"
#include "tests/support/backend.hpp"

// Largest forces of lines on vertices, in every step.

namespace drogue::fabric {
namespace {

constexpr const auto& backend = testing::tested_backend;

struct Case {
  Parameters parameters;
  std::vector<Pull> pulls;
  std::vector<Vector> positions, velocities;
};

/// A payload that falls into two slanted lines, and a third line that pulls it to the side.
Case falling_payload() {
  Case made;
  Parameters& p = made.parameters;
  p.mesh.rest = {{-1.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, {0.0, 2.0, 0.0}, {0.0, 0.0, 0.0}};
  p.mesh.lines = {{0, 3}, {3, 1}, {2, 3}};
  p.mesh.line_stiffness = {400.0, 300.0, 50.0};
  p.mass = {1.0, 1.0, 1.0, 0.5};
  p.pinned = {7, 7, 7, 0};
  p.gravity = {0.0, 0.0, -9.81};
  p.material.tension_only = true;
  p.integrator = Integrator::verlet;
  p.dt = 1e-3;
  made.pulls = {{3, {0, 1}}, {3, {2}}, {3, {}}};
  made.positions = p.mesh.rest;
  made.velocities = {{}, {}, {}, {0.0, -0.3, -2.0}};
  return made;
}

/// Force of a pull, from its definition.
double force_of(const Parameters& p, const Pull& pull, const std::vector<Vector>& x) {
  Vector sum{};
  const auto& payload = x[static_cast<std::size_t>(pull.vertex)];
  for (const int line : pull.lines) {
    const auto k = static_cast<std::size_t>(line);
    const int other = p.mesh.lines[k][0] == pull.vertex ? p.mesh.lines[k][1] : p.mesh.lines[k][0];
    const auto at = [&](const std::vector<Vector>& places) {
      const Vector &a = places[static_cast<std::size_t>(other)],
                   &b = places[static_cast<std::size_t>(pull.vertex)];
      return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    };
    const double length = at(x),
                 tension = std::max(0.0, p.mesh.line_stiffness[k] * (length / at(p.mesh.rest) - 1.0));
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum[axis] += tension * (x[static_cast<std::size_t>(other)][axis] - payload[axis]) / length;
  }
  return std::hypot(sum[0], sum[1], sum[2]);
}

TEST(FabricPulls, PeaksAreThoseOfAllStepsHoweverTheyAreTaken) {
  const Case made = falling_payload();
  for (const bool contact : {false, true})
    for (const std::int64_t batch : {1, 7, 400}) {
      Parameters p = made.parameters;
      if (contact) p.contact.bodies = {{BodyKind::sphere, {0.0, 0.0, -50.0}, {0.0, 0.0, 1.0}, 1.0, {}, 0.0}};
      const auto solver = create_solver(backend, p), observed = create_solver(backend, p);
      solver->upload(made.positions, made.velocities);
      observed->upload(made.positions, made.velocities);
      solver->watch_pulls(made.pulls);
      std::vector<PeakPull> expected(made.pulls.size());
      std::vector<Vector> x(made.positions.size()), v(x.size());
      for (int step = 1; step <= 400; ++step) {
        observed->enqueue_steps(1);
        observed->download(x, v);
        for (std::size_t k = 0; k < expected.size(); ++k)
          if (const double force = force_of(p, made.pulls[k], x); force > expected[k].force)
            expected[k] = {force, observed->time_state().time()};
      }
      for (std::int64_t done = 0; done < 400; done += batch)
        solver->enqueue_steps(std::min(batch, 400 - done));
      const std::vector<PeakPull> peaks = solver->peak_pulls();
      ASSERT_EQ(peaks.size(), 3U);
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_GT(expected[k].force, 0.5);
        EXPECT_NEAR(peaks[k].force, expected[k].force, 1e-12 * expected[k].force);
        EXPECT_DOUBLE_EQ(peaks[k].time, expected[k].time);
      }
      EXPECT_EQ(peaks[2].force, 0.0);
    }
}

TEST(FabricPulls, StartWithThePresentStateAndForgetLinesThatAreCut) {
  Case made = falling_payload();
  made.positions[3] = {0.0, 0.0, -0.5};  // taut
  made.velocities.assign(4, {});
  const auto solver = create_solver(backend, made.parameters);
  solver->upload(made.positions, made.velocities);
  solver->watch_pulls(made.pulls);
  const double taut = force_of(made.parameters, made.pulls[0], made.positions);
  EXPECT_NEAR(solver->peak_pulls()[0].force, taut, 1e-12 * taut);
  std::vector<double> state = solver->download_state();
  std::ranges::copy(std::vector{1e-3, 5.0, 0.0, 0.0, 0.25, 0.0},
                    state.end() - 6);  // three forces, three times
  solver->upload_state(state);
  EXPECT_EQ(solver->download_state(), state);
  solver->set_line_stiffness(std::vector<double>(3, 0.0));
  solver->enqueue_steps(50);
  EXPECT_EQ(solver->peak_pulls()[0].force, 1e-3);
  EXPECT_EQ(solver->peak_pulls()[1].force, 5.0);
  EXPECT_EQ(solver->peak_pulls()[1].time, 0.25);
}

TEST(FabricPulls, ForgetStepsThatAreRolledBack) {
  Case made = falling_payload();
  made.parameters.dt = 10.0;  // unstable
  const auto solver = create_solver(backend, made.parameters);
  made.positions[3] = {0.0, 0.0, -0.5};
  solver->upload(made.positions, made.velocities);
  solver->watch_pulls(made.pulls);
  const double taut = force_of(made.parameters, made.pulls[0], made.positions);
  solver->enqueue_steps(200);
  ASSERT_TRUE(solver->failure().has_value());
  std::vector<Vector> x(made.positions.size()), v(x.size());
  solver->download(x, v);
  EXPECT_EQ(x, made.positions);
  EXPECT_NEAR(solver->peak_pulls()[0].force, taut, 1e-12 * taut);
}

TEST(FabricPulls, RefuseLinesThatDoNotPullTheirVertexAndStepsThatContactChangesLater) {
  Case made = falling_payload();
  const auto solver = create_solver(backend, made.parameters);
  EXPECT_THROW(solver->watch_pulls(std::vector<Pull>{{0, {1}}}), std::invalid_argument);
  EXPECT_THROW(solver->watch_pulls(std::vector<Pull>{{3, {3}}}), std::invalid_argument);
  const std::vector<double> without = solver->download_state();
  solver->watch_pulls(made.pulls);
  EXPECT_THROW(solver->upload_state(without), std::invalid_argument);
  made.parameters.contact.self = true;
  made.parameters.contact.interval = 2;
  EXPECT_THROW(create_solver(backend, made.parameters)->watch_pulls(made.pulls), std::invalid_argument);
  made.parameters.contact.self = false;
  EXPECT_NO_THROW(create_solver(backend, made.parameters)->watch_pulls(made.pulls));
  made.parameters.integrator = Integrator::rk4;
  EXPECT_THROW(create_solver(backend, made.parameters)->watch_pulls(made.pulls), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::fabric
