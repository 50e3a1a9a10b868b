// ctest-label: exact
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "tests/support/coupled_case.hpp"
#include "tests/support/expression_program.hpp"

// A frame of reference that follows a vertex of the cloth.

namespace drogue::coupling {
namespace {

using drogue::testing::counted_steps;
using drogue::testing::coupled_state;
using drogue::testing::CoupledCase;
using drogue::testing::CoupledRun;
using drogue::testing::download;
using drogue::testing::fill;
using drogue::testing::postfix;
using drogue::testing::tested_backend;
using fabric::Vector;
using flow::BoundaryKind;

/// Frees the cloth of a case, and lets the frame follow its first vertex along x.
void follow_first_vertex(CoupledCase& c) {
  for (std::uint8_t& axes : c.p.fabric.pinned) axes = 0;
  c.p.follow.vertices = {{0, 1.0}};
  c.p.follow.axes = {true, false, false};
  c.p.follow.place = c.x.front();
}

struct FabricState {
  std::vector<Vector> x, v;
};

FabricState fabric_of(const CoupledCase& c, Solver& solver) {
  FabricState cloth{std::vector<Vector>(c.x.size()), std::vector<Vector>(c.x.size())};
  solver.fabric().download(cloth.x, cloth.v);
  return cloth;
}

/// Error of decaying vortices in a frame that accelerates with a strip in free fall, which the air does not
/// feel; root mean square of the velocity along x, m/s.
double vortex_error(int n, flow::TimeScheme time) {
  constexpr double length = 2.0 * std::numbers::pi, viscosity = 0.02, fall = 4.0, end = 1.0;
  const double h = length / n;
  CoupledCase c(n, n, h, end / (4 * n));
  c.p.flow.time_scheme = time;
  c.p.flow.viscosity = viscosity * c.p.flow.density;
  c.p.sheet.law = {};
  c.add_strip(3.0, 2.0, 3.0, 3.0, 4);
  follow_first_vertex(c);
  c.p.fabric.gravity = {fall, 0.0, 0.0};
  const auto exact = [&](double x, double y, double t) {
    return std::sin(x) * std::cos(y) * std::exp(-2.0 * viscosity * t);
  };
  const auto run = create_solver(tested_backend, c.p);
  std::vector<double> u, v;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      u.push_back(exact(i * h, (j + 0.5) * h, 0.0));
      v.push_back(-exact(j * h, (i + 0.5) * h, 0.0));
    }
  run->flow().upload("velocity_x", u);
  run->flow().upload("velocity_y", v);
  run->fabric().upload(c.x, c.v);
  run->start();
  EXPECT_EQ(run->advance(end, -1, {}), flow::Stop::target);
  const FrameMotion frame = run->progress().frame;
  EXPECT_GT(frame.velocity[0], 0.8 * fall * end);
  const double moved = frame.position(end)[0];
  EXPECT_GT(moved, 0.3 * fall * end * end);
  const FabricState cloth = fabric_of(c, *run);
  EXPECT_NEAR(cloth.v[0][0] + frame.velocity[0], fall * end, 1e-10);
  EXPECT_NEAR(cloth.x[0][0] + moved - c.x[0][0], 0.5 * fall * end * end, 0.02);
  u = download(run->flow(), "velocity_x");
  double sum = 0.0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double error = u[static_cast<std::size_t>(i + n * j)] + frame.velocity[0] -
                           exact(i * h + moved, (j + 0.5) * h, end);
      sum += error * error;
    }
  return std::sqrt(sum / (n * n));
}

// ctest-label: no-sanitizer
TEST(MovingFrame, DecayingVorticesAreOfSecondOrderInAnAcceleratingFrame) {
  for (const flow::TimeScheme time : {flow::TimeScheme::ab2, flow::TimeScheme::rk3}) {
    // Rates of the old frame would make an error of some dt / 2 times the velocity of the frame: 3e-3 m/s.
    const double coarse = vortex_error(40, time), fine = vortex_error(80, time);
    EXPECT_GT(std::log2(coarse / fine), 1.8) << coarse << " " << fine;
    EXPECT_LT(fine, 1e-4);
  }
}

/// A porous strip that flies through air, which slows it down.
CoupledCase coasting_strip() {
  CoupledCase c(24, 16, 0.1, 0.0);
  c.p.flow.max_dt = 0.004;
  c.add_strip(1.21, 0.4, 1.27, 1.2, 16);
  follow_first_vertex(c);
  c.p.follow.relaxation = 0.3;
  for (std::size_t i = 0; i < c.v.size(); ++i) c.v[i] = {6.0, std::sin(9.0 * c.x[i][1]), 0.0};
  return c;
}

TEST(MovingFrame, KeepsTheMomentumOfClothAndAirInTheFixedFrame) {
  const CoupledCase c = coasting_strip();
  CoupledRun run(c);
  const double air = c.p.flow.density * c.volume(),
               cloth = std::accumulate(c.p.fabric.mass.begin(), c.p.fabric.mass.end(), 0.0);
  const auto momentum = [&] {
    return run.solver->flow().totals().momentum[0] + run.solver->fabric().totals().momentum[0] +
           (air + cloth) * run.solver->progress().frame.velocity[0];
  };
  const double initial = momentum();
  EXPECT_NEAR(initial, 6.0 * cloth, 1e-12);
  double fastest = 0.0;
  for (int block = 0; block < 12; ++block) {
    ASSERT_TRUE(run.advance(16));
    fastest = std::max(fastest, run.solver->progress().frame.velocity[0]);
    EXPECT_NEAR(momentum(), initial, 1e-11 * air * fastest);
    EXPECT_LT(run.solver->flow().totals().divergence_max, 1e-9);
  }
  EXPECT_GT(fastest, 5.9);
  EXPECT_LT(run.solver->progress().frame.velocity[0], 3.0);
}

TEST(MovingFrame, FollowsTheWeightedMeanOfVertices) {
  CoupledCase c = coasting_strip();
  const std::size_t last = c.x.size() - 1;
  c.v[0][0] = 2.0, c.v[3][0] = 5.0, c.v[last][0] = 9.0;
  c.p.follow.vertices = {{0, 0.25}, {3, 0.25}, {static_cast<int>(last), 0.5}};
  c.p.follow.place = {0.25 * (c.x[0][0] + c.x[3][0]) + 0.5 * c.x[last][0] - 0.03, 0.0, 0.0};
  CoupledRun run(c);
  ASSERT_TRUE(run.advance(1));
  const double relaxation = 0.3;
  EXPECT_NEAR(run.solver->progress().frame.velocity[0], 0.25 * 7.0 + 4.5 + 0.03 / relaxation, 1e-12);
}

TEST(MovingFrame, ContinuesBitForBit) {
  for (const flow::TimeScheme time : {flow::TimeScheme::ab2, flow::TimeScheme::rk3}) {
    CoupledCase c = coasting_strip();
    c.p.flow.time_scheme = time;
    CoupledRun whole(c), first(c);
    ASSERT_TRUE(whole.advance(48));
    ASSERT_TRUE(whole.advance(23));
    ASSERT_TRUE(first.advance(48));
    const auto second = create_solver(tested_backend, c.p);
    drogue::testing::restore(coupled_state(*first.solver), *second);
    ASSERT_EQ(second->advance(1e9, 71, {}), flow::Stop::pause);
    EXPECT_EQ(coupled_state(*second).flow, coupled_state(*whole.solver).flow);
    const FabricState one = fabric_of(c, *second), other = fabric_of(c, *whole.solver);
    EXPECT_EQ(one.x, other.x);
    EXPECT_EQ(one.v, other.v);
    EXPECT_EQ(second->progress().frame.velocity, whole.solver->progress().frame.velocity);
    EXPECT_EQ(second->progress().frame.start, whole.solver->progress().frame.start);
    EXPECT_EQ(second->progress().frame.since, whole.solver->progress().frame.since);
    EXPECT_NE(second->progress().frame.velocity[0], first.solver->progress().frame.velocity[0]);
  }
}

TEST(MovingFrame, KeepsTheFallOfAStrip) {
  // Air at rest between an inflow without velocity and an outflow; the strip falls towards the inflow.
  constexpr double h = 0.1, fall = 9.81, end = 0.8;
  double velocity[2], place[2];
  for (int follows = 0; follows < 2; ++follows) {
    CoupledCase c(48, 32, h, 0.0);
    c.p.flow.boundary[0].kind = BoundaryKind::inflow;
    c.p.flow.boundary[1].kind = BoundaryKind::outflow;
    c.p.flow.boundary[2].kind = c.p.flow.boundary[3].kind = BoundaryKind::slip;
    c.p.flow.max_dt = 0.005;
    c.p.flow.cfl = 0.25;
    c.p.sheet.law.impermeable = true;
    c.add_strip(3.0, 1.2, 3.0, 2.0, 16);
    c.set_mass(2.0);
    follow_first_vertex(c);
    c.p.fabric.gravity = {-fall, 0.0, 0.0};
    if (follows == 0) c.p.follow = {};
    CoupledRun run(c);
    ASSERT_EQ(run.solver->advance(end, -1, {}), flow::Stop::target);
    const FabricState cloth = fabric_of(c, *run.solver);
    const FrameMotion frame = run.solver->progress().frame;
    EXPECT_EQ(frame.velocity[0] != 0.0, follows == 1);
    EXPECT_EQ(frame.velocity[1], 0.0);
    velocity[follows] = place[follows] = 0.0;
    const auto count = static_cast<double>(c.x.size());
    for (std::size_t i = 0; i < c.x.size(); ++i) {
      velocity[follows] += (cloth.v[i][0] + frame.velocity[0]) / count;
      place[follows] += (cloth.x[i][0] + frame.position(end)[0] - c.x[i][0]) / count;
    }
    if (follows == 1) {
      EXPECT_NEAR(cloth.x[0][0], c.x[0][0], 0.5);
    }
  }
  // The strip has fallen by more than its own width, and the air has slowed it down.
  EXPECT_LT(place[0], -0.8);
  EXPECT_GT(velocity[0], -0.9 * fall * end);
  EXPECT_NEAR(velocity[1] / velocity[0], 1.0, 0.04);
  EXPECT_NEAR(place[1] / place[0], 1.0, 0.04);
}

TEST(MovingFrame, KeepsAFallFromRestInTheGrid) {
  // Steps of the flow that only the time of a fall through half a cell bounds: 16 of them are a fall of 13 m.
  CoupledCase c(48, 32, 0.1, 0.0);
  c.p.flow.boundary[0].kind = BoundaryKind::inflow;
  c.p.flow.boundary[1].kind = BoundaryKind::outflow;
  c.p.flow.boundary[2].kind = c.p.flow.boundary[3].kind = BoundaryKind::slip;
  c.p.flow.max_dt = 0.1;
  c.p.sheet.law = {};
  c.add_strip(2.4, 1.2, 2.4, 2.0, 16);
  follow_first_vertex(c);
  c.p.fabric.gravity = {-9.81, 0.0, 0.0};
  CoupledRun run(c);
  for (const double time : {0.4, 0.8, 1.6}) {
    ASSERT_EQ(run.solver->advance(time, -1, {}), flow::Stop::target) << time;
    const double fall = 0.5 * 9.81 * time * time;
    EXPECT_NEAR(run.solver->progress().frame.position(time)[0], -fall, fall / 16.0 + 0.05) << time;
    EXPECT_NEAR(fabric_of(c, *run.solver).x[0][0], c.x[0][0], fall / 16.0 + 0.05) << time;
  }
}

TEST(MovingFrame, MovesAnInflowAndKeepsAUniformStreamUniform) {
  // A strip that the air does not feel drifts in a stream that flows in and out: to the bits of round-off.
  CoupledCase c(16, 8, 0.1, 0.004);
  c.p.flow.boundary[0] = {BoundaryKind::inflow, {5.0, 0.3, 0.0}, {}};
  c.p.flow.boundary[1].kind = BoundaryKind::outflow;
  c.p.sheet.law = {};
  c.add_strip(0.8, 0.2, 0.8, 0.6, 8);
  follow_first_vertex(c);
  c.p.fabric.gravity = {-20.0, 0.0, 0.0};
  const auto solver = create_solver(tested_backend, c.p);
  fill(solver->flow(), "velocity_x", 5.0);
  fill(solver->flow(), "velocity_y", 0.3);
  solver->fabric().upload(c.x, c.v);
  solver->start();
  ASSERT_EQ(solver->advance(1e9, 100, {}), flow::Stop::pause);
  const double w = solver->progress().frame.velocity[0];
  EXPECT_LT(w, -5.0);
  for (const double u : download(solver->flow(), "velocity_x")) EXPECT_NEAR(u, 5.0 - w, 1e-12);
  for (const double v : download(solver->flow(), "velocity_y")) EXPECT_NEAR(v, 0.3, 1e-12);
}

TEST(MovingFrame, RejectsInvalidParameters) {
  const auto rejects = [](void (*change)(Parameters&)) {
    CoupledCase c = coasting_strip();
    change(c.p);
    EXPECT_THROW(static_cast<void>(create_solver(tested_backend, c.p)), std::invalid_argument);
  };
  EXPECT_NO_THROW(static_cast<void>(create_solver(tested_backend, coasting_strip().p)));
  rejects([](Parameters& p) { p.follow.vertices[0].vertex = static_cast<int>(p.fabric.mass.size()); });
  rejects([](Parameters& p) { p.follow.vertices[0].weight = 0.5; });
  rejects([](Parameters& p) { p.follow.relaxation = 0.0; });
  rejects([](Parameters& p) { p.follow.relaxation = std::nan(""); });
  rejects([](Parameters& p) { p.follow.place[0] = std::numeric_limits<double>::infinity(); });
  rejects([](Parameters& p) { p.fabric.pinned[5] = 1; });
  rejects([](Parameters& p) { p.fabric.motions.push_back({0, {5}, postfix({"t"})}); });
  rejects([](Parameters& p) { p.follow.axes[2] = true; });
  rejects([](Parameters& p) { p.flow.boundary[0].kind = p.flow.boundary[1].kind = BoundaryKind::slip; });
  rejects([](Parameters& p) {
    p.flow.boundary[0].kind = BoundaryKind::inflow;
    p.flow.boundary[0].velocity_expressions.assign(3, postfix({"t"}));
    p.flow.boundary[1].kind = BoundaryKind::outflow;
  });
  const auto set_frame = [](CoupledRun& run, const Vector& velocity) {
    Progress progress = run.solver->progress();
    progress.frame = {velocity, {}, 0.0};
    run.solver->restore(progress);
  };
  const CoupledCase c = coasting_strip();
  CoupledRun run(c);
  EXPECT_THROW(set_frame(run, {0.0, 1.0, 0.0}), std::invalid_argument);
  CoupledCase still = coasting_strip();
  still.p.follow = {};
  CoupledRun at_rest(still);
  EXPECT_THROW(set_frame(at_rest, {1.0, 0.0, 0.0}), std::invalid_argument);
}

TEST(MovingFrameCounters, CostsNothingWithinABlock) {
  CoupledCase c = coasting_strip();
  c.p.substeps = 16;
  c.p.flow.max_dt = 0.0;
  c.p.flow.fixed_dt = 0.002;
  CoupledRun run(c);
  static_cast<void>(counted_steps(run, 16));
  const auto whole = counted_steps(run, 16), part = counted_steps(run, 4);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(whole[k], part[k]) << k;
}

}  // namespace
}  // namespace drogue::coupling
