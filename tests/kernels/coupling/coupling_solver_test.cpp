// ctest-label: exact
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

#include "kernels/coupling/sheet/edge_inset.hpp"
#include "kernels/fabric/solver.hpp"
#include "kernels/reference/coupling/edge_inset.hpp"
#include "kernels/reference/coupling/grid_transfer.hpp"
#include "kernels/reference/fabric/intersections.hpp"
#include "tests/support/coupled_case.hpp"
#include "tests/support/expression_program.hpp"

// Steps of cloth in air: time steps, blocks, restarts, failures, backends and launches.

namespace drogue::coupling {
namespace {

using drogue::testing::counted_steps;
using drogue::testing::coupled_state;
using drogue::testing::CoupledCase;
using drogue::testing::CoupledRun;
using drogue::testing::CoupledState;
using drogue::testing::download;
using drogue::testing::fill;
using drogue::testing::restore;
using drogue::testing::tested_backend;
using fabric::Vector;

constexpr double h = 0.1;

/// Free strip that flies through air between slip sides.
CoupledCase flying_strip() {
  CoupledCase c(24, 16, h, 0.0);
  for (std::size_t side = 0; side < 4; ++side) c.p.flow.boundary[side].kind = flow::BoundaryKind::slip;
  c.p.flow.max_dt = 0.004;
  c.add_strip(0.61, 0.4, 0.67, 1.2, 16);
  for (std::uint8_t& axes : c.p.fabric.pinned) axes = 0;
  for (std::size_t i = 0; i < c.v.size(); ++i) c.v[i] = {6.0, std::sin(9.0 * c.x[i][1]), 0.0};
  return c;
}

/// Two free strips in a periodic box of thin air that fly against one another, on their way through several
/// thicknesses per step of the flow.
CoupledCase meeting_strips(bool with_contact) {
  CoupledCase c(16, 16, h, 0.002);
  c.add_strip(0.61, 0.4, 0.67, 1.2, 16);
  c.add_strip(0.76, 0.43, 0.72, 1.17, 15);
  c.set_mass(0.3);
  for (std::uint8_t& axes : c.p.fabric.pinned) axes = 0;
  for (std::size_t i = 0; i < c.v.size(); ++i) c.v[i] = {i < 34 ? 6.0 : -6.0, 0.5, 0.0};
  c.p.sheet.law = {5.0, 0.5, false};
  c.p.substeps = 24;
  c.p.fabric.contact.self = with_contact;
  c.p.fabric.contact.thickness = 0.004;
  return c;
}

struct State : CoupledState {
  Vector total_force;
};

State state_of(Solver& solver) { return {coupled_state(solver), solver.total_force_on_air()}; }

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = a.size() == b.size() ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

double distance(std::vector<Vector> a, std::vector<Vector> b) {
  return distance(std::vector<double>(numbers(a).begin(), numbers(a).end()),
                  std::vector<double>(numbers(b).begin(), numbers(b).end()));
}

double distance(const State& a, const State& b) {
  double largest = 0.0;
  for (const auto& [name, values] : a.arrays) {
    const bool is_acceleration = name != "sheet_position" && name != "sheet_velocity";
    largest = std::max(largest, (is_acceleration ? 1e-3 : 1.0) * distance(values, b.arrays.at(name)));
  }
  for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, distance(a.flow[k], b.flow[k]));
  return largest;
}

TEST(CoupledSolver, ContinuesBitForBit) {
  for (const flow::TimeScheme time : {flow::TimeScheme::ab2, flow::TimeScheme::rk3}) {
    CoupledCase c = flying_strip();
    c.p.flow.time_scheme = time;
    c.p.sheet.law.no_slip = time == flow::TimeScheme::rk3;
    if (time == flow::TimeScheme::rk3) {
      c.p.sheet.method = CouplingMethod::explicit_;
      c.set_mass(5.0);
    }
    CoupledRun whole(c), first(c);
    ASSERT_TRUE(whole.advance(21));
    ASSERT_TRUE(whole.advance(19));
    ASSERT_TRUE(first.advance(21));
    const State middle = state_of(*first.solver);
    CoupledRun second(c);
    restore(middle, *second.solver);
    EXPECT_EQ(distance(state_of(*second.solver), middle), 0.0);
    ASSERT_TRUE(second.advance(19));
    EXPECT_EQ(distance(state_of(*second.solver), state_of(*whole.solver)), 0.0);
  }
}

TEST(CoupledSolver, ContinuesBitForBitWithTheFilteredDefect) {
  CoupledCase c = flying_strip();
  c.p.sheet.leak_filter = 0.5;
  CoupledRun whole(c), first(c);
  ASSERT_TRUE(whole.advance(40));
  ASSERT_TRUE(first.advance(21));
  State middle = state_of(*first.solver);
  double largest = 0.0;
  for (const double each : middle.arrays["defect"]) largest = std::max(largest, std::abs(each));
  EXPECT_GT(largest, 0.1);
  CoupledRun second(c), without(c);
  restore(middle, *second.solver);
  EXPECT_EQ(distance(state_of(*second.solver), middle), 0.0);
  ASSERT_TRUE(second.advance(19));
  const State end = state_of(*whole.solver);
  EXPECT_EQ(distance(state_of(*second.solver), end), 0.0);
  // It is a part of the state.
  std::ranges::fill(middle.arrays["defect"], 0.0);
  restore(middle, *without.solver);
  ASSERT_TRUE(without.advance(19));
  EXPECT_GT(distance(state_of(*without.solver), end), 1e-6);
}

TEST(CoupledSolver, ContinuesBitForBitWithABodyInMotion) {
  CoupledCase c = flying_strip();
  std::vector<int> all(c.x.size());
  std::iota(all.begin(), all.end(), 0);
  c.p.fabric.motions.push_back({1, all, testing::postfix({"t", "t", "*"})});
  CoupledRun whole(c);
  ASSERT_TRUE(whole.advance(40));
  for (const std::int64_t first : {1, 7, 16, 29}) {
    CoupledRun begun(c), continued(c);
    ASSERT_TRUE(begun.advance(first));
    const State middle = state_of(*begun.solver);
    restore(middle, *continued.solver);
    EXPECT_EQ(
        distance(state_of(*continued.solver).arrays.at("sheet_position"), middle.arrays.at("sheet_position")),
        0.0)
        << first;
    ASSERT_TRUE(continued.advance(40 - first));
    EXPECT_EQ(distance(state_of(*continued.solver), state_of(*whole.solver)), 0.0) << first;
  }
}

TEST(CoupledSolver, ContinuesBitForBitInContact) {
  const CoupledCase c = meeting_strips(true);
  CoupledRun whole(c), first(c);
  ASSERT_TRUE(whole.advance(13));
  ASSERT_TRUE(first.advance(7));
  const State middle = state_of(*first.solver);
  CoupledRun second(c);
  restore(middle, *second.solver);
  ASSERT_TRUE(second.advance(6));
  EXPECT_EQ(distance(state_of(*second.solver), state_of(*whole.solver)), 0.0);
}

/// Intersections of the strips at the ends of steps, and largest change of the momentum of cloth and air in a
/// step, relative to that of a strip.
struct Meeting {
  std::size_t intersections = 0;
  double gain = 0.0, approach = 0.0;
};

Meeting meet(bool with_contact) {
  CoupledCase c = meeting_strips(with_contact);
  CoupledRun run(c);
  const auto momentum = [&] {
    const flow::Totals air = run.solver->flow().totals();
    const fabric::Totals cloth = run.solver->fabric().totals();
    Vector sum{};
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] = air.momentum[axis] + cloth.momentum[axis];
    return sum;
  };
  double of_strip = 0.0;
  for (std::size_t i = 0; i < 34; ++i) of_strip += 6.0 * c.p.fabric.mass[i];
  Meeting result;
  Vector last = momentum();
  for (int step = 0; step < 40; ++step) {
    EXPECT_TRUE(run.advance(1));
    const Vector now = momentum();
    for (std::size_t axis = 0; axis < 3; ++axis)
      result.gain = std::max(result.gain, std::abs(now[axis] - last[axis]) / of_strip);
    last = now;
    run.solver->fabric().download(c.x, c.v);
    result.intersections += reference::intersections(c.x, c.p.fabric.mesh.triangles, {}).size();
  }
  double mass = 0.0;
  for (std::size_t i = 0; i < 34; ++i)
    mass += c.p.fabric.mass[i], result.approach += c.p.fabric.mass[i] * c.v[i][0];
  result.approach /= mass;
  return result;
}

TEST(CoupledSolver, StripsThatMeetDoNotCrossAndKeepTheMomentum) {
  EXPECT_GT(meet(false).intersections, 0U);
  const Meeting met = meet(true);
  EXPECT_EQ(met.intersections, 0U);
  EXPECT_LT(met.gain, 1e-14);
  EXPECT_LT(met.approach, 1.0) << "m/s, from 6: the strips have stopped one another";
}

/// The strip with a line that pulls two of its vertices together until a time, s, and one that stays.
CoupledCase strip_with_lines(double cut) {
  CoupledCase c = flying_strip();
  c.p.fabric.mesh.lines = {{0, 12}, {14, 30}};
  c.p.fabric.mesh.line_stiffness = {2e-3, 1e-3};
  c.p.fabric.mesh.line_length = {0.1, 0.1};
  c.p.cuts = {{cut, {0}}};
  return c;
}

TEST(CoupledSolver, LinesAreCutAtTheirTime) {
  constexpr double cut = 0.0501;
  const CoupledCase c = strip_with_lines(cut);
  CoupledRun run(c);
  const auto pull = [&] {
    std::vector<Vector> forces(c.x.size());
    run.solver->fabric().forces(forces);
    fabric::Parameters other = c.p.fabric;
    other.mesh.line_stiffness = {0.0, 1e-3};
    other.integrator = fabric::Integrator::symplectic_euler;
    other.dt = 1e-4;
    const auto cloth = fabric::create_solver(tested_backend, other);
    std::vector<Vector> x(c.x.size()), v(c.x.size()), without(c.x.size());
    run.solver->fabric().download(x, v);
    cloth->upload(x, v);
    cloth->forces(without);
    return distance(forces, without);
  };
  bool stopped_at_cut = false;
  for (std::int64_t step = 1; step <= 30; ++step) {
    ASSERT_TRUE(run.advance(1));
    const double time = run.solver->progress().flow.time;
    stopped_at_cut = stopped_at_cut || time == cut;
    // The cut is made when the step after it begins.
    if (time <= cut) {
      EXPECT_GT(pull(), 1e-4) << time;
    } else {
      EXPECT_LE(pull(), 1e-12) << time;
    }
  }
  EXPECT_TRUE(stopped_at_cut) << "a step ends at the cut";
}

/// Starts a run that watches how line 0 pulls vertex 0, and line 1 vertex 30.
void start_watching(const CoupledCase& c, Solver& solver) {
  solver.watch_pulls(std::vector<fabric::Pull>{{0, {0}}, {30, {1}}});
  solver.fabric().upload(c.x, c.v);
  solver.start();
}

TEST(CoupledSolver, PeaksOfPullsAreThoseOfCompletedSteps) {
  CoupledCase c = strip_with_lines(0.0501);
  const auto pull = [&](std::size_t line, const std::vector<Vector>& x) {
    const auto& [a, b] = c.p.fabric.mesh.lines[line];
    const auto &from = x[static_cast<std::size_t>(a)], &to = x[static_cast<std::size_t>(b)];
    const double length = std::hypot(from[0] - to[0], from[1] - to[1], from[2] - to[2]);
    return c.p.fabric.mesh.line_stiffness[line] * std::max(0.0, length / 0.1 - 1.0);
  };
  CoupledRun observed(c), whole(c);
  start_watching(c, *whole.solver);
  std::vector<fabric::PeakPull> expected = {{pull(0, c.x), 0.0}, {pull(1, c.x), 0.0}};
  EXPECT_NEAR(whole.solver->peak_pulls()[0].force, expected[0].force, 1e-12 * expected[0].force);
  for (int step = 0; step < 30; ++step) {
    ASSERT_TRUE(observed.advance(1));
    std::vector<Vector> x(c.x.size()), v(c.x.size());
    observed.solver->fabric().download(x, v);
    const double time = observed.solver->progress().flow.time;
    for (std::size_t k = 0; k < 2; ++k)
      if (const double force = pull(k, x); force > expected[k].force && (k == 1 || time <= 0.0501))
        expected[k] = {force, time};
  }
  EXPECT_GT(expected[1].time, 0.0);
  ASSERT_TRUE(whole.advance(30));
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(whole.solver->peak_pulls()[k].force, expected[k].force, 1e-12 * expected[k].force) << k;
    EXPECT_EQ(whole.solver->peak_pulls()[k].time, expected[k].time) << k;
  }
  // A step that fails, here by a line that carries too much, does not count.
  c.p.line_strength = {std::numeric_limits<double>::infinity(), expected[1].force * (1.0 - 1e-9)};
  CoupledRun failing(c);
  start_watching(c, *failing.solver);
  ASSERT_EQ(failing.solver->advance(10.0, -1, {}), flow::Stop::failed);
  EXPECT_LE(failing.solver->peak_pulls()[1].force, c.p.line_strength[1]);
}

TEST(CoupledSolver, ContinuesBitForBitAroundACut) {
  const CoupledCase c = strip_with_lines(0.0501);  // after 13 steps
  CoupledRun whole(c);
  ASSERT_TRUE(whole.advance(40));
  for (const std::int64_t first : {5, 12, 13, 14, 20, 35}) {
    CoupledRun begun(c), continued(c);
    ASSERT_TRUE(begun.advance(first));
    restore(state_of(*begun.solver), *continued.solver);
    ASSERT_TRUE(continued.advance(40 - first));
    EXPECT_EQ(distance(state_of(*continued.solver), state_of(*whole.solver)), 0.0) << first;
  }
}

TEST(CoupledSolver, BackendsAgree) {
  for (const bool no_slip : {false, true}) {
    CoupledCase c = strip_with_lines(0.0501);
    c.p.sheet.law.no_slip = no_slip;
    const auto end = [&](device::Backend backend) {
      const auto solver = c.solver(backend);
      EXPECT_EQ(solver->advance(1e9, 30, {}), flow::Stop::pause);
      return state_of(*solver);
    };
    const State here = end(tested_backend);
    for (const device::Backend backend : device::compiled_backends()) {
      if (backend == tested_backend) continue;
      EXPECT_LE(distance(here, end(backend)), drogue::testing::run_tolerance);
    }
  }
}

TEST(CoupledSolver, ReachesTargetsInEqualSteps) {
  CoupledCase c = flying_strip();
  CoupledRun run(c);
  for (const double target : {0.0101, 0.0999, 0.1}) {
    EXPECT_EQ(run.solver->advance(target, -1, {}), flow::Stop::target);
    EXPECT_EQ(run.solver->progress().flow.time, target);
  }
  // Steps of 0.004 s at most: 3 to the first time, 23 to the second one and one to the last.
  EXPECT_EQ(run.solver->progress().flow.step, 27);
  EXPECT_NEAR(run.solver->progress().flow.last_dt, 0.0001, 1e-12);
  EXPECT_LE(run.solver->progress().flow.dt_max, 0.004 * (1.0 + 1e-9));
}

TEST(CoupledSolver, NoStepBeforeATargetIsFarShorterThanOthers) {
  CoupledCase c = flying_strip();
  CoupledRun run(c);
  // 32 steps of 0.004 s and a rest: two whole blocks end just short of the target.
  EXPECT_EQ(run.solver->advance(32.001 * 0.004, -1, {}), flow::Stop::target);
  EXPECT_EQ(run.solver->progress().flow.step, 33);
  EXPECT_GT(run.solver->progress().flow.dt_min, 0.9 * 0.004);
}

TEST(CoupledSolver, ReportsTheForceOnTheAirStressAndElasticForces) {
  CoupledCase c = flying_strip();
  CoupledRun run(c);
  ASSERT_TRUE(run.advance(10));
  const std::size_t vertices = c.x.size();
  std::vector<Vector> on_air(vertices), elastic(vertices), x(vertices), v(vertices);
  run.solver->download("sheet_force", numbers(on_air));
  const std::array<double, 3> total = run.solver->total_force_on_air();
  Vector sum{};
  double magnitude = 0.0;
  for (const Vector& force : on_air)
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += force[axis], magnitude += std::abs(force[axis]);
  EXPECT_GT(magnitude, 1e-3);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(total[axis], sum[axis], 1e-14 * magnitude);
  // A solver of the cloth alone has the same forces and stresses at these positions.
  run.solver->fabric().download(x, v);
  fabric::Parameters cloth_only = c.p.fabric;
  cloth_only.integrator = fabric::Integrator::symplectic_euler;
  cloth_only.dt = 1e-4;
  const auto cloth = fabric::create_solver(tested_backend, cloth_only);
  cloth->upload(x, v);
  std::vector<Vector> expected(vertices);
  cloth->forces(expected);
  run.solver->fabric().forces(elastic);
  double largest = 0.0;
  for (const Vector& force : expected) largest = std::max(largest, std::abs(force[0]));
  EXPECT_GT(largest, 0.0);
  EXPECT_LE(distance(elastic, expected), 1e-12 * largest);
  std::vector<fabric::Stress> stress(c.p.fabric.mesh.triangles.size()), expected_stress(stress.size());
  run.solver->fabric().stress(fabric::StressMeasure::cauchy, stress);
  cloth->stress(fabric::StressMeasure::cauchy, expected_stress);
  double largest_stress = 0.0;
  for (std::size_t t = 0; t < stress.size(); ++t) {
    largest_stress = std::max(largest_stress, expected_stress[t].von_mises());
    EXPECT_NEAR(stress[t].von_mises(), expected_stress[t].von_mises(), 1e-12 * largest_stress);
  }
  EXPECT_GT(largest_stress, 0.0);
  std::vector<Vector> few(vertices - 1);
  EXPECT_THROW(run.solver->fabric().forces(few), std::invalid_argument);
}

/// Velocity of the air where the vertices exchange forces with it: from the solver, and interpolated here.
void expect_air_velocity(const CoupledCase& c) {
  CoupledRun run(c), other(c);
  ASSERT_TRUE(run.advance(10));
  std::vector<Vector> x(c.x.size()), v(c.x.size()), air(c.x.size());
  run.solver->fabric().download(x, v);
  run.solver->air_velocity(air);
  const coupling::StaggeredGrid grid = c.grid({false, false, true});
  if (c.p.sheet.edge_inset > 0.0)
    // The ends of the strip are free, its sides lie at those of the box.
    x = reference::inset_positions(
        c.p.fabric.mesh, [](const Vector& inward) { return std::abs(inward[2]) > 0.5; },
        c.p.sheet.edge_inset * h, inset_band * h, x);
  reference::FaceField velocity;
  for (std::size_t axis = 0; axis < 3; ++axis)
    velocity[axis] = download(run.solver->flow(), flow::velocity_name(axis));
  const std::vector<Vector> expected = reference::interpolate(grid, c.p.sheet.delta, velocity, x);
  double largest = 0.0;
  for (const Vector& of_vertex : expected) largest = std::max(largest, std::abs(of_vertex[0]));
  EXPECT_GT(largest, 0.1);
  EXPECT_LE(distance(air, expected), 1e-13 * largest);
  // It changes no step.
  ASSERT_TRUE(other.advance(10));
  for (CoupledRun* each : {&run, &other}) ASSERT_TRUE(each->advance(10));
  EXPECT_EQ(distance(state_of(*run.solver), state_of(*other.solver)), 0.0);
}

TEST(CoupledSolver, ReportsTheVelocityOfTheAirAtTheVertices) {
  CoupledCase c = flying_strip();
  expect_air_velocity(c);
  c.p.sheet.edge_inset = 0.55;
  expect_air_velocity(c);
}

TEST(CoupledSolver, StepSizeFollowsTheSpeedOfTheAir) {
  CoupledCase c = flying_strip();
  c.p.flow.max_dt = 1.0;
  c.p.flow.cfl = 0.3;
  for (std::size_t side = 0; side < 2; ++side) c.p.flow.boundary[side].kind = flow::BoundaryKind::periodic;
  CoupledRun run(c);
  fill(run.solver->flow(), "velocity_x", 8.0);
  run.solver->start();
  ASSERT_TRUE(run.advance(1));
  EXPECT_NEAR(run.solver->progress().flow.last_dt, 0.3 * h / 8.0, 1e-3 * h);
}

TEST(CoupledSolver, StopsIfPollReturnsFalse) {
  CoupledCase c = flying_strip();
  CoupledRun run(c);
  EXPECT_EQ(run.solver->advance(1.0, -1, [](const flow::Status& now) { return now.step < 20; }),
            flow::Stop::interrupted);
  EXPECT_GE(run.solver->progress().flow.step, 20);
  EXPECT_LE(run.solver->progress().flow.step, 32);  // a whole block
}

/// Advances until a failure and expects the state before the failed step.
void expect_failure(const CoupledCase& c, FailureReason reason) {
  CoupledRun run(c);
  ASSERT_EQ(run.solver->advance(10.0, -1, {}), flow::Stop::failed);
  EXPECT_EQ(run.solver->failure().reason, reason);
  const State last = state_of(*run.solver);
  EXPECT_EQ(run.solver->advance(10.0, -1, {}), flow::Stop::failed);
  CoupledRun again(c);
  if (last.progress.flow.step > 0) {
    ASSERT_TRUE(again.advance(last.progress.flow.step));
  }
  const State expected = state_of(*again.solver);
  EXPECT_EQ(distance(expected, last), 0.0);
  std::vector<Vector> air(c.x.size()), expected_air(c.x.size());
  run.solver->air_velocity(air);
  again.solver->air_velocity(expected_air);
  EXPECT_EQ(distance(air, expected_air), 0.0);
  EXPECT_EQ(distance(expected.force, last.force), 0.0);
  EXPECT_EQ(expected.total_force, last.total_force);
}

TEST(CoupledSolver, ClothThatLeavesTheDomainIsAFailure) {
  CoupledCase c = flying_strip();
  c.p.sheet.law = {1e-3, 0.0, false};
  expect_failure(c, FailureReason::left_domain);
  c.p.sheet.leak_filter = 0.5;
  expect_failure(c, FailureReason::left_domain);
  // A new start forgets it.
  CoupledRun run(c);
  ASSERT_EQ(run.solver->advance(10.0, -1, {}), flow::Stop::failed);
  run.solver->fabric().upload(c.x, c.v);
  for (std::size_t axis = 0; axis < 3; ++axis) fill(run.solver->flow(), flow::velocity_name(axis), 0.0);
  run.solver->start();
  EXPECT_TRUE(run.advance(5));
  EXPECT_EQ(run.solver->failure().reason, FailureReason::flow);
}

TEST(CoupledSolver, FailedStepsReturnToEveryArrayOfTheState) {
  std::vector<CoupledCase> cases(4, flying_strip());
  cases[1].p.sheet.leak_filter = 0.5;
  cases[2].p.sheet.method = CouplingMethod::explicit_;
  cases[2].set_mass(5.0);
  cases[3].p.sheet.method = CouplingMethod::sharp;
  cases[3].p.fabric.pinned.assign(cases[3].x.size(), 7);
  cases[3].v.assign(cases[3].x.size(), {0.5, 0.2, 0.0});
  for (const CoupledCase& c : cases) {
    CoupledRun run(c);
    ASSERT_TRUE(run.advance(3)) << static_cast<int>(c.p.sheet.method);
    CoupledState changed = coupled_state(*run.solver);
    double place = 0.0;
    for (auto& [name, values] : changed.arrays)
      for (double& value : values) value += 1e-3 * std::sin(place += 1.0);
    // The next step fails, whatever the cloth does.
    changed.flow[0].assign(changed.flow[0].size(), std::nan(""));
    restore(changed, *run.solver);
    EXPECT_EQ(run.solver->advance(10.0, -1, {}), flow::Stop::failed);
    EXPECT_EQ(run.solver->progress().flow.step, 3);
    EXPECT_EQ(coupled_state(*run.solver).arrays, changed.arrays);
  }
}

TEST(CoupledSolver, LineThatCarriesMoreThanItsStrengthIsAFailure) {
  CoupledCase c = strip_with_lines(1.0);
  c.p.fabric.mesh.line_length.clear();
  c.p.fabric.mesh.line_stiffness = {1.0, 1.0};
  // The strip, 0.8 m long, stretches at first.
  for (std::size_t i = 0; i < c.v.size(); ++i) c.v[i] = {6.0, 0.5 * (c.x[i][1] - 0.8), 0.0};
  // Tension of the second line, from vertex 14 to 30, without limit.
  CoupledRun free(c);
  const auto length = [](const std::vector<Vector>& x) {
    return std::hypot(x[30][0] - x[14][0], x[30][1] - x[14][1]);
  };
  std::vector<double> tension;
  for (int step = 0; step < 25; ++step) {
    ASSERT_TRUE(free.advance(1));
    std::vector<Vector> x(c.x.size()), v(c.x.size());
    free.solver->fabric().download(x, v);
    tension.push_back(length(x) / length(c.x) - 1.0);
  }
  const auto most = std::ranges::max_element(tension);
  ASSERT_GE(most - tension.begin(), 2) << "the tension rises at first";
  const double strength = *most * (1.0 - 1e-9);
  c.p.line_strength = {std::numeric_limits<double>::infinity(), strength};
  expect_failure(c, FailureReason::line);
  CoupledRun limited(c);
  ASSERT_EQ(limited.solver->advance(10.0, -1, {}), flow::Stop::failed);
  EXPECT_EQ(limited.solver->failure().line, 1);
  EXPECT_EQ(limited.solver->progress().flow.step, most - tension.begin()) << "the state before the step";
  // A line that is cut carries nothing.
  c.p.cuts = {{0.5 * limited.solver->progress().flow.time, {1}}};
  CoupledRun cut(c);
  EXPECT_TRUE(cut.advance(25));
  c.p.line_strength = {1.0};
  EXPECT_THROW(static_cast<void>(create_solver(tested_backend, c.p)), std::invalid_argument);
  c.p.line_strength = {1.0, 0.0};
  EXPECT_THROW(static_cast<void>(create_solver(tested_backend, c.p)), std::invalid_argument);
}

TEST(CoupledSolver, ClothThatIsTooStiffIsAFailure) {
  CoupledCase c = flying_strip();
  c.p.fabric.material.membrane_modulus *= 1e9;
  CoupledRun run(c);
  EXPECT_EQ(run.solver->advance(0.1, -1, {}), flow::Stop::failed);
  EXPECT_EQ(run.solver->failure().reason, FailureReason::too_stiff);
  EXPECT_EQ(run.solver->progress().flow.step, 0);
  EXPECT_LE(run.solver->progress().block.substeps, most_substeps);
}

TEST(CoupledSolver, PollsBetweenTheFirstStepsOfABlock) {
  CoupledRun run(flying_strip());
  std::vector<std::int64_t> steps;
  static_cast<void>(run.solver->advance(0.1, 8, [&](const flow::Status& status) {
    steps.push_back(status.step);
    return true;
  }));
  EXPECT_GE(steps.size(), 4U) << "a block would hold all of them";
}

TEST(CoupledSolver, InstabilityOfTheClothIsAFailure) {
  CoupledCase c = flying_strip();
  c.p.fabric.material.membrane_modulus = 1e9;
  c.p.substeps = 200;
  expect_failure(c, FailureReason::cloth);
  CoupledRun run(c);
  EXPECT_FALSE(run.solver->failure().cloth);
  ASSERT_EQ(run.solver->advance(10.0, -1, {}), flow::Stop::failed);
  ASSERT_TRUE(run.solver->failure().cloth);
  EXPECT_EQ(run.solver->failure().cloth->reason, fabric::FailureReason::not_finite);
  EXPECT_GE(run.solver->failure().cloth->index, 0);
}

/// The strip in air that a body force accelerates, within a block, to a speed at which its dt is unstable.
CoupledCase strip_in_accelerating_air() {
  CoupledCase c = flying_strip();
  for (std::size_t side = 0; side < 2; ++side) c.p.flow.boundary[side].kind = flow::BoundaryKind::periodic;
  c.p.flow.body_force = {600.0, 0.0, 0.0};
  return c;
}

TEST(CoupledSolver, FixedStepsBeyondTheStabilityLimitFail) {
  CoupledCase c = strip_in_accelerating_air();
  c.p.flow.fixed_dt = 0.004;
  expect_failure(c, FailureReason::flow);
}

TEST(CoupledSolver, StepsShortenWithinABlock) {
  CoupledCase c = strip_in_accelerating_air();
  constexpr double end = 0.064;  // 16 steps of the largest dt
  CoupledRun run(c), paused(c);
  ASSERT_EQ(run.solver->advance(end, -1, {}), flow::Stop::target);
  const flow::Progress last = run.solver->progress().flow;
  EXPECT_EQ(last.dt_max, 0.004);
  EXPECT_LT(last.dt_min, 0.6 * last.dt_max);
  EXPECT_GT(last.step, 16);
  // Pauses do not change the steps.
  while (paused.solver->progress().flow.time < end)
    ASSERT_NE(paused.solver->advance(end, paused.solver->progress().flow.step + 1, {}), flow::Stop::failed);
  EXPECT_EQ(distance(state_of(*paused.solver), state_of(*run.solver)), 0.0);
}

TEST(CoupledSolver, RejectsInvalidParameters) {
  const auto rejects = [](void (*change)(Parameters&)) {
    CoupledCase c = flying_strip();
    change(c.p);
    EXPECT_THROW(static_cast<void>(create_solver(tested_backend, c.p)), std::invalid_argument);
  };
  rejects([](Parameters& p) { p.flow.max_dt = 0.0; });
  rejects([](Parameters& p) { p.substeps = -1; });
  rejects([](Parameters& p) { p.sheet.law.alpha = -1.0; });
  rejects([](Parameters& p) { p.sheet.law.beta = std::nan(""); });
  rejects([](Parameters& p) { p.sheet.law_of_vertex.resize(3); });
  rejects([](Parameters& p) { p.sheet.law_of_vertex.resize(p.fabric.mass.size(), {1.0, -1.0, false}); });
  rejects([](Parameters& p) { p.sheet.filter = 1.5; });
  rejects([](Parameters& p) { p.longest_batch = 0.0; });
  rejects([](Parameters& p) { p.sheet.leak_filter = -0.5; });
  rejects([](Parameters& p) { p.sheet.leak_filter = 1.1; });
  rejects([](Parameters& p) { p.sheet.filter_of_vertex.resize(3); });
  rejects([](Parameters& p) { p.sheet.filter_of_vertex.resize(p.fabric.mass.size(), {.weight = -0.1}); });
  rejects([](Parameters& p) { p.sheet.edge_inset = -0.1; });
  rejects([](Parameters& p) { p.sheet.edge_inset = 1.1; });
  for (const double edge_inset : {0.0, 0.55}) {
    CoupledCase c = flying_strip();
    c.p.sheet.edge_inset = edge_inset;
    c.p.sheet.method = CouplingMethod::sharp;
    c.p.fabric.pinned.assign(c.p.fabric.mass.size(), 7);
    if (edge_inset > 0.0) {
      EXPECT_THROW(static_cast<void>(create_solver(tested_backend, c.p)), std::invalid_argument);
    } else {
      EXPECT_NO_THROW(static_cast<void>(create_solver(tested_backend, c.p)));
    }
  }
  rejects([](Parameters& p) { p.fabric.mass.clear(); });
  rejects([](Parameters& p) { p.flow.density = 0.0; });
  rejects([](Parameters& p) { p.cuts = {{1.0, {0}}}; });
  rejects([](Parameters& p) { p.cuts = {{0.0, {}}}; });
  rejects([](Parameters& p) { p.cuts = {{std::nan(""), {}}}; });
}

TEST(CoupledSolver, RejectsArraysOfTheWrongLength) {
  const CoupledCase c = flying_strip();
  CoupledRun run(c);
  std::vector<Vector> few(c.x.size() - 1);
  EXPECT_THROW(run.solver->air_velocity(few), std::invalid_argument);
  for (const char* name : {"air_acceleration", "sheet_force", "sheet_position", "sheet_velocity"}) {
    EXPECT_THROW(run.solver->download(name, numbers(few)), std::invalid_argument) << name;
    EXPECT_THROW(run.solver->upload(name, numbers(few)), std::invalid_argument) << name;
  }
  std::vector<Vector> whole(c.x.size());
  EXPECT_THROW(run.solver->upload("defect", numbers(whole)), std::invalid_argument) << "it is not filtered";
  for (const stepping::StateArray& array : run.solver->state()) EXPECT_NE(array.name, "defect");
  EXPECT_THROW(run.solver->fabric().upload(few, few), std::invalid_argument);
}

/// Launches that differ on a device and a host.
std::int64_t on_device(std::int64_t there, std::int64_t here) {
  return tested_backend == device::Backend::cuda ? there : here;
}

TEST(CoupledCounters, StepsOfABlockNeitherFenceNorAllocateNorCopy) {
  CoupledCase c = flying_strip();
  c.p.substeps = 16;
  c.p.longest_batch = 1e9;
  c.p.flow.fixed_dt = 0.002;
  for (const double edge_inset : {0.0, 0.55}) {
    c.p.sheet.edge_inset = edge_inset;
    CoupledRun run(c);
    static_cast<void>(counted_steps(run, 16));
    // Blocks of 16 steps and of 4: the difference is that of 12 steps. The first one has a checkpoint of the
    // cloth.
    const auto whole = counted_steps(run, 16), part = counted_steps(run, 4);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(whole[k], part[k]) << k;
    // At most: saving, 8 kernels before the steps of the cloth, 4 that spread its forces, a check, and 4
    // after the step of the flow, which is 11 kernels on a host and one graph on a device. An inset of edges
    // is one more.
    EXPECT_LE(whole[3] - part[3] - 1, 12 * (1 + 8 + on_device(1, c.p.substeps) + 4 + 1 + on_device(1, 11) +
                                            4 + (edge_inset > 0.0 ? 1 : 0)));
  }
}

TEST(CoupledCounters, ContactIsResolvedOncePerInterval) {
  const auto launches = [](bool with_contact) {
    CoupledCase c = meeting_strips(with_contact);
    c.p.substeps = 32, c.p.contact_interval = 8;
    c.p.longest_batch = 1e9;  // else a busy machine divides the steps
    CoupledRun run(c);
    static_cast<void>(counted_steps(run, 16));
    const auto whole = counted_steps(run, 16), part = counted_steps(run, 8);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(whole[k], part[k]) << k;
    return whole[3] - part[3];
  };
  // At most, each of 4 intervals in 8 steps: positions at the start, mean velocities, lists, constraints, 10
  // rounds of impulses, continuous detection, 6 rounds of zones and their end; on a device all but the first
  // are one launch, as are the steps of each interval.
  EXPECT_LE(launches(true) - launches(false),
            8 * on_device(4 * 2 + 3, 4 * (1 + 1 + 6 + 1 + 20 + 1 + 24 + 1)));
}

}  // namespace
}  // namespace drogue::coupling
