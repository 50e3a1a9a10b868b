// ctest-label: exact
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "kernels/reference/coupling/air_drag.hpp"
#include "tests/support/coupled_case.hpp"

// Drag of lines and of bodies at vertices.

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

constexpr double h = 0.1, density = 1.2, dt = 0.002;

/// Short strip in a periodic box of air, which its law hardly feels, for vertices beside it.
CoupledCase box() {
  CoupledCase c(24, 16, h, dt);
  c.p.sheet.law = {1e-9, 0.0, false};
  c.add_strip(0.2, 1.3, 0.2, 1.4, 2);
  c.p.fabric.material.model = fabric::Model::biquadratic;
  c.p.fabric.material.tension_only = true;
  c.p.substeps = 7;
  return c;
}

/// Adds a vertex, and returns its number.
int add_vertex(CoupledCase& c, const Vector& at, double mass, bool is_free, const Vector& velocity = {}) {
  fabric::Parameters& cloth = c.p.fabric;
  cloth.mesh.rest.push_back(at);
  cloth.mass.push_back(mass);
  cloth.pinned.push_back(is_free ? 0 : 7);
  c.x.push_back(at);
  c.v.push_back(velocity);
  return static_cast<int>(c.x.size()) - 1;
}

/// Adds a line that is slack up to 3 m, with drag, and returns its number.
int add_line(CoupledCase& c, int from, int to, double across, double along) {
  fabric::Mesh& mesh = c.p.fabric.mesh;
  mesh.lines.push_back({from, to});
  mesh.line_stiffness.push_back(100.0);
  mesh.line_length.push_back(3.0);
  const int line = static_cast<int>(mesh.lines.size()) - 1;
  c.p.line_drag.push_back({line, across, along});
  return line;
}

/// Lines to a light vertex and two others, one of them a body; they move.
CoupledCase lines_and_body() {
  CoupledCase c = box();
  const int light = add_vertex(c, {0.5, 0.4, 0.03}, 1e-3, true, {2.0, -1.0, 0.3}),
            heavy = add_vertex(c, {1.4, 1.1, 0.05}, 0.2, true, {0.5, 0.2, 0.0}),
            third = add_vertex(c, {1.5, 0.3, 0.06}, 0.05, true, {-1.0, 0.0, 0.1});
  add_line(c, light, heavy, 1.1 * 0.01, 0.02 * 0.01);
  add_line(c, third, light, 1.1 * 0.004, 0.02 * 0.004);
  c.p.vertex_drag.push_back({heavy, 0.03});
  return c;
}

/// Solver with air in waves.
std::unique_ptr<Solver> started(const CoupledCase& c, device::Backend backend = tested_backend) {
  auto solver = create_solver(backend, c.p);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    std::vector<double> u = download(solver->flow(), flow::velocity_name(axis));
    for (std::size_t k = 0; k < u.size(); ++k) {
      const double across = static_cast<double>(axis == 0 ? k / 24 : k % 24);
      u[k] = 3.0 + 2.0 * std::sin(2.0 * std::numbers::pi * across / (axis == 0 ? 16.0 : 24.0));
    }
    solver->flow().upload(flow::velocity_name(axis), u);
  }
  solver->fabric().upload(c.x, c.v);
  solver->start();
  return solver;
}

std::vector<Vector> drag_of(Solver& solver, const Parameters& p) {
  std::vector<Vector> drag(p.line_drag.size() + p.vertex_drag.size());
  solver.download("drag", numbers(drag));
  return drag;
}

TEST(AirDrag, StepMatchesTheReference) {
  for (const DeltaFunction delta : {DeltaFunction::cbs43, DeltaFunction::ib4}) {
    CoupledCase c = lines_and_body();
    c.p.sheet.delta = delta;
    const auto solver = started(c);
    reference::FaceField air = reference::zero_field(c.grid());
    for (std::size_t axis = 0; axis < 3; ++axis)
      air[axis] = download(solver->flow(), flow::velocity_name(axis));
    const std::size_t first = c.x.size() - 3;
    const auto tail = [&](const auto& all) {
      return std::vector(all.begin() + static_cast<std::ptrdiff_t>(first), all.end());
    };
    reference::DragState state{tail(c.x), tail(c.v), tail(c.p.fabric.mass)};
    // Points of lines are at most a cell apart along 3 m.
    const std::vector<reference::DragLine> lines = {
        {0, 1, 1.1 * 0.01, 0.02 * 0.01, 30}, {2, 0, 1.1 * 0.004, 0.02 * 0.004, 30}, {1, 1, 0.03, 0.0, 1}};
    const std::vector<Vector> points = reference::drag_points(lines, state, dt);
    const std::vector<Vector> forces = reference::take_drag_step(
        lines, reference::interpolate(c.grid(), delta, air, points), density, dt, c.p.substeps, state);
    EXPECT_EQ(solver->advance(1e9, 1, {}), flow::Stop::pause);
    std::vector<Vector> x(c.x.size()), v(c.x.size());
    solver->fabric().download(x, v);
    const auto near = [](const Vector& found, const Vector& expected, double scale) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(found[axis], expected[axis], 1e-12 * scale) << axis;
    };
    for (std::size_t i = 0; i < 3; ++i) {
      near(v[first + i], state.velocities[i], 5.0);
      near(x[first + i], state.positions[i], 2.0);
    }
    const std::vector<Vector> drag = drag_of(*solver, c.p);
    std::vector<Vector> sums(3, Vector{}), on_air(61), expected = forces;
    for (std::size_t k = 0; k < forces.size(); ++k)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        sums[k < 30 ? 0 : k < 60 ? 1 : 2][axis] += forces[k][axis];
        expected[k][axis] *= k < 60 ? -1.0 : 0.0;
      }
    for (std::size_t k = 0; k < 3; ++k) {
      near(drag[k], sums[k], 0.1);
      EXPECT_GT(std::hypot(drag[k][0], drag[k][1]), 0.01);
    }
    solver->download("drag_on_air", numbers(on_air));
    for (std::size_t k = 0; k < on_air.size(); ++k) near(on_air[k], expected[k], 0.01);
    // What the air receives is spread at the points.
    const reference::FaceField densities = reference::spread(c.grid(), delta, points, expected);
    Vector total = solver->total_force_on_air();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const double each : densities[axis]) total[axis] -= each * h * h * h;
      EXPECT_NEAR(total[axis], 0.0, 1e-8) << "but for the strip";
    }
  }
}

/// Force on a line of length 1 m and diameter 0.01 m at rest in a stream of 10 m/s, at an angle from it.
Vector force_on_line(double degrees) {
  CoupledCase c = box();
  const double angle = degrees * std::numbers::pi / 180.0;
  const int a = add_vertex(c, {0.7, 0.3, 0.05}, 0.1, false),
            b = add_vertex(c, {0.7 + std::cos(angle), 0.3 + std::sin(angle), 0.05}, 0.1, false);
  add_line(c, a, b, 1.1 * 0.01, 0.02 * 0.01);
  CoupledRun run(c);
  fill(run.solver->flow(), flow::velocity_name(0), 10.0);
  run.solver->start();
  EXPECT_TRUE(run.advance(1));
  return drag_of(*run.solver, c.p).front();
}

TEST(AirDrag, InclinedLineHasTheForcesOfTheCrossFlowPrinciple) {
  const double pressure = 0.5 * density * 100.0 * 0.01;  // times diameter and length, N
  for (const double degrees : {0.0, 20.0, 45.0, 90.0}) {
    const double s = std::sin(degrees * std::numbers::pi / 180.0),
                 k = std::cos(degrees * std::numbers::pi / 180.0);
    const Vector force = force_on_line(degrees);
    EXPECT_NEAR(force[0], pressure * (1.1 * s * s * s + 0.02 * k * k * k), 1e-11 * pressure) << degrees;
    EXPECT_NEAR(force[1], pressure * (-1.1 * s * s * k + 0.02 * k * k * s), 1e-11 * pressure) << degrees;
    EXPECT_NEAR(force[2], 0.0, 1e-12 * pressure);
  }
}

/// Speed of a body that falls through air at rest after 1 s, m/s, whose terminal speed is 5 m/s.
double speed_of_fall(double step) {
  CoupledCase c = box();
  c.p.flow.fixed_dt = step;
  c.p.substeps = 20;
  const int body = add_vertex(c, {1.2, 0.8, 0.05}, 0.3, true);
  constexpr double gravity = 9.81, terminal = 5.0;
  c.p.vertex_drag.push_back({body, 2.0 * 0.3 * gravity / (density * terminal * terminal)});
  c.p.fabric.gravity = {gravity, 0.0, 0.0};
  CoupledRun run(c);
  EXPECT_EQ(run.solver->advance(1.0, -1, {}), flow::Stop::target);
  run.solver->fabric().download(c.x, c.v);
  return c.v.back()[0];
}

TEST(AirDrag, BodyFallsToItsTerminalSpeed) {
  const double exact = 5.0 * std::tanh(9.81 / 5.0), coarse = speed_of_fall(0.04) - exact,
               fine = speed_of_fall(0.02) - exact;
  EXPECT_LT(std::abs(fine), 5e-3 * exact);
  EXPECT_LT(std::abs(fine), 0.6 * std::abs(coarse));
}

TEST(AirDrag, VerticesWithoutMassTakeTheVelocityOfTheAirAndNoForceTurnsAgainstIt) {
  CoupledCase c = box();
  const int body = add_vertex(c, {1.2, 0.8, 0.05}, 1e-12, true),
            light = add_vertex(c, {0.5, 0.4, 0.05}, 1e-12, true),
            fixed = add_vertex(c, {0.5, 1.1, 0.05}, 0.1, false);
  c.p.vertex_drag.push_back({body, 0.1});
  add_line(c, light, fixed, 1.1 * 0.01, 0.02 * 0.01);
  CoupledRun run(c);
  fill(run.solver->flow(), flow::velocity_name(0), 8.0);
  run.solver->start();
  ASSERT_TRUE(run.advance(1));
  run.solver->fabric().download(c.x, c.v);
  EXPECT_NEAR(c.v[static_cast<std::size_t>(body)][0], 8.0, 1e-6);
  const std::vector<Vector> drag = drag_of(*run.solver, c.p);
  // One end of the line moves with the air, the other does not.
  const double at_rest = 0.5 * density * 64.0 * 0.7 * 1.1 * 0.01;
  EXPECT_GT(drag[0][0], 0.0);
  EXPECT_LT(drag[0][0], at_rest);
  EXPECT_GE(drag[1][0], 0.0);
  EXPECT_LT(drag[1][0], 1e-6);
}

TEST(AirDrag, LinesAndAirKeepTheirMomentum) {
  CoupledCase c = lines_and_body();
  for (std::uint8_t& axes : c.p.fabric.pinned) axes = 0;
  const auto solver = started(c);
  const auto momentum = [&] {
    const flow::Totals air = solver->flow().totals();
    const fabric::Totals cloth = solver->fabric().totals();
    Vector sum{};
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] = air.momentum[axis] + cloth.momentum[axis];
    return sum;
  };
  Vector last = momentum();
  const double scale = std::hypot(last[0], last[1], last[2]);
  double of_lines = 0.0;
  for (std::int64_t step = 1; step <= 30; ++step) {
    ASSERT_EQ(solver->advance(1e9, step, {}), flow::Stop::pause);
    const Vector now = momentum();
    const std::vector<Vector> drag = drag_of(*solver, c.p);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // The body alone has no reaction on the air.
      EXPECT_NEAR(now[axis] - last[axis], dt * drag[2][axis], 1e-14 * scale) << step;
      of_lines = std::max(of_lines, std::abs(dt * drag[0][axis]));
    }
    last = now;
  }
  EXPECT_GT(of_lines, 1e-5 * scale);
}

/// Largest difference of two states.
double distance(const CoupledState& a, const CoupledState& b) {
  double largest = 0.0;
  const auto compare = [&](const std::vector<double>& one, const std::vector<double>& other) {
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t i = 0; i < one.size(); ++i) largest = std::max(largest, std::abs(one[i] - other[i]));
  };
  for (const auto& [name, values] : a.arrays) compare(values, b.arrays.at(name));
  for (std::size_t k = 0; k < 3; ++k) compare(a.flow[k], b.flow[k]);
  return largest;
}

TEST(AirDrag, ContinuesBitForBitAroundACut) {
  CoupledCase c = lines_and_body();
  c.p.cuts = {{0.021, {0}}};
  const auto whole = started(c);
  ASSERT_EQ(whole->advance(1e9, 25, {}), flow::Stop::pause);
  for (const std::int64_t first : {1, 10, 11, 16}) {
    const auto begun = started(c), continued = create_solver(tested_backend, c.p);
    ASSERT_EQ(begun->advance(1e9, first, {}), flow::Stop::pause);
    restore(coupled_state(*begun), *continued);
    ASSERT_EQ(continued->advance(1e9, 25, {}), flow::Stop::pause);
    EXPECT_EQ(distance(coupled_state(*continued), coupled_state(*whole)), 0.0) << first;
    EXPECT_EQ(drag_of(*continued, c.p), drag_of(*whole, c.p)) << first;
  }
}

TEST(AirDrag, LinesThatAreCutHaveNone) {
  CoupledCase c = lines_and_body();
  c.p.cuts = {{0.01, {0}}};
  const auto solver = started(c);
  ASSERT_EQ(solver->advance(0.01, -1, {}), flow::Stop::target);
  EXPECT_NE(drag_of(*solver, c.p)[0], Vector{});
  ASSERT_EQ(solver->advance(0.012, -1, {}), flow::Stop::target);
  const std::vector<Vector> drag = drag_of(*solver, c.p);
  EXPECT_EQ(drag[0], Vector{});
  EXPECT_NE(drag[1], Vector{});
  EXPECT_NE(drag[2], Vector{});
}

TEST(AirDrag, FailedStepsReturnToTheForcesOnTheAir) {
  CoupledCase c = lines_and_body();
  // A weak line without drag from the strip to the light vertex, which flies away from it.
  const std::size_t light = c.x.size() - 3;
  c.p.fabric.mesh.lines.push_back({0, static_cast<int>(light)});
  c.p.fabric.mesh.line_stiffness.push_back(1e-3);
  c.p.fabric.mesh.line_length.push_back(0.5);
  const auto free = started(c);
  ASSERT_EQ(free->advance(1e9, 5, {}), flow::Stop::pause);
  const Vector expected = free->total_force_on_air();
  const std::vector<Vector> drag = drag_of(*free, c.p);
  ASSERT_EQ(free->advance(1e9, 6, {}), flow::Stop::pause);
  std::vector<Vector> x(c.x.size()), v(c.x.size());
  free->fabric().download(x, v);
  const double length = std::hypot(x[0][0] - x[light][0], x[0][1] - x[light][1], x[0][2] - x[light][2]);
  const double none = std::numeric_limits<double>::infinity();
  c.p.line_strength = {none, none, (1.0 - 1e-9) * 1e-3 * (length / 0.5 - 1.0)};
  const auto failing = started(c);
  EXPECT_EQ(failing->advance(1e9, -1, {}), flow::Stop::failed);
  EXPECT_EQ(failing->progress().flow.step, 5);
  EXPECT_EQ(drag_of(*failing, c.p), drag);
  EXPECT_EQ(failing->total_force_on_air(), expected);
}

TEST(AirDrag, BackendsAgree) {
  const CoupledCase c = lines_and_body();
  const auto end = [&](device::Backend backend) {
    const auto solver = started(c, backend);
    EXPECT_EQ(solver->advance(1e9, 20, {}), flow::Stop::pause);
    return coupled_state(*solver);
  };
  const CoupledState here = end(tested_backend);
  for (const device::Backend backend : device::compiled_backends())
    if (backend != tested_backend) {
      EXPECT_LE(distance(here, end(backend)), drogue::testing::run_tolerance);
    }
}

TEST(AirDrag, RunsNoKernelUnlessAskedFor) {
  const auto launches = [](const CoupledCase& c) {
    CoupledRun run(c);
    static_cast<void>(counted_steps(run, 16));
    const auto whole = counted_steps(run, 16), part = counted_steps(run, 4);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(whole[k], part[k]) << k;
    return whole[3] - part[3];
  };
  CoupledCase c = lines_and_body();
  c.p.longest_batch = 1e9;
  const std::int64_t with = launches(c);
  c.p.line_drag.clear();
  c.p.vertex_drag.clear();
  EXPECT_EQ(with - launches(c), 12 * 9);
  const auto solver = create_solver(tested_backend, c.p);
  std::vector<double> none;
  EXPECT_THROW(solver->download("drag", none), std::invalid_argument) << "nor has it arrays";
}

TEST(AirDrag, RejectsInvalidParameters) {
  const auto rejects = [](void (*change)(Parameters&)) {
    CoupledCase c = lines_and_body();
    change(c.p);
    EXPECT_THROW(static_cast<void>(create_solver(tested_backend, c.p)), std::invalid_argument);
  };
  rejects([](Parameters& p) { p.line_drag[0].line = 2; });
  rejects([](Parameters& p) { p.line_drag[0].line = -1; });
  rejects([](Parameters& p) { p.line_drag[0].across = -1.0; });
  rejects([](Parameters& p) { p.line_drag[1].along = std::nan(""); });
  rejects([](Parameters& p) { p.vertex_drag[0].vertex = 100; });
  rejects([](Parameters& p) { p.vertex_drag[0].vertex = -1; });
  rejects([](Parameters& p) { p.vertex_drag[0].area = -1e-9; });
  rejects([](Parameters& p) {
    p.sheet.method = CouplingMethod::sharp;
    p.fabric.pinned.assign(p.fabric.mass.size(), 7);
  });
}

}  // namespace
}  // namespace drogue::coupling
