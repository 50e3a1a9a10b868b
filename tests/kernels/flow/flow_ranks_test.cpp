#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kernels/flow/halo/decomposition.hpp"
#include "tests/support/flow_case.hpp"
#include "tests/support/flow_faces.hpp"
#include "tests/support/flow_ranks.hpp"
#include "tests/support/profiled.hpp"

// The flow solver on several ranks against itself on one.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests

constexpr const auto& backend = testing::tested_backend;
constexpr double tolerance = 1e-10;

/// A solver on the ranks of a group, with whole arrays.
class SharedSolver {
 public:
  SharedSolver(const Parameters& p, const linear::RankGroup& group)
      : _p(p),
        _group(group),
        _ranks(ranks_of(p, group.size(), group.rank(), device::needs_device(backend))),
        _solver(create_solver(backend, p, group)) {}

  Solver* operator->() { return _solver.get(); }

  /// Sets the first arrays of the state.
  template <class Arrays>
  void upload(const Arrays& arrays) {
    const std::vector<stepping::StateArray> state = _solver->state();
    for (std::size_t i = 0; i < arrays.size(); ++i) _solver->upload(state[i].name, cut(arrays[i], state[i]));
  }
  void start(const StaggeredField& u) {
    upload(u);
    _solver->start();
  }
  std::vector<std::vector<double>> state() {
    std::vector<std::vector<double>> arrays;
    for (const stepping::StateArray& array : _solver->state())
      arrays.push_back(joined(_group, *_solver, array));
    return arrays;
  }
  /// Component of the vorticity, and the Q-criterion, at the cell centres.
  std::vector<double> sample(CellField field, std::size_t component, std::size_t components) {
    const linear::CellBox part = linear::box_of(_ranks, _p.cells);
    std::vector<double> samples(part.size() * components), own(part.size());
    _solver->sample(field, samples);
    // The order of samples is z fastest.
    std::size_t at = 0;
    const auto [nx, ny, nz] = part.cells;
    for (std::size_t i = 0; i < static_cast<std::size_t>(nx); ++i)
      for (std::size_t j = 0; j < static_cast<std::size_t>(ny); ++j)
        for (std::size_t k = 0; k < static_cast<std::size_t>(nz); ++k, at += components)
          own[i + static_cast<std::size_t>(nx) * (j + static_cast<std::size_t>(ny) * k)] =
              samples[at + component];
    return joined(_group, own, _p.cells, part);
  }

 private:
  Parameters _p;
  linear::RankGroup _group;
  linear::PencilRanks _ranks;
  std::unique_ptr<Solver> _solver;
};

struct Case {
  std::string name;
  Parameters parameters;
};

void set_sides(Parameters& p, std::size_t axis, BoundaryKind low, BoundaryKind high) {
  for (const std::size_t side : {2 * axis, 2 * axis + 1}) {
    Boundary& boundary = p.boundary[side];
    boundary.kind = side % 2 == 0 ? low : high;
    if (boundary.kind != BoundaryKind::wall && boundary.kind != BoundaryKind::inflow) continue;
    boundary.velocity = {0.5, -0.4, 0.3};
    boundary.velocity[axis] = boundary.kind == BoundaryKind::inflow ? 0.6 : 0.0;
  }
}

/// 0.2 + t y + z / 10 along x, which changes along both axes that ranks divide, 0.2 + t y and 0.2 + t z. Few
/// terms: a solver samples them at its start, which takes longer than the steps of these tests.
void set_expressions(Boundary& boundary) {
  for (int c = 0; c < 3; ++c) {
    device::ExpressionBuilder builder;
    builder.push("t");
    builder.push(c == 2 ? "z" : "y");
    builder.push("*");
    if (c == 0) {
      builder.push("constant", 0.1);
      builder.push("z");
      builder.push("*");
      builder.push("+");
    }
    builder.push("constant", 0.2);
    builder.push("+");
    boundary.velocity_expressions.push_back(builder.program());
  }
}

/// Periodic and bounded boxes that four ranks divide along y and z, along y, and along z.
std::vector<Case> cases() {
  constexpr auto slip = BoundaryKind::slip, wall = BoundaryKind::wall, inflow = BoundaryKind::inflow,
                 outflow = BoundaryKind::outflow;
  Parameters base;
  base.low = {-0.3, 0.2, 1.0};
  base.high = {0.9, 1.1, 2.5};
  base.density = 1.3;
  base.viscosity = 0.02;
  base.body_force = {0.4, -0.3, 0.7};
  base.cfl = 0.4;
  base.horizon = 1.0;
  std::vector<Case> all;
  const auto add = [&](const std::string& name, const std::array<int, 3>& cells) -> Parameters& {
    all.push_back({name, base});
    all.back().parameters.cells = cells;
    return all.back().parameters;
  };
  add("periodic", {8, 7, 9});
  add("periodic, Vreman, RK3", {6, 8, 8}).turbulence = Turbulence::vreman;
  all.back().parameters.time_scheme = TimeScheme::rk3;
  Parameters& channel = add("channel along x, outflow also at z", {7, 9, 6});
  set_sides(channel, 0, inflow, outflow);
  set_sides(channel, 1, wall, slip);
  set_sides(channel, 2, slip, outflow);
  channel.turbulence = Turbulence::smagorinsky;
  Parameters& across = add("channel along y, RK3", {6, 8, 7});
  set_sides(across, 1, outflow, outflow);
  set_sides(across, 2, wall, wall);
  across.time_scheme = TimeScheme::rk3;
  across.advection = Advection::weno_js;
  set_expressions(across.boundary[4]);
  Parameters& backflow = add("outflows at x beside periodic axes, Vreman", {7, 8, 9});
  set_sides(backflow, 0, outflow, outflow);
  backflow.turbulence = Turbulence::vreman;
  Parameters& open = add("outflows all around, Smagorinsky", {7, 9, 8});
  for (std::size_t axis = 0; axis < 3; ++axis) set_sides(open, axis, outflow, outflow);
  for (Boundary& side : open.boundary) side.velocity = {0.3, -0.2, 0.1};
  open.turbulence = Turbulence::smagorinsky;
  Parameters& flat = add("x and y", {10, 13, 1});
  set_sides(flat, 0, wall, wall);
  set_sides(flat, 1, inflow, outflow);
  set_expressions(flat.boundary[0]);
  add("x and z", {9, 1, 12}).advection = Advection::central;
  set_sides(all.back().parameters, 2, outflow, slip);
  add("y and z", {1, 8, 6});
  set_sides(all.back().parameters, 1, slip, wall);
  set_sides(add("thin ranks", {5, 4, 12}), 2, outflow, inflow);
  // Large enough for cells that need no other rank.
  Parameters& large = add("large, sides", {6, 11, 11});
  set_sides(large, 1, outflow, wall);
  set_sides(large, 2, wall, outflow);
  large.time_scheme = TimeScheme::rk3;
  large.external_force = true;
  add("large, periodic", {6, 5, 17});
  Parameters& profile = add("inflow by expressions beside periodic axes", {6, 9, 8});
  set_sides(profile, 0, inflow, outflow);
  set_expressions(profile.boundary[0]);
  profile.turbulence = Turbulence::smagorinsky;
  set_random_widths(add("stretched, periodic", {6, 11, 17}), 3.0, 1);
  Parameters& graded = add("stretched, sides", {7, 11, 12});
  set_sides(graded, 0, inflow, outflow);
  set_sides(graded, 1, outflow, wall);
  set_expressions(graded.boundary[0]);
  graded.turbulence = Turbulence::smagorinsky;
  set_random_widths(graded, 3.0, 2);
  return all;
}

/// Whether two arrays agree within `tolerance`, relative to the larger of their values and 1, or within
/// `round_off`.
void expect_near(const std::vector<double>& expected, const std::vector<double>& found,
                 const std::string& what, double round_off = 0.0) {
  EXPECT_LT(largest_difference(expected, found),
            std::max(round_off, tolerance * std::max(1.0, largest(expected))))
      << what;
}

/// Error of the pressure, m^2/s^2, with which implicit diffusion starts: it acts for 5e-3 of the first dt,
/// which divides the round-off of the projected velocity.
double round_off_of_first_pressure(const Parameters& p, double speed, double first_dt) {
  if (p.diffusion != Diffusion::crank_nicolson) return 0.0;
  EXPECT_GT(first_dt, 0.0);
  double extent = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) extent = std::max(extent, p.high[axis] - p.low[axis]);
  return 4.0 * std::numeric_limits<double>::epsilon() * speed * extent / (5e-3 * first_dt);
}

void expect_same_totals(const Totals& a, const Totals& b, const std::string& what) {
  EXPECT_EQ(a.step, b.step) << what;
  const auto near = [&](double expected, double found, const char* name) {
    EXPECT_NEAR(expected, found, tolerance * std::max(1.0, std::abs(expected))) << what << ": " << name;
  };
  near(a.time, b.time, "time");
  near(a.dt, b.dt, "dt");
  near(a.kinetic_energy, b.kinetic_energy, "energy");
  near(a.enstrophy, b.enstrophy, "enstrophy");
  near(a.dissipation, b.dissipation, "dissipation");
  near(a.max_speed, b.max_speed, "speed");
  near(a.divergence_rms, b.divergence_rms, "divergence");
  for (int c = 0; c < 3; ++c) near(a.momentum[c], b.momentum[c], "momentum");
  for (int side = 0; side < 6; ++side) near(a.outflow[side], b.outflow[side], "outflow");
}

void expect_same_extremes(const Extremes& a, const Extremes& b, const std::string& what) {
  EXPECT_EQ(a.step, b.step) << what;
  const auto near = [&](double expected, double found, const char* name) {
    EXPECT_NEAR(expected, found, tolerance * std::max(1.0, a.energy)) << what << ": " << name;
  };
  near(a.energy, b.energy, "energy");
  near(a.least_energy, b.least_energy, "least energy");
  near(a.largest_rise, b.largest_rise, "rise");
  near(a.largest_speed, b.largest_speed, "speed");
}

/// Whether so many ranks can share a flow of these tests: any on hosts, and on devices, which divide z alone,
/// if there are cells enough.
bool can_share(const Parameters& p, int ranks) {
  const bool slabs = p.slabs || device::needs_device(backend);
  const bool can = find_division(p.cells, ranks, 0, slabs).has_value();
  EXPECT_TRUE(can || slabs);
  return can;
}

/// The parameters with as many planes along z as four ranks need that divide z alone, as on devices.
Parameters for_four_ranks(Parameters p) {
  if (!can_share(p, 4)) p.cells[2] = 13;
  return p;
}

/// Runs a case from random data on `ranks` ranks and on this one only, and compares everything.
void expect_steps_of_one_rank(const Case& each, int ranks) {
  Parameters p = each.parameters;
  p.watches_extremes = true;
  if (!can_share(p, ranks)) return;
  const linear::RankGroup group = first_ranks(ranks);
  if (!belongs_to_first(ranks)) return;
  const std::string what = each.name + " on " + std::to_string(ranks) + " ranks";
  const StaggeredField initial = random_field(FlowDomain(p), 77);
  SharedSolver single(p, {}), shared(p, group);
  const bool waits = ranks > 1 && shared->transport() != linear::Transport::nccl;
  EXPECT_EQ(std::string(waits ? "plain" : single->driver()), shared->driver());
  single.start(initial);
  shared.start(initial);
  for (const int step : {0, 1, 5}) {
    if (step > 0) {
      EXPECT_EQ(Stop::pause, single->advance(endless, step, {})) << what;
      EXPECT_EQ(Stop::pause, shared->advance(endless, step, {})) << what;
    }
    const auto expected = single.state(), found = shared.state();
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const bool is_first_pressure = i == 3 && step == 0;
      if (i < 4 || step > 0)
        expect_near(expected[i], found[i], what + ", array " + std::to_string(i),
                    is_first_pressure
                        ? round_off_of_first_pressure(p, largest(expected[0]), single->progress().longest_dt)
                        : 0.0);
    }
    expect_same_totals(single->totals(), shared->totals(), what);
    expect_same_extremes(single->extremes(), shared->extremes(), what);
    for (const std::size_t c : {0U, 1U, 2U})
      expect_near(single.sample(CellField::vorticity, c, 3), shared.sample(CellField::vorticity, c, 3),
                  what + ", vorticity");
    expect_near(single.sample(CellField::q_criterion, 0, 1), shared.sample(CellField::q_criterion, 0, 1),
                what + ", Q-criterion");
  }
}

class FlowRanks : public ::testing::Test {
 protected:
  void SetUp() override {
    if (linear::RankGroup::world().size() != 4) GTEST_SKIP() << "needs mpirun with four ranks";
  }
};

TEST_F(FlowRanks, TakeTheStepsOfOneRank) {
  for (const Case& each : cases())
    for (const int ranks : {1, 2, 4}) expect_steps_of_one_rank(each, ranks);
}

TEST_F(FlowRanks, TakeTheStepsOfOneRankByDiagonalization) {
  for (Case each : cases()) {
    each.parameters.pressure_solver = PressureSolver::diagonalization;
    expect_steps_of_one_rank(each, 4);
  }
}

/// The cases with several planes along z: a prime number of them, in which ranks have slabs of unequal size.
std::vector<Case> slab_cases() {
  std::vector<Case> all;
  for (Case each : cases()) {
    Parameters& p = each.parameters;
    if (p.cells[2] == 1) continue;
    p.cells[2] = 13;
    if (!p.faces[2].empty()) set_random_widths(p, 3.0, 4);
    p.slabs = true;
    each.name += ", slabs";
    all.push_back(each);
  }
  return all;
}

/// The case with implicit diffusion that exceeds the limit of explicit steps.
Case with_implicit_diffusion(Case each) {
  each.name += ", implicit diffusion";
  each.parameters.time_scheme = TimeScheme::ab2;
  each.parameters.diffusion = Diffusion::crank_nicolson;
  each.parameters.viscosity = 0.3;
  return each;
}

TEST_F(FlowRanks, DiffuseImplicitlyAsOneRank) {
  for (const Case& each : cases()) expect_steps_of_one_rank(with_implicit_diffusion(each), 4);
  Case flat = with_implicit_diffusion(cases()[5]);
  flat.parameters.pressure_solver = PressureSolver::diagonalization;
  for (const int ranks : {2, 3, 4}) expect_steps_of_one_rank(flat, ranks);
}

TEST_F(FlowRanks, TakeTheStepsOfOneRankInSlabs) {
  int ranks = 2;
  for (Case each : slab_cases()) {
    expect_steps_of_one_rank(each, ranks);
    ranks = 2 + (ranks + 2) % 3;
    each.parameters.pressure_solver = PressureSolver::diagonalization;
    expect_steps_of_one_rank(each, ranks);
  }
}

TEST_F(FlowRanks, DiffuseImplicitlyInSlabsAsOneRank) {
  int ranks = 2;
  for (const Case& each : slab_cases()) {
    expect_steps_of_one_rank(with_implicit_diffusion(each), ranks);
    ranks = 2 + (ranks + 2) % 3;
  }
}

#if defined(DROGUE_HAVE_HYPRE)
TEST_F(FlowRanks, TakeTheStepsOfOneRankByMultigrid) {
  for (const std::size_t which : {0U, 2U, 5U}) {
    Case each = cases()[which];
    each.parameters.pressure_solver = PressureSolver::hypre_pfmg;
    each.parameters.pressure_tolerance = 1e-13;
    expect_steps_of_one_rank(each, 4);
  }
}
#endif

TEST_F(FlowRanks, ChooseTheDtOfOneRank) {
  // From rest, by sides that accelerate, walls, forces and viscosity, whose largest values lie on different
  // ranks.
  for (const TimeIntegration& integration : time_integrations)
    for (const Case& each : cases()) {
      Parameters p = each.parameters;
      integration.set(p);
      p.cfl = 0.0;
      p.horizon = 0.5;
      for (std::size_t side = 0; side < 6; ++side)
        if (p.boundary[side].kind == BoundaryKind::wall && p.boundary[side].velocity_expressions.empty())
          set_expressions(p.boundary[side]);
      const StaggeredField rest = FlowDomain(p).zero_field();
      SharedSolver one(p, {});
      one.start(rest);
      std::vector<std::pair<Stop, double>> expected;
      do {
        const Stop stop = one->advance(0.5, static_cast<int>(expected.size()) + 1, {});
        expected.emplace_back(stop, one->progress().last_dt);
      } while (expected.back().first == Stop::pause && expected.size() < 6);
      for (const int ranks : {2, 3, 4}) {
        if (ranks == 3 && p.cells != cases()[0].parameters.cells) continue;  // too few cells
        if (!can_share(p, ranks)) continue;
        const linear::RankGroup group = first_ranks(ranks);
        if (!belongs_to_first(ranks)) continue;
        SharedSolver shared(p, group);
        shared.start(rest);
        int step = 0;
        for (const auto& [stop, dt] : expected) {
          ASSERT_EQ(stop, shared->advance(0.5, ++step, {})) << each.name << " on " << ranks;
          EXPECT_NEAR(dt, shared->progress().last_dt, 1e-11 * dt)
              << each.name << " on " << ranks << ", step " << step;
        }
      }
    }
}

TEST_F(FlowRanks, ThreeRanksTakeTheStepsOfOneRank) { expect_steps_of_one_rank(cases()[0], 3); }

TEST_F(FlowRanks, ContinueBitForBitOnAsManyRanksAndNearlyOnOthers) {
  for (const Case& each : {cases()[0], cases()[2], cases()[3], with_implicit_diffusion(cases()[3])}) {
    const Parameters p = for_four_ranks(each.parameters);
    const StaggeredField initial = random_field(FlowDomain(p), 5);
    SharedSolver first(p, linear::RankGroup::world());
    first.start(initial);
    EXPECT_EQ(Stop::pause, first->advance(endless, 3, {}));
    const auto saved = first.state();
    const Progress progress = first->progress();
    EXPECT_EQ(Stop::pause, first->advance(endless, 6, {}));
    for (const int ranks : {4, 2, 1}) {
      const linear::RankGroup group = first_ranks(ranks);
      const auto expected = first.state();
      const Progress end = first->progress();
      if (!belongs_to_first(ranks)) continue;
      SharedSolver next(p, group);
      next.upload(saved);
      next->restore(progress);
      EXPECT_EQ(Stop::pause, next->advance(endless, 6, {}));
      const auto found = next.state();
      for (std::size_t i = 0; i < expected.size(); ++i) {
        if (ranks == 4)
          EXPECT_EQ(expected[i], found[i]) << each.name;
        else
          expect_near(expected[i], found[i], each.name);
      }
      if (ranks == 4) {
        EXPECT_EQ(end.time, next->progress().time);
        EXPECT_EQ(end.rate_bits, next->progress().rate_bits);
      }
    }
  }
}

TEST_F(FlowRanks, FailTogetherAtTheFirstCell) {
  const Parameters p = for_four_ranks(cases()[3].parameters);
  StaggeredField initial = random_field(FlowDomain(p), 3);
  initial[0].back() = std::nan("");  // of the last rank
  SharedSolver single(p, {}), shared(p, linear::RankGroup::world());
  single.start(initial);
  shared.start(initial);
  EXPECT_EQ(Stop::failed, single->advance(endless, -1, {}));
  EXPECT_EQ(Stop::failed, shared->advance(endless, -1, {}));
  const StepFailure expected = single->failure(), found = shared->failure();
  EXPECT_GE(expected.index, p.cells[0] * p.cells[1] * linear::part_begin(p.cells[2], 2, 1));
  EXPECT_EQ(FailureReason::not_finite, found.reason);
  EXPECT_EQ(expected.index, found.index);
}

TEST_F(FlowRanks, FailTogetherAtASideOfOneRankAndKeepTheState) {
  for (const TimeScheme scheme : {TimeScheme::ab2, TimeScheme::rk3}) {
    Parameters p = for_four_ranks(cases()[3].parameters);
    p.time_scheme = scheme;
    p.fixed_dt = 0.004;
    // The tangential velocity of the wall at high z becomes undefined, which the ranks at low z do not see.
    device::ExpressionBuilder builder, zero;
    zero.push("constant", 0.0);
    builder.push("constant", 0.01);
    builder.push("t");
    builder.push("-");
    builder.push("sqrt");
    p.boundary[5].velocity_expressions = {builder.program(), builder.program(), zero.program()};
    p.boundary[4].velocity_expressions.clear();
    const StaggeredField initial = random_field(FlowDomain(p), 3);
    SharedSolver single(p, {}), shared(p, linear::RankGroup::world());
    single.start(initial);
    shared.start(initial);
    EXPECT_EQ(Stop::failed, single->advance(endless, -1, {}));
    const StepFailure expected = single->failure();
    EXPECT_EQ(Stop::pause, shared->advance(endless, expected.step - 1, {}));
    const auto before = shared.state();
    EXPECT_EQ(Stop::failed, shared->advance(endless, -1, {}));
    const StepFailure found = shared->failure();
    EXPECT_EQ(FailureReason::side_velocity, found.reason);
    EXPECT_EQ(5, expected.index);
    EXPECT_EQ(5, found.index);
    EXPECT_EQ(expected.step, found.step);
    const auto after = shared.state();
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(before[i], after[i]);
    EXPECT_EQ(Stop::failed, shared->advance(endless, -1, {}));
  }
}

TEST_F(FlowRanks, FailTogetherForANetInflow) {
  Parameters p = for_four_ranks(cases()[0].parameters);
  set_sides(p, 2, BoundaryKind::inflow, BoundaryKind::inflow);
  p.fixed_dt = 0.004;
  // The inflow at low z leaves at high z until 0.01 s; no rank holds both sides.
  device::ExpressionBuilder in, out, zero;
  zero.push("constant", 0.0);
  in.push("t");
  for (const char* step : {"t", "t"}) out.push(step);
  out.push("constant", 0.01);
  for (const char* step : {"<", "*"}) out.push(step);
  p.boundary[4].velocity_expressions = {zero.program(), zero.program(), in.program()};
  p.boundary[5].velocity_expressions = {zero.program(), zero.program(), out.program()};
  const StaggeredField initial = random_field(FlowDomain(p), 3);
  SharedSolver single(p, {}), shared(p, linear::RankGroup::world());
  single.start(initial);
  shared.start(initial);
  EXPECT_EQ(Stop::failed, single->advance(endless, -1, {}));
  EXPECT_EQ(Stop::failed, shared->advance(endless, -1, {}));
  const StepFailure expected = single->failure(), found = shared->failure();
  EXPECT_EQ(3, expected.step);
  EXPECT_EQ(3, found.step);
  EXPECT_EQ(FailureReason::net_inflow, expected.reason);
  EXPECT_EQ(FailureReason::net_inflow, found.reason);
  EXPECT_NEAR(0.012 * 1.2 * 0.9, expected.net_inflow, 1e-12);
  EXPECT_NEAR(expected.net_inflow, found.net_inflow, 1e-12);
}

TEST_F(FlowRanks, KeepsTheStepsEqualIfOneRankIsInterrupted) {
  const linear::RankGroup world = linear::RankGroup::world();
  const Parameters p = for_four_ranks(cases()[2].parameters);
  SharedSolver shared(p, world);
  shared.start(random_field(FlowDomain(p), 9));
  EXPECT_EQ(Stop::interrupted, shared->advance(endless, -1, [&](const Status& now) {
    return world.rank() != 3 || now.step < 4;
  }));
  const std::int64_t step = shared->progress().step;
  // Only a host that waits for each step knows when to ask.
  if (shared->transport() == linear::Transport::nccl)
    EXPECT_GE(step, 4);
  else
    EXPECT_EQ(4, step);
  for (const double each : world.gather(std::vector<double>{static_cast<double>(step)}))
    EXPECT_EQ(static_cast<double>(step), each);
  EXPECT_EQ(Stop::interrupted,
            shared->advance(endless, -1, [&](const Status&) { return world.rank() != 1; }));
  EXPECT_EQ(step, shared->progress().step);
  EXPECT_EQ(Stop::pause, shared->advance(endless, step + 1, [](const Status&) { return true; }));
}

TEST_F(FlowRanks, OfSeveralGpusStepByOneLaunchEach) {
  for (const Case& each : cases()) {
    if (!can_share(each.parameters, 2)) continue;
    const linear::RankGroup world = linear::RankGroup::world(), group = first_ranks(2);
    std::optional<SharedSolver> solver;
    if (belongs_to_first(2)) solver.emplace(each.parameters, group);
    // All ranks skip, or none.
    std::array<std::uint64_t, 1> waits = {solver && (*solver)->transport() != linear::Transport::nccl};
    world.maximize(waits);
    if (waits[0] != 0) GTEST_SKIP() << "needs a GPU for each rank, and NCCL";
    if (!solver) continue;
    SharedSolver& shared = *solver;
    shared.start(random_field(FlowDomain(each.parameters), 9));
    std::int64_t end = 1;
    const auto cost = [&](std::int64_t steps) {
      const device::ProfilingCounters before = profiled();
      EXPECT_EQ(Stop::pause, shared->advance(endless, end += steps, {}));
      device::ProfilingCounters taken = profiled();
      taken.kernel_launches -= before.kernel_launches;
      taken.fences -= before.fences;
      taken.copies -= before.copies;
      taken.allocations -= before.allocations;
      return taken;
    };
    cost(1);  // captures the step
    const device::ProfilingCounters few = cost(10), many = cost(60);
    EXPECT_LE(many.kernel_launches - few.kernel_launches, 50) << each.name;
    EXPECT_EQ(many.fences, few.fences) << each.name;
    EXPECT_EQ(many.copies, few.copies) << each.name;
    EXPECT_EQ(many.allocations, few.allocations) << each.name;
  }
}

TEST(FlowDecomposition, DividesAxesWithTheFewestNumbersSent) {
  EXPECT_EQ((std::array<int, 3>{1, 1, 4}), decompose({64, 64, 64}, 4, 0).parts);
  EXPECT_EQ((std::array<int, 3>{1, 8, 8}), decompose({64, 64, 64}, 64, 0).parts);
  EXPECT_EQ((std::array<int, 3>{1, 4, 1}), decompose({64, 64, 16}, 4, 0).parts);
  EXPECT_EQ((std::array<int, 3>{1, 2, 2}), decompose({64, 11, 11}, 4, 0).parts);
  // Slabs transpose nothing, and pay off before their sides are the smaller ones.
  EXPECT_EQ((std::array<int, 3>{1, 1, 2}), decompose({64, 64, 48}, 2, 0).parts);
  EXPECT_EQ((std::array<int, 3>{1, 2, 1}), decompose({64, 64, 24}, 2, 0).parts);
  EXPECT_EQ((std::array<int, 3>{1, 4, 1}), decompose({64, 12, 1}, 4, 0).parts);
  EXPECT_EQ((std::array<int, 3>{0, 1, 1}), decompose({64, 11, 11}, 4, 3).place);
  EXPECT_EQ((std::array<int, 3>{1, 1, 1}), decompose({4, 1, 1}, 1, 0).parts);
}

TEST(FlowDecomposition, DividesZAloneIntoSlabs) {
  EXPECT_EQ((std::array<int, 3>{1, 1, 4}), decompose({64, 64, 13}, 4, 0, true).parts);
  EXPECT_EQ((std::array<int, 3>{0, 0, 2}), decompose({64, 64, 13}, 4, 2, true).place);
  Parameters p;
  p.cells = {64, 64, 16};
  EXPECT_EQ((std::array<int, 3>{1, 4, 1}), ranks_of(p, 4, 0, false).parts);
  EXPECT_EQ((std::array<int, 3>{1, 1, 4}), ranks_of(p, 4, 0, true).parts);
  p.slabs = true;
  EXPECT_EQ((std::array<int, 3>{1, 1, 4}), ranks_of(p, 4, 0, false).parts);
}

TEST(FlowDecomposition, RejectsMoreRanksThanTheGridHasRoomFor) {
  for (const std::array<int, 3>& cells : {std::array<int, 3>{64, 11, 1}, {64, 1, 1}, {64, 5, 8}})
    EXPECT_THROW(static_cast<void>(decompose(cells, 4, 0)), std::invalid_argument);
  const auto refusal = [](const std::array<int, 3>& cells, int ranks, bool slabs) -> std::string {
    try {
      static_cast<void>(decompose(cells, ranks, 0, slabs));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(
      "flow solver: 17 ranks cannot share 7 x 9 cells along y and z: each needs at least 3 along a divided "
      "axis; use 6 ranks",
      refusal({64, 7, 9}, 17, false));
  EXPECT_EQ(
      "flow solver: 4 ranks cannot share 11 cells along z: each needs at least 3 along a divided axis; use 3 "
      "ranks",
      refusal({64, 64, 11}, 4, true));
  EXPECT_EQ(
      "flow solver: 2 ranks cannot share 1 cells along z: each needs at least 3 along a divided axis; use 1 "
      "rank",
      refusal({64, 64, 1}, 2, true));
}

}  // namespace
}  // namespace drogue::flow
