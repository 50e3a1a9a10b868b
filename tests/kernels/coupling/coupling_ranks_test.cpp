#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "kernels/flow/halo/decomposition.hpp"
#include "tests/support/coupled_case.hpp"
#include "tests/support/flow_faces.hpp"
#include "tests/support/flow_ranks.hpp"

// Cloth in air on several ranks against itself on one.

namespace drogue::coupling {
namespace {

using drogue::testing::belongs_to_first;
using drogue::testing::cut;
using drogue::testing::first_ranks;
using drogue::testing::joined;
using drogue::testing::tested_backend;
using fabric::Vector;
using flow::BoundaryKind;
using flow::Stop;

constexpr double tolerance = 1e-9, endless = 1e9;

struct Case {
  std::string name;
  Parameters p;
  std::vector<Vector> x, v;
};

struct State : drogue::testing::ClothState {
  std::vector<std::vector<double>> flow;
  std::array<double, 3> total_force{};
  std::vector<double> air = {};  ///< velocities of the air at the vertices, m/s
};

/// A case on the ranks of a group, with whole arrays of the flow.
class SharedRun {
 public:
  SharedRun(const Case& of, const linear::RankGroup& group)
      : _p(of.p.flow),
        _group(group),
        _vertices(of.x.size()),
        _solver(create_solver(tested_backend, of.p, group)) {}

  Solver* operator->() { return _solver.get(); }

  void start(const Case& from) {
    _solver->fabric().upload(from.x, from.v);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // The stream of the inflow, with a wave.
      std::vector<double> wave(linear::CellBox{{}, extents(_p, axis)}.size());
      for (std::size_t i = 0; i < wave.size(); ++i)
        wave[i] = _p.boundary[0].velocity[axis] + 0.3 * std::sin(0.7 * static_cast<double>(i + axis));
      _solver->flow().upload(flow::velocity_name(axis), cut(wave, _solver->flow().state()[axis]));
    }
    _solver->start();
  }
  void restore(const State& state) {
    std::size_t k = 0;
    for (const stepping::StateArray& array : _solver->flow().state())
      _solver->flow().upload(array.name, cut(state.flow[k++], array));
    drogue::testing::restore_cloth(*_solver, state);
  }
  [[nodiscard]] State state() {
    State s{drogue::testing::cloth_state(*_solver), {}, _solver->total_force_on_air()};
    std::vector<Vector> air(_vertices);
    _solver->air_velocity(air);
    s.air.assign(numbers(air).begin(), numbers(air).end());
    for (const stepping::StateArray& array : _solver->flow().state())
      s.flow.push_back(joined(_group, _solver->flow(), array));
    return s;
  }
  /// Numbers of the cloth as the ranks have them, one row per rank.
  [[nodiscard]] std::vector<std::vector<double>> cloth_of_ranks() {
    std::vector<Vector> x(_vertices), v(_vertices);
    _solver->fabric().download(x, v);
    x.insert(x.end(), v.begin(), v.end());
    const std::vector<double> all = _group.gather({x.front().data(), 3 * x.size()});
    std::vector<std::vector<double>> rows;
    for (auto row = all.begin(); row != all.end(); row += static_cast<std::ptrdiff_t>(3 * x.size()))
      rows.emplace_back(row, row + static_cast<std::ptrdiff_t>(3 * x.size()));
    return rows;
  }

 private:
  flow::Parameters _p;
  linear::RankGroup _group;
  std::size_t _vertices;
  std::unique_ptr<Solver> _solver;
};

/// Box of cells of 0.1 m with an inflow along x, and a square sheet of 49 vertices that lies askew in it and
/// moves towards high y and z. Devices divide z alone, where four ranks need three planes each.
Case sheet_in(const std::string& name, std::array<int, 3> cells) {
  constexpr double h = 0.1, edge = 0.06;
  constexpr int rows = 7;
  if (device::needs_device(tested_backend)) cells[2] = std::max(cells[2], 12);
  Case c;
  c.name = name;
  c.p.flow.cells = cells;
  c.p.flow.low = {-0.2, 0.3, 1.0};
  for (std::size_t axis = 0; axis < 3; ++axis) c.p.flow.high[axis] = c.p.flow.low[axis] + h * cells[axis];
  c.p.flow.density = 1.2;
  c.p.flow.viscosity = 1e-3;
  c.p.flow.max_dt = 0.004;
  c.p.flow.time_scheme = flow::TimeScheme::ab2;
  c.p.sheet.law = {20.0, 5.0, false};
  fabric::Parameters& cloth = c.p.fabric;
  for (int k = 0; k < rows; ++k)
    for (int j = 0; j < rows; ++j) {
      const double a = edge * (j - 3), b = edge * (k - 3);
      Vector place{0.3 * a + 0.2 * b, 0.9 * a, cells[2] > 1 ? 0.9 * b : 0.0};
      for (std::size_t axis = 0; axis < 3; ++axis)
        place[axis] += 0.5 * (c.p.flow.low[axis] + c.p.flow.high[axis]);
      cloth.mesh.rest.push_back(place);
      if (j + 1 == rows || k + 1 == rows) continue;
      const int at = rows * k + j;
      cloth.mesh.triangles.push_back({at, at + 1, at + rows});
      cloth.mesh.triangles.push_back({at + 1, at + rows + 1, at + rows});
    }
  cloth.mass = fabric::lumped_masses(cloth.mesh, 0.05, 0.0, fabric::Lumping::area);
  cloth.material.membrane_modulus = 500.0;
  c.x = cloth.mesh.rest;
  for (std::size_t i = 0; i < c.x.size(); ++i)
    c.v.push_back({0.5, 0.8 + 0.1 * std::sin(1.3 * static_cast<double>(i)), 0.6});
  c.p.flow.boundary[0].velocity = {1.5, 0.0, 0.0};
  return c;
}

void set_stream(Case& c) {
  c.p.flow.boundary[0].kind = BoundaryKind::inflow;
  c.p.flow.boundary[1].kind = BoundaryKind::outflow;
}

/// Periodic and bounded boxes that four ranks divide along y and z, along y, and along z.
std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back(sheet_in("periodic", {8, 9, 10}));
  all.back().p.sheet.leak_filter = 0.5;
  all.back().p.sheet.edge_inset = 0.55;
  Case& channel = all.emplace_back(sheet_in("channel", {12, 9, 8}));
  set_stream(channel);
  for (const std::size_t side : {2U, 3U, 4U}) channel.p.flow.boundary[side].kind = BoundaryKind::slip;
  channel.p.flow.boundary[5].kind = BoundaryKind::outflow;
  channel.p.flow.time_scheme = flow::TimeScheme::rk3;
  channel.p.flow.turbulence = flow::Turbulence::vreman;
  channel.p.sheet.law.no_slip = true;
  channel.p.sheet.delta = DeltaFunction::ib4;
  // A line across the sheet with drag, and a body at one of its ends.
  channel.p.fabric.mesh.lines = {{0, 24}, {24, 48}};
  channel.p.fabric.mesh.line_stiffness = {0.1, 0.1};
  channel.p.line_drag = {{0, 0.011, 2e-4}, {1, 0.011, 2e-4}};
  channel.p.vertex_drag = {{24, 0.003}};
  // In the core of a stretched grid.
  Case& core = all.emplace_back(sheet_in("core", {20, 20, 19}));
  set_stream(core);
  for (const std::size_t side : {2U, 3U, 4U, 5U}) core.p.flow.boundary[side].kind = BoundaryKind::slip;
  for (const auto& [axis, cells] : {std::pair{0U, 16}, {1U, 14}, {2U, 13}})
    drogue::testing::set_graded_widths(core.p.flow, axis, cells, 1.1, 1.5);
  core.p.sheet.edge_inset = 0.55;
  // At rest, as a body.
  Case& rigid = all.emplace_back(sheet_in("rigid", {10, 8, 17}));
  set_stream(rigid);
  rigid.p.fabric.pinned.assign(rigid.x.size(), 7);
  rigid.p.substeps = 1;
  rigid.p.flow.fixed_dt = 0.003;
  rigid.v.assign(rigid.x.size(), Vector{});
  return all;
}

/// Largest difference relative to the largest number, or to 1.
double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = a.size() == b.size() ? 0.0 : endless, scale = 1.0;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
    scale = std::max(scale, std::abs(a[i]));
    difference = std::max(difference, std::isfinite(b[i]) ? std::abs(a[i] - b[i]) : endless);
  }
  return difference / scale;
}

void expect_near(const State& a, const State& b, const std::string& what) {
  EXPECT_EQ(a.progress.flow.step, b.progress.flow.step) << what;
  EXPECT_EQ(a.progress.block.substeps, b.progress.block.substeps) << what;
  EXPECT_EQ(a.progress.block.end, b.progress.block.end) << what;
  EXPECT_NEAR(a.progress.flow.time, b.progress.flow.time, tolerance) << what;
  for (std::size_t k = 0; k < a.flow.size(); ++k)
    EXPECT_LT(relative_difference(a.flow[k], b.flow[k]), tolerance) << what << ", array " << k;
  for (const auto& [name, values] : a.arrays)
    EXPECT_LT(relative_difference(values, b.arrays.at(name)), tolerance) << what << ", " << name;
  EXPECT_LT(relative_difference(a.force, b.force), tolerance) << what << ", forces";
  EXPECT_LT(relative_difference(a.air, b.air), tolerance) << what << ", velocities of the air";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(a.total_force[axis], b.total_force[axis], tolerance) << what;
    EXPECT_NEAR(a.progress.frame.velocity[axis], b.progress.frame.velocity[axis], tolerance) << what;
  }
}

void expect_equal(const State& a, const State& b, const std::string& what) {
  EXPECT_EQ(a.flow, b.flow) << what;
  EXPECT_EQ(a.arrays, b.arrays) << what;
  EXPECT_EQ(a.force, b.force) << what;
  EXPECT_EQ(a.air, b.air) << what;
  EXPECT_EQ(a.total_force, b.total_force) << what;
  EXPECT_EQ(a.progress.flow.time, b.progress.flow.time) << what;
}

/// Whether the whole cloth has the same bits on all ranks.
void expect_one_cloth(SharedRun& run, const std::string& what) {
  const auto cloth = run.cloth_of_ranks();
  for (const auto& row : cloth) EXPECT_EQ(cloth.front(), row) << what;
}

class CoupledRanks : public ::testing::Test {
 protected:
  void SetUp() override {
    if (linear::RankGroup::world().size() != 4) GTEST_SKIP() << "needs mpirun with four ranks";
  }
};

TEST_F(CoupledRanks, TakeTheStepsOfOneRank) {
  for (const Case& each : cases())
    for (const int ranks : {2, 4}) {
      if (ranks == 2 && each.name != "periodic") continue;
      const linear::RankGroup group = first_ranks(ranks);
      if (!belongs_to_first(ranks)) continue;
      const std::string what = each.name + " on " + std::to_string(ranks) + " ranks";
      SharedRun single(each, {}), shared(each, group);
      single.start(each);
      shared.start(each);
      for (const int step : {1, 50}) {
        EXPECT_EQ(Stop::pause, single->advance(endless, step, {})) << what;
        EXPECT_EQ(Stop::pause, shared->advance(endless, step, {})) << what;
        const State expected = single.state();
        expect_near(expected, shared.state(), what + " after step " + std::to_string(step));
        double force = 0.0;
        for (const double f : expected.force) force = std::max(force, std::abs(f));
        EXPECT_GT(force, 1e-5) << what;
      }
      expect_one_cloth(shared, what);
    }
}

TEST_F(CoupledRanks, ContinueBitForBitOnAsManyRanksAndNearlyOnOthers) {
  const Case each = cases()[0];
  SharedRun first(each, linear::RankGroup::world());
  first.start(each);
  EXPECT_EQ(Stop::pause, first->advance(endless, 7, {}));
  const State saved = first.state();
  EXPECT_EQ(Stop::pause, first->advance(endless, 20, {}));
  const State expected = first.state();
  for (const int ranks : {4, 2, 1}) {
    const linear::RankGroup group = first_ranks(ranks);
    if (!belongs_to_first(ranks)) continue;
    SharedRun next(each, group);
    next.restore(saved);
    EXPECT_EQ(Stop::pause, next->advance(endless, 20, {}));
    const State found = next.state();
    if (ranks == 4)
      expect_equal(expected, found, "on four ranks");
    else
      expect_near(expected, found, "on " + std::to_string(ranks));
  }
}

TEST_F(CoupledRanks, FollowAVertexAsOneRank) {
  Case each = sheet_in("moving frame", {12, 9, 8});
  set_stream(each);
  each.p.follow = {{{24, 1.0}}, {true, false, true}, each.x[24], 0.2};
  each.p.fabric.gravity = {0.0, 0.0, -9.81};
  SharedRun single(each, {}), shared(each, linear::RankGroup::world());
  single.start(each);
  shared.start(each);
  EXPECT_EQ(Stop::pause, single->advance(endless, 20, {}));
  EXPECT_EQ(Stop::pause, shared->advance(endless, 20, {}));
  const State expected = single.state();
  EXPECT_GT(std::abs(expected.progress.frame.velocity[2]), 0.1);
  expect_near(expected, shared.state(), each.name);
}

/// Runs a case that fails on one rank and on four: both keep the state before the step that failed.
void expect_failure(const Case& each, FailureReason reason) {
  SharedRun single(each, {}), shared(each, linear::RankGroup::world()),
      again(each, linear::RankGroup::world());
  for (SharedRun* run : {&single, &shared, &again}) run->start(each);
  ASSERT_EQ(Stop::failed, single->advance(endless, -1, {})) << each.name;
  ASSERT_EQ(Stop::failed, shared->advance(endless, -1, {})) << each.name;
  EXPECT_EQ(reason, single->failure().reason) << each.name;
  EXPECT_EQ(reason, shared->failure().reason) << each.name;
  const State last = shared.state();
  EXPECT_EQ(single->progress().flow.step, last.progress.flow.step) << each.name;
  if (last.progress.flow.step > 0) {
    ASSERT_EQ(Stop::pause, again->advance(endless, last.progress.flow.step, {})) << each.name;
  }
  expect_equal(again.state(), last, each.name);
  EXPECT_EQ(Stop::failed, shared->advance(endless, -1, {})) << each.name;
}

TEST_F(CoupledRanks, FailTogetherAndKeepTheState) {
  Case leaves = cases()[1];
  leaves.name = "leaves the domain";
  leaves.p.sheet.law = {};
  for (Vector& v : leaves.v) v = {0.0, 0.0, 9.0};
  expect_failure(leaves, FailureReason::left_domain);
  Case unstable = cases()[0];
  unstable.name = "unstable cloth";
  unstable.p.fabric.material.membrane_modulus = 1e7;
  unstable.p.substeps = 80;
  expect_failure(unstable, FailureReason::cloth);
}

TEST_F(CoupledRanks, ShortenTheStepsOfABlockTogether) {
  Case each = cases()[0];
  each.p.flow.body_force = {900.0, 0.0, 0.0};
  SharedRun single(each, {}), shared(each, linear::RankGroup::world());
  for (SharedRun* run : {&single, &shared}) {
    run->start(each);
    EXPECT_EQ(Stop::target, (*run)->advance(0.064, -1, {}));
    EXPECT_LT((*run)->progress().flow.dt_min, 0.6 * (*run)->progress().flow.dt_max);
  }
  expect_near(single.state(), shared.state(), "accelerated");
}

TEST_F(CoupledRanks, KeepTheStepsEqualIfOneRankIsInterrupted) {
  const Case each = cases()[0];
  const linear::RankGroup world = linear::RankGroup::world();
  SharedRun shared(each, world);
  shared.start(each);
  EXPECT_EQ(Stop::interrupted, shared->advance(endless, -1, [&](const flow::Status& now) {
    return world.rank() != 3 || now.step < 20;
  }));
  // Between two polls lie a few steps, the same on all ranks.
  EXPECT_GE(shared->progress().flow.step, 20);
  EXPECT_LE(shared->progress().flow.step, 32);
  EXPECT_EQ(Stop::pause, shared->advance(endless, 33, [](const flow::Status&) { return true; }));
  expect_one_cloth(shared, "after an interrupt");
}

}  // namespace
}  // namespace drogue::coupling
