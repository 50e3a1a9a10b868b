#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kernels/fabric/payload.hpp"
#include "kernels/fabric/solver.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/expression_program.hpp"
#include "tests/support/fabric_mesh.hpp"

// Payloads on suspension lines.

namespace drogue::fabric {
namespace {

using testing::postfix;
using testing::shaken;

constexpr const auto& backend = testing::tested_backend;
constexpr double gravity = 9.81;

struct HungPayload {
  Parameters parameters;
  int vertex;
  double stiffness;   ///< N/m, of all lines together
  double elongation;  ///< m, in equilibrium
};

/// A payload of 2 kg on three parallel lines of 1.5 m from a pinned point.
HungPayload hung_payload(Integrator integrator) {
  HungPayload hung;
  Parameters& p = hung.parameters;
  p.mesh.rest.assign(3, {0.2, -0.1, 4.0});
  p.mass.assign(3, 1.0);
  p.pinned.assign(3, 7);
  p.gravity = {0.0, 0.0, -gravity};
  p.integrator = integrator;
  p.dt = 1e-3;
  const int anchors[] = {0, 1, 2};
  hung.vertex = add_payload(p, {{0.2, -0.1, 2.5}, 2.0, 300.0}, anchors);
  hung.stiffness = 3.0 * 300.0 / 1.5;
  hung.elongation = 2.0 * gravity / hung.stiffness;
  return hung;
}

TEST(FabricPayload, RestsAtTheStaticElongationOfItsLines) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::verlet}) {
    const HungPayload hung = hung_payload(integrator);
    const auto i = static_cast<std::size_t>(hung.vertex);
    const auto solver = create_solver(backend, hung.parameters);
    std::vector<Vector> x = hung.parameters.mesh.rest, v(x.size());
    x[i][2] -= hung.elongation;
    const Vector equilibrium = x[i];
    solver->upload(x, v);
    std::vector<Vector> force(x.size());
    solver->forces(force);
    EXPECT_NEAR(force[i][2], 2.0 * gravity, 1e-12);
    ASSERT_TRUE(solver->enqueue_steps(1000) && !solver->failure());
    solver->download(x, v);
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(x[i][axis], equilibrium[axis], 1e-13);
  }
}

TEST(FabricPayload, OscillatesOnItsLinesWithTheFrequencyOfTheClosedForm) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::verlet}) {
    const HungPayload hung = hung_payload(integrator);
    const auto i = static_cast<std::size_t>(hung.vertex);
    const auto solver = create_solver(backend, hung.parameters);
    std::vector<Vector> x = hung.parameters.mesh.rest, v(x.size());
    // A start at rest without tension gives an amplitude equal to the static elongation.
    solver->upload(x, v);
    ASSERT_TRUE(solver->enqueue_steps(1700) && !solver->failure());
    solver->download(x, v);
    const double omega = std::sqrt(hung.stiffness / 2.0), phase = omega * 1.7;
    const double exact = 2.5 - hung.elongation * (1.0 - std::cos(phase));
    // The phase error of a step is (omega dt)^5 / 120 and (omega dt)^3 / 24.
    const double z = omega * 1e-3,
                 shift = integrator == Integrator::rk4 ? std::pow(z, 5) / 120.0 : std::pow(z, 3) / 24.0;
    EXPECT_NEAR(x[i][2], exact, 1.2 * 1700.0 * shift * hung.elongation);
    EXPECT_NEAR(v[i][2], -omega * hung.elongation * std::sin(phase),
                1.2 * 1700.0 * shift * omega * hung.elongation + 1e-3 * z * z);
    EXPECT_NEAR(solver->fastest_frequency(), omega, 0.1 * omega);
  }
}

/// Force of the lines on a payload at the positions x, N, as a loop over its attachments.
Vector force_of_lines(const Parameters& p, const std::vector<Vector>& x, std::size_t payload, int first,
                      int lines, double axial_stiffness) {
  Vector sum{};
  for (int k = first; k < first + lines; ++k) {
    const auto other = static_cast<std::size_t>(k);
    const auto length_between = [&](const std::vector<Vector>& at) {
      return std::hypot(at[other][0] - at[payload][0], at[other][1] - at[payload][1],
                        at[other][2] - at[payload][2]);
    };
    const double now = length_between(x), rest = length_between(p.mesh.rest);
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum[axis] += axial_stiffness * (now / rest - 1.0) / now * (x[other][axis] - x[payload][axis]);
  }
  return sum;
}

TEST(FabricPayload, SumsTheForcesOfAnyNumberOfLines) {
  Parameters p;
  p.mesh = testing::random_patch(9, 7, 5);
  p.mass.assign(p.mesh.rest.size(), 0.02);
  p.dt = 1e-4;
  // A warp shares rows of more than 12 springs, by 32 at a time.
  struct Lines {
    int first, count;
    std::size_t payload;
  };
  std::vector<Lines> payloads = {{0, 12, 0}, {3, 13, 0}, {1, 44, 0}, {0, 60, 0}, {30, 1, 0}};
  for (Lines& lines : payloads) {
    std::vector<int> attachments;
    for (int k = 0; k < lines.count; ++k) attachments.push_back(lines.first + k);
    const double offset = 0.3 * lines.count;
    lines.payload =
        static_cast<std::size_t>(add_payload(p, {{4.0 + offset, 3.0, -5.0}, 3.0, 500.0}, attachments));
  }
  const std::vector<Vector> x = shaken(p.mesh.rest, 0.3, 1), v(x.size(), Vector{});
  const auto solver = create_solver(backend, p);
  solver->upload(x, v);
  std::vector<Vector> force(x.size());
  solver->forces(force);
  for (const Lines& lines : payloads) {
    const Vector expected = force_of_lines(p, x, lines.payload, lines.first, lines.count, 500.0);
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(force[lines.payload][axis], expected[axis], 1e-11) << lines.count;
  }
}

/// Largest change of a component of the momentum, kg m/s, and of the angular momentum, kg m^2/s, of a free
/// sheet that pulls at a payload for 0.2 s.
struct MomentumChange {
  double linear = 0.0, angular = 0.0;
};

MomentumChange momentum_change(Integrator integrator, int steps) {
  Parameters p;
  p.mesh = testing::random_patch(9, 7, 5);
  p.material.axial_stiffness = 200.0;
  p.mass.assign(p.mesh.rest.size(), 0.02);
  p.integrator = integrator;
  p.dt = 0.2 / steps;
  const int corners[] = {0, 8, 54, 62};
  const auto i = static_cast<std::size_t>(add_payload(p, {{4.0, 3.0, -5.0}, 3.0, 500.0}, corners));
  const auto solver = create_solver(backend, p);
  std::vector<Vector> x = shaken(p.mesh.rest, 0.05, 1),
                      v = shaken(std::vector<Vector>(x.size(), Vector{}), 0.2, 2);
  v[i] = {0.3, -0.2, -1.0};  // pulls the lines taut
  solver->upload(x, v);
  const Totals before = solver->totals();
  EXPECT_TRUE(solver->enqueue_steps(steps) && !solver->failure());
  const Totals after = solver->totals();
  MomentumChange change;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    change.linear = std::max(change.linear, std::abs(after.momentum[axis] - before.momentum[axis]));
    change.angular =
        std::max(change.angular, std::abs(after.angular_momentum[axis] - before.angular_momentum[axis]));
  }
  const double velocity = v[i][2];
  solver->download(x, v);
  EXPECT_GT(std::abs(v[i][2] - velocity), 0.01) << "the lines pull at the payload";
  return change;
}

// Central forces conserve both momenta. Verlet's kicks act along the springs and conserve the angular
// momentum to round-off; the error of the Runge-Kutta method is of fourth order in dt.
TEST(FabricPayload, ExchangesMomentumWithAFreeSheetWithoutLoss) {
  const MomentumChange verlet = momentum_change(Integrator::verlet, 2000),
                       rk4 = momentum_change(Integrator::rk4, 2000),
                       fine = momentum_change(Integrator::rk4, 4000);
  for (const MomentumChange& change : {verlet, rk4, fine}) EXPECT_LT(change.linear, 1e-12);
  EXPECT_LT(verlet.angular, 1e-11);
  EXPECT_LT(rk4.angular, 1e-8);
  EXPECT_LT(fine.angular, rk4.angular / 12.0);
}

TEST(FabricPayload, ExtendsValuesGivenPerVertexAndPerLine) {
  Parameters p;
  p.mesh.rest = {{0, 0, 0}, {1, 0, 0}};
  p.mesh.lines = {{0, 1}};
  p.mesh.line_density = {0.1};
  p.material.axial_stiffness = 7.0;
  p.mass = {1.0, 1.0};
  p.pinned = {7, 0};
  p.load.assign(2, {0, 0, 1});
  p.timed_loads = {{postfix({"t"}), std::vector<Vector>(2, {1, 0, 0})}};
  p.follower_pressures = {{postfix({1.0}), {1.0, 1.0}}, {postfix({1.0}), {}}};
  p.dt = 0.01;
  const int ends[] = {0, 1};
  EXPECT_EQ(add_payload(p, {{0.5, 0, -1}, 4.0, 11.0}, ends), 2);
  EXPECT_EQ(p.mesh.rest.size(), 3U);
  EXPECT_EQ(p.mesh.lines, (std::vector<std::array<int, 2>>{{0, 1}, {0, 2}, {1, 2}}));
  EXPECT_EQ(p.mesh.line_stiffness, (std::vector<double>{7.0, 11.0, 11.0}));
  EXPECT_EQ(p.mesh.line_density, (std::vector<double>{0.1, 0.0, 0.0}));
  EXPECT_EQ(p.mass, (std::vector<double>{1.0, 1.0, 4.0}));
  EXPECT_EQ(p.pinned.back(), 0);
  EXPECT_EQ(p.load.back(), Vector{});
  EXPECT_EQ(p.timed_loads[0].direction.back(), Vector{});
  EXPECT_EQ(p.follower_pressures[0].weight.back(), 0.0);
  EXPECT_TRUE(p.follower_pressures[1].weight.empty());
  EXPECT_NO_THROW(check_parameters(p));
}

TEST(FabricPayload, RejectsInvalidPayloads) {
  Parameters good;
  good.mesh.rest = {{0, 0, 0}};
  good.mass = {1.0};
  const int anchor[] = {0}, missing[] = {1};
  const auto rejected = [&](const Payload& payload, std::span<const int> attachments) {
    Parameters p = good;
    EXPECT_THROW(add_payload(p, payload, attachments), std::invalid_argument);
    EXPECT_EQ(p.mesh.rest.size(), 1U);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  rejected({{0, 0, -1}, 0.0, 1.0}, anchor);
  rejected({{0, 0, -1}, nan, 1.0}, anchor);
  rejected({{0, 0, -1}, 1.0, -1.0}, anchor);
  rejected({{0, nan, -1}, 1.0, 1.0}, anchor);
  rejected({{0, 0, -1}, 1.0, 1.0}, missing);
  rejected({{0, 0, -1}, 1.0, 1.0}, {});
  good.mass.clear();
  rejected({{0, 0, -1}, 1.0, 1.0}, anchor);
}

}  // namespace
}  // namespace drogue::fabric
