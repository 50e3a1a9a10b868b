#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kernels/mesh/round_surfaces.hpp"
#include "tests/support/coupled_case.hpp"
#include "tests/support/expression_program.hpp"

// Rigid sheets: prescribed motion, no slip, and the balance of forces.

namespace drogue::coupling {
namespace {

using drogue::testing::counted_steps;
using drogue::testing::CoupledCase;
using drogue::testing::CoupledRun;
using drogue::testing::download;
using drogue::testing::fill;
using drogue::testing::postfix;
using fabric::Vector;
using flow::BoundaryKind;

/// Moves all vertices of a case by a displacement along an axis, m.
void move(CoupledCase& c, int axis, const device::ExpressionProgram& displacement) {
  std::vector<int> all(c.x.size());
  std::iota(all.begin(), all.end(), 0);
  c.p.fabric.motions.push_back({axis, all, displacement});
}

device::ExpressionProgram sine(double amplitude, double omega) {
  return postfix({amplitude, omega, "t", "*", "sin", "*"});
}

/// Velocity along x in the middle of the rows of cells, m/s.
std::vector<double> profile(const CoupledCase& c, CoupledRun& run) {
  const std::vector<double> u = download(run.solver->flow(), "velocity_x");
  std::vector<double> rows;
  for (std::size_t k = 0; k < u.size(); k += u.size() / static_cast<std::size_t>(c.p.flow.cells[1]))
    rows.push_back(u[k]);
  return rows;
}

TEST(MovingSheet, CarriesTheFluidOfAChannelWithIt) {
  // The fluid moves as a whole. The filtered acceleration lags by two steps and concerns the fluid beyond the
  // 2.1 h that move with a vertex: the error is some 2 (16 / 2.1 - 1) (omega dt)^2.
  constexpr double amplitude = 0.05, omega = 2.0 * std::numbers::pi, h = 0.1, end = 1.1;
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const int steps = 220 << level;
    CoupledCase c(16, 4, h, end / steps);
    c.add_strip(0.83, 0.0, 0.83, 0.4, 8);
    c.p.sheet.law.impermeable = true;
    c.p.substeps = 1;
    move(c, 0, sine(amplitude, omega));
    CoupledRun run(c);
    ASSERT_TRUE(run.advance(steps));
    const double mass = c.p.flow.density * c.volume(), speed = amplitude * omega * std::cos(omega * end);
    error[level] = std::abs(run.solver->flow().totals().momentum[0] / mass - speed) / (amplitude * omega);
    std::vector<Vector> x(c.x.size()), v(c.x.size());
    run.solver->fabric().download(x, v);
    EXPECT_NEAR(x[0][0] - c.x[0][0], amplitude * std::sin(omega * end), 1e-12);
  }
  EXPECT_LT(error[1], 4e-3);
  EXPECT_GT(error[0] / error[1], 3.0);
}

TEST(MovingSheet, IsWhereItsMotionIsDefined) {
  // A step after the end of the run at most; no fixed time after its start.
  for (const double defined_until : {1.0, 0.06}) {
    CoupledCase c(16, 4, 0.1, 0.005);
    c.add_strip(0.83, 0.0, 0.83, 0.4, 8);
    c.p.sheet.law.impermeable = true;
    move(c, 0, postfix({0.1, defined_until, "t", "-", 1.5, "^", "*"}));
    CoupledRun run(c);
    ASSERT_TRUE(run.advance(10)) << defined_until;
    std::vector<Vector> x(c.x.size()), v(c.x.size());
    run.solver->fabric().download(x, v);
    EXPECT_NEAR(x[0][0] - c.x[0][0], 0.1 * std::pow(defined_until - 0.05, 1.5), 1e-9);
    EXPECT_GT(std::abs(run.force()[0]), 1e-4) << "the air feels it";
  }
}

TEST(MovingSheet, MotionThatIsNotFiniteFails) {
  struct Case {
    const char* what;
    device::ExpressionProgram motion;
    int steps;  ///< that are taken: the velocity needs the motion a step ahead
  };
  const Case cases[] = {{"from the start", postfix({"t", "sqrt", "negate", 0.5, "-", "sqrt"}), 0},
                        {"during the run", postfix({0.1, 0.0325, "t", "-", "sqrt", "*"}), 5}};
  for (const Case& each : cases) {
    CoupledCase c(16, 4, 0.1, 0.005);
    c.add_strip(0.83, 0.0, 0.83, 0.4, 8);
    c.p.sheet.law.impermeable = true;
    move(c, 0, each.motion);
    CoupledRun run(c);
    EXPECT_FALSE(run.advance(10)) << each.what;
    EXPECT_EQ(run.solver->failure().reason, FailureReason::cloth) << each.what;
    ASSERT_TRUE(run.solver->failure().cloth) << each.what;
    EXPECT_EQ(run.solver->progress().flow.step, each.steps) << each.what;
  }
}

TEST(MovingSheet, NeitherFencesNorAllocatesNorCopiesInSteps) {
  CoupledCase c(16, 4, 0.1, 0.005);
  c.add_strip(0.83, 0.0, 0.83, 0.4, 8);
  c.p.sheet.law = {0.0, 0.0, true, true};
  c.p.substeps = 4;
  move(c, 0, sine(0.05, 6.0));
  CoupledRun run(c);
  static_cast<void>(counted_steps(run, 16));
  // Blocks of 16 steps and of 4.
  const auto whole = counted_steps(run, 16), part = counted_steps(run, 4);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(whole[k], part[k]) << k;
}

/// Distance, m, between a sheet without slip and the plane in which the linear velocity profile between it
/// and a wall reaches the velocity of the sheet.
double couette_displacement(int rows, double leak_filter = 0.0) {
  constexpr double speed = 0.5, place = 0.5;
  const double h = 0.8 / rows, viscosity = 0.1;
  CoupledCase c(4, rows, h, 0.0);
  c.p.flow.viscosity = viscosity;
  c.p.flow.fixed_dt = 0.1 * h * h * c.p.flow.density / viscosity;
  c.p.flow.boundary[2].kind = BoundaryKind::wall;
  c.p.flow.boundary[3].kind = BoundaryKind::slip;
  c.add_strip(0.0, place, 4.0 * h, place, 8);
  for (Vector& v : c.v) v[0] = speed;
  c.p.sheet.law = {0.0, 0.0, true, true};
  c.p.sheet.leak_filter = leak_filter;
  c.p.substeps = 1;
  CoupledRun run(c);
  EXPECT_TRUE(run.advance(30 * rows * rows));
  const std::vector<double> u = profile(c, run);
  const double slope = u[0] / (0.5 * h);
  for (int j = 0; (j + 0.5) * h < place - 2.0 * h; ++j)
    EXPECT_NEAR(u[static_cast<std::size_t>(j)], slope * (j + 0.5) * h, 1e-4 * speed);
  EXPECT_NEAR(run.force()[0], slope * viscosity * 4.0 * h * c.width(), 1e-4 * std::abs(run.force()[0]));
  return place - speed / slope;
}

// ctest-label: no-sanitizer
TEST(NoSlipSheet, MovesTheFluidToAWallWithALinearProfile) {
  // The delta function acts as a sheet that is nearer to the wall by half of the mean distance of two points
  // spread by it, 0.28 h.
  const double coarse = couette_displacement(8), fine = couette_displacement(16);
  EXPECT_GT(coarse, 0.02);
  EXPECT_LT(coarse, 0.035);
  EXPECT_NEAR(coarse / fine, 2.0, 0.1);
  // Equal impulses on a flat sheet have no defect.
  EXPECT_NEAR(couette_displacement(8, 0.5) / coarse, 1.0, 1e-9);
}

/// Largest error against Stokes' second problem, relative to the amplitude, after four periods.
double stokes_error(int rows) {
  constexpr double height = 3.2, omega = 2.0 * std::numbers::pi, decay = 5.0, speed = 1.0;
  const double h = height / rows, nu = omega / (2.0 * decay * decay);
  const int steps = 4 * static_cast<int>(std::ceil(1.0 / (0.1 * h * h / nu)));
  CoupledCase c(4, rows, h, 4.0 / steps);
  c.p.flow.viscosity = nu * c.p.flow.density;
  c.add_strip(0.0, 0.5 * height, 4.0 * h, 0.5 * height, 8);
  c.p.sheet.law = {0.0, 0.0, true, true};
  c.p.substeps = 1;
  move(c, 0, sine(speed / omega, omega));
  CoupledRun run(c);
  EXPECT_TRUE(run.advance(steps));
  const std::vector<double> u = profile(c, run);
  double largest = 0.0;
  for (int j = 0; j < rows; ++j) {
    const double distance = decay * std::abs((j + 0.5) * h - 0.5 * height);
    if (distance < decay * 2.0 * h) continue;
    const double exact = speed * std::exp(-distance) * std::cos(omega * 4.0 - distance);
    largest = std::max(largest, std::abs(u[static_cast<std::size_t>(j)] - exact) / speed);
  }
  return largest;
}

// ctest-label: no-sanitizer
TEST(NoSlipSheet, OscillatesInItsPlaneAsAWall) {
  const double coarse = stokes_error(64), fine = stokes_error(128);
  EXPECT_LT(fine, 0.08);
  EXPECT_NEAR(coarse / fine, 2.0, 0.4);
}

/// Adds a rigid sheet without slip and without flow through it, each vertex of the mesh at its `place`.
template <class Place>
void add_rigid(CoupledCase& c, const mesh::Mesh& sheet, const Place& place) {
  c.p.fabric.mesh = sheet;
  for (Vector& at : c.p.fabric.mesh.rest) at = place(at);
  c.x = c.p.fabric.mesh.rest;
  c.v.assign(c.x.size(), Vector{});
  c.p.fabric.pinned.assign(c.x.size(), 7);
  c.set_mass(1.0);
  c.p.sheet.law = {0.0, 0.0, true, true};
  c.p.substeps = 1;
}

/// Adds a circle without slip.
void add_circle(CoupledCase& c, double x, double y, double radius, int vertices) {
  add_rigid(c, mesh::tube(radius, c.width(), vertices, 1), [&](const Vector& at) {
    return Vector{at[0] + x, at[1] + y, at[2] + 0.5 * c.width()};
  });
}

TEST(NoSlipSheet, MovesThroughFluidAtRestAsItStandsInAStream) {
  constexpr double h = 0.1, speed = 1.0;
  CoupledCase c(48, 32, h, 0.02);
  c.p.flow.viscosity = 0.024;  // Reynolds number 40
  add_circle(c, 2.4, 1.6, 0.4, 50);
  CoupledRun fixed(c);
  fill(fixed.solver->flow(), "velocity_x", speed);
  fixed.solver->start();
  move(c, 0, postfix({-speed, "t", "*"}));
  CoupledRun moving(c);
  for (CoupledRun* run : {&fixed, &moving}) {
    ASSERT_TRUE(run->advance(50));
    EXPECT_NEAR(run->force()[1], 0.0, 1e-3);
  }
  EXPECT_LT(fixed.force()[0], -0.01);
  EXPECT_NEAR(moving.force()[0] / fixed.force()[0], 1.0, 0.03);
}

/// Velocity of the fluid at the vertices of a circle without slip, and its part along the normals, root mean
/// squares relative to a stream of Reynolds number 40 that has started at once 2 s before, and the drag, N/m.
struct CircleInStream {
  double slip = 0.0, through = 0.0, drag = 0.0;

  explicit CircleInStream(double leak_filter) {
    constexpr double speed = 1.0;
    CoupledCase c(48, 32, 0.1, 0.01);
    c.p.flow.viscosity = 0.024;
    c.p.sheet.leak_filter = leak_filter;
    add_circle(c, 2.4, 1.6, 0.4, 50);
    CoupledRun run(c);
    fill(run.solver->flow(), "velocity_x", speed);
    run.solver->start();
    EXPECT_TRUE(run.advance(200));
    std::vector<Vector> air(c.x.size());
    run.solver->air_velocity(air);
    double square = 0.0, of_normal = 0.0;
    for (std::size_t i = 0; i < air.size(); ++i) {
      const double x = c.x[i][0] - 2.4, y = c.x[i][1] - 1.6, normal = (air[i][0] * x + air[i][1] * y) / 0.4;
      square += air[i][0] * air[i][0] + air[i][1] * air[i][1];
      of_normal += normal * normal;
    }
    slip = std::sqrt(square / static_cast<double>(air.size())) / speed;
    through = std::sqrt(of_normal / static_cast<double>(air.size())) / speed;
    drag = -run.force()[0] / c.width();
  }
};

TEST(NoSlipSheet, LessFluidPassesACircleWithTheSmoothedDefect) {
  const CircleInStream without(0.0), with(0.5);
  EXPECT_NEAR(without.slip, 3.9e-3, 4e-4);
  EXPECT_LT(with.slip, without.slip);
  EXPECT_NEAR(without.through, 2.8e-3, 3e-4);
  EXPECT_LT(with.through, 0.93 * without.through);
  EXPECT_NEAR(with.drag / without.drag, 1.0, 5e-3);
}

TEST(NoSlipSheet, TakesTheMomentumThatThePeriodicFluidLoses) {
  CoupledCase c(32, 16, 0.1, 0.01);
  c.p.flow.viscosity = 0.02;
  c.p.flow.body_force = {0.5, 0.0, 0.0};
  c.p.sheet.leak_filter = 0.5;
  add_circle(c, 1.33, 0.81, 0.4, 50);
  CoupledRun run(c);
  const auto momentum = [&] { return run.solver->flow().totals().momentum[0]; };
  double before = momentum();
  for (int step = 0; step < 100; ++step) {
    ASSERT_TRUE(run.advance(1));
    const double now = momentum(), gain = (0.5 * c.volume() + run.force()[0]) * c.p.flow.fixed_dt;
    EXPECT_NEAR(now - before, gain, 1e-13);
    before = now;
  }
  EXPECT_LT(run.force()[0], -0.1);
}

/// Puts a case into a channel: a stream of 1 m/s along x at Reynolds number 40 by 0.8 m, sides without
/// friction.
void set_channel(CoupledCase& c) {
  c.p.flow.viscosity = 0.024;
  c.p.flow.boundary[0] = {BoundaryKind::inflow, {1.0, 0.0, 0.0}, {}};
  c.p.flow.boundary[1].kind = BoundaryKind::outflow;
  for (std::size_t side = 2; side < 2 * (c.p.flow.cells[2] > 1 ? 3 : 2); ++side)
    c.p.flow.boundary[side].kind = BoundaryKind::slip;
}

/// Drag of a rigid sheet in a channel, by its vertices and by the balance of momentum between two planes
/// across the channel, N, after some steps.
struct ChannelDrag {
  double vertices = 0.0, balance = 0.0;

  ChannelDrag(const CoupledCase& c, std::int64_t steps, const std::array<std::size_t, 2>& planes) {
    CoupledRun run(c);
    const flow::Parameters& p = c.p.flow;
    const auto nx = static_cast<std::size_t>(p.cells[0]);
    const auto rows = static_cast<std::size_t>(p.cells[1]) * static_cast<std::size_t>(p.cells[2]);
    const double h = p.high[0] / p.cells[0], area = p.high[1] * p.high[2] / static_cast<double>(rows);
    // Momentum between the planes, and what advection and viscosity carry through them.
    const auto contents = [&] {
      const std::vector<double> u = download(run.solver->flow(), "velocity_x");
      std::array<double, 2> sum{};
      for (std::size_t row = 0; row < rows; ++row) {
        const double* at = &u[(nx + 1) * row];
        for (std::size_t i = planes[0]; i <= planes[1]; ++i)
          sum[0] += (i == planes[0] || i == planes[1] ? 0.5 : 1.0) * at[i] * p.density * area * h;
        for (const std::size_t i : planes)
          sum[1] += (i == planes[0] ? area : -area) *
                    (p.density * at[i] * at[i] - 2.0 * p.viscosity * (at[i + 1] - at[i - 1]) / (2.0 * h));
      }
      return sum;
    };
    EXPECT_TRUE(run.advance(steps));
    const std::array<double, 2> before = contents();
    EXPECT_TRUE(run.advance(1));
    const std::array<double, 2> after = contents();
    const std::vector<double> q = download(run.solver->flow(), "pressure");
    for (std::size_t row = 0; row < rows; ++row)
      for (const std::size_t i : planes)
        balance += (i == planes[0] ? 0.5 : -0.5) * p.density * area * (q[i - 1 + nx * row] + q[i + nx * row]);
    balance += 0.5 * (before[1] + after[1]) - (after[0] - before[0]) / p.fixed_dt;
    vertices = -run.force()[0];
  }
};

// ctest-label: no-sanitizer
TEST(NoSlipSheet, ForceEqualsTheMomentumBalanceOfAControlVolume) {
  CoupledCase c(64, 32, 0.1, 0.0125);
  set_channel(c);
  add_circle(c, 2.0, 1.6, 0.4, 50);
  const ChannelDrag drag(c, 1000, {8, 50});
  EXPECT_GT(drag.vertices, 0.01);
  EXPECT_NEAR(drag.balance / drag.vertices, 1.0, 1e-3);
}

/// Channel of three dimensions with a rigid sheet 0.8 m wide, whose axis of symmetry turns from z to x.
CoupledCase channel_with(const mesh::Mesh& sheet, bool no_slip) {
  CoupledCase c(40, 20, 0.1, 0.0125);
  c.p.flow.cells[2] = c.p.flow.cells[1];
  c.p.flow.high[2] = c.p.flow.high[1];
  set_channel(c);
  add_rigid(c, sheet, [](const Vector& at) { return Vector{at[2] + 1.4, at[0] + 1.0, at[1] + 1.0}; });
  c.p.sheet.law.no_slip = no_slip;
  return c;
}

// ctest-label: no-sanitizer
TEST(NoSlipSheet, ForcesOnASphereAndADiskEqualTheBalanceOfAControlVolume) {
  const ChannelDrag sphere(channel_with(mesh::sphere(0.4, 11), true), 320, {6, 33});
  EXPECT_GT(sphere.vertices, 0.4);
  EXPECT_NEAR(sphere.balance / sphere.vertices, 1.0, 2e-3);
  CoupledCase c = channel_with(mesh::disk(0.4, 13), false);
  for (const double inset : {0.0, 0.55}) {
    c.p.sheet.edge_inset = inset;
    const ChannelDrag disk(c, 320, {6, 33});
    EXPECT_GT(disk.vertices, 0.4);
    EXPECT_NEAR(disk.balance / disk.vertices, 1.0, 2e-3) << inset;
  }
}

}  // namespace
}  // namespace drogue::coupling
