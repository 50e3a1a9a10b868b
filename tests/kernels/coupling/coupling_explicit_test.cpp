#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/coupling/sheet/added_mass.hpp"
#include "kernels/reference/coupling/grid_transfer.hpp"
#include "kernels/reference/coupling/staggered_piston.hpp"
#include "tests/support/coupled_case.hpp"

// Explicit staggered coupling: the steps of a piston in a channel, where it is unstable, and its forces.

namespace drogue::coupling {
namespace {

using drogue::testing::CoupledCase;
using drogue::testing::CoupledRun;
using fabric::Vector;

constexpr double h = 0.1;

/// Initial velocity of a piston, m/s, so slow that the weights of the delta functions stay the same.
constexpr double slow = 1e-8;

/// Free piston of a mass, kg/m^2, across a periodic channel of air at rest.
CoupledCase piston(double mass, const PorousLaw& law) {
  CoupledCase c(16, 4, h, 0.01);
  c.add_strip(0.83, 0.0, 0.83, 0.4, 8);
  c.p.fabric.pinned.assign(c.x.size(), 6);
  c.set_mass(mass);
  c.p.substeps = 3;
  c.p.sheet.law = law;
  c.p.sheet.method = CouplingMethod::explicit_;
  c.v.assign(c.x.size(), {slow, 0.0, 0.0});
  return c;
}

reference::PistonParameters reference_of(const CoupledCase& c, double mass) {
  // Two vertices share the corners of the periodic box; those at its ends have half the area.
  std::vector<double> areas;
  for (std::size_t i = 0; i < c.x.size(); ++i)
    areas.push_back(0.5 * 0.5 * h * h * (i < 2 || i + 2 >= c.x.size() ? 0.5 : 1.0));
  reference::PistonParameters p;
  p.mass = mass;
  p.fluid_mass = c.p.flow.density * c.p.flow.high[0];
  p.inverse_air_mass =
      reference::spread_row_sums(c.grid(), c.p.sheet.delta, c.x, areas, c.p.flow.density)[8][0];
  p.alpha = c.p.sheet.law.alpha, p.beta = c.p.sheet.law.beta;
  p.filter = c.p.sheet.filter;
  p.dt = c.p.flow.fixed_dt;
  return p;
}

/// Velocity of a vertex, m/s.
double velocity_of_piston(CoupledRun& run) {
  std::vector<Vector> x(run.vertices), v(run.vertices);
  run.solver->fabric().download(x, v);
  return v[8][0];
}

const PorousLaw porous{25.44, 3.76e9, false}, nearly_closed{1e9, 0.0, false}, closed{0.0, 0.0, true};

TEST(ExplicitCoupling, StepsOfAPistonMatchTheReference) {
  for (const double mass : {5.0, 0.5, 0.05})
    for (const PorousLaw& law : {porous, nearly_closed}) {
      const CoupledCase c = piston(mass, law);
      const reference::PistonParameters p = reference_of(c, mass);
      CoupledRun run(c);
      reference::Piston expected;
      expected.velocity = slow;
      double largest = slow;
      for (int step = 0; step < 8; ++step) {
        ASSERT_TRUE(run.advance(1));
        expected = reference::explicit_step(expected, p, step == 0);
        largest = std::max(largest, std::abs(expected.velocity));
        EXPECT_NEAR(velocity_of_piston(run), expected.velocity, 1e-6 * largest) << mass << ' ' << step;
        EXPECT_NEAR(run.force()[0] / (0.4 * h), expected.force, 1e-6 * std::abs(expected.force)) << mass;
      }
    }
}

TEST(ExplicitCoupling, GrowsWhereItsRootsExceedOne) {
  // Stable and unstable masses on both sides of the limit.
  struct Setting {
    double mass;
    bool is_stable;
  };
  for (const Setting& setting : {Setting{5.0, true}, {0.2, true}, {0.06, false}, {0.0373, false}}) {
    const CoupledCase c = piston(setting.mass, closed);
    const double growth = reference::explicit_growth(reference_of(c, setting.mass));
    EXPECT_EQ(growth < 1.0, setting.is_stable) << growth;
    CoupledRun run(c);
    const int steps = setting.is_stable ? 60 : 12;
    double last = slow, change = 0.0, before = 0.0;
    for (int step = 0; step < steps; ++step) {
      ASSERT_TRUE(run.advance(1));
      before = change;
      change = velocity_of_piston(run) - last;
      last += change;
    }
    if (setting.is_stable)
      EXPECT_LT(std::abs(change), 1e-2 * slow) << setting.mass;
    else
      EXPECT_NEAR(std::abs(change / before), growth, 1e-2 * growth) << setting.mass;
  }
}

TEST(ExplicitCoupling, DivergesWithClothOfAParachuteAndNotWithThatOfShi) {
  for (const double mass : {0.0373, 5.0}) {
    CoupledCase c = piston(mass, {CoupledCase::alpha, CoupledCase::beta, false});
    for (Vector& v : c.v) v[0] = 1.0;
    CoupledRun run(c);
    EXPECT_EQ(run.advance(100), mass > 1.0) << mass;
    c.p.sheet.method = CouplingMethod::spread;
    EXPECT_TRUE(CoupledRun(c).advance(100)) << mass;
  }
}

TEST(ExplicitCoupling, ClothTakesTheMomentumThatTheAirTookInTheLastStep) {
  for (const bool no_slip : {false, true}) {
    CoupledCase c(16, 16, h, 0.004);
    c.add_strip(0.61, 0.2, 0.87, 1.4, 24);
    c.p.fabric.pinned.assign(c.x.size(), 0);
    c.set_mass(5.0);
    for (std::size_t i = 0; i < c.v.size(); ++i) c.v[i] = {4.0, 1.0 + 0.5 * c.x[i][1], 0.0};
    c.p.sheet.law.no_slip = no_slip;
    c.p.sheet.method = CouplingMethod::explicit_;
    c.p.substeps = 10;
    CoupledRun run(c);
    const double scale = run.solver->fabric().totals().momentum[0];
    Vector air{}, cloth{}, gained{};
    const auto update = [](Vector& old, const auto& now) {
      Vector change{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        change[axis] = now[axis] - old[axis], old[axis] = now[axis];
      return change;
    };
    update(air, run.solver->flow().totals().momentum);
    update(cloth, run.solver->fabric().totals().momentum);
    for (int step = 0; step < 20; ++step) {
      ASSERT_TRUE(run.advance(1));
      const Vector lost = update(cloth, run.solver->fabric().totals().momentum);
      for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(lost[axis], -gained[axis], 1e-14 * scale);
      gained = update(air, run.solver->flow().totals().momentum);
    }
    EXPECT_GT(air[0], 0.01 * scale);
  }
}

TEST(ExplicitCoupling, PrescribedMotionHasTheForcesOfSpreading) {
  for (const bool no_slip : {false, true}) {
    Vector forces[2];
    for (const CouplingMethod method : {CouplingMethod::spread, CouplingMethod::explicit_}) {
      CoupledCase c(16, 16, h, 0.004);
      c.add_strip(0.61, 0.2, 0.87, 1.4, 24);
      for (Vector& v : c.v) v = {1.0, 0.5, 0.0};
      c.p.sheet.law.no_slip = no_slip;
      c.p.sheet.method = method;
      c.p.substeps = 1;
      CoupledRun run(c);
      ASSERT_TRUE(run.advance(20));
      forces[method == CouplingMethod::spread ? 0 : 1] = run.force();
    }
    const double scale = std::abs(forces[0][0]);
    EXPECT_GT(scale, 0.1);
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(forces[1][axis], forces[0][axis], 1e-12 * scale) << axis;
  }
}

TEST(ExplicitCoupling, AddedMassRatioHasTheKnownValues) {
  // Waves of 1 m in air: cloth of parachutes, and that of [Shi].
  EXPECT_NEAR(added_mass_ratio(1.225, 1.0, 0.0373), 10.45, 0.01);
  EXPECT_NEAR(added_mass_ratio(1.225, 1.0, 5.0), 0.078, 0.001);
}

}  // namespace
}  // namespace drogue::coupling
