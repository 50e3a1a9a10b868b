// ctest-label: exact
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "kernels/device/backend.hpp"
#include "kernels/reference/coupling/closed_channel.hpp"
#include "tests/support/coupled_case.hpp"
#include "tests/support/expression_program.hpp"

// Sheets that close a channel and move all of its air: every step against the motion as a whole.

namespace drogue::coupling {
namespace {

using drogue::testing::coupled_state;
using drogue::testing::CoupledCase;
using drogue::testing::CoupledRun;
using drogue::testing::fill;
using drogue::testing::postfix;
using fabric::Vector;

constexpr double h = 0.1;
constexpr CouplingMethod methods[] = {CouplingMethod::spread, CouplingMethod::explicit_,
                                      CouplingMethod::sharp};

/// Channel along x of nx by 4 cells in steps of 0.02 s.
CoupledCase channel(int nx, CouplingMethod method) {
  CoupledCase c(nx, 4, h, 0.02);
  c.p.sheet.method = method;
  c.p.substeps = 1;
  return c;
}

double length(const CoupledCase& c) { return c.p.flow.high[0]; }
double mass(const CoupledCase& c) { return c.p.flow.density * length(c); }
double section(const CoupledCase& c) { return c.p.flow.high[1] * c.p.flow.high[2]; }

/// Adds a strip across the channel at x, m, that closes it.
void close(CoupledCase& c, double x, const PorousLaw& law) {
  const int begin = static_cast<int>(c.x.size());
  c.add_strip(x, 0.0, x, c.p.flow.high[1], 8);
  c.p.sheet.law_of_vertex.resize(c.x.size(), law);
  c.p.sheet.closing.push_back({0, begin, static_cast<int>(c.x.size()), 1.0 / mass(c),
                               c.p.flow.body_force[0] + c.p.flow.pressure_drop[0] / mass(c)});
}

void move_along_x(CoupledCase& c, const device::ExpressionProgram& displacement) {
  std::vector<int> all(c.x.size());
  std::iota(all.begin(), all.end(), 0);
  c.p.fabric.motions.push_back({0, all, displacement});
}

double mean_velocity(const CoupledCase& c, CoupledRun& run) {
  return run.solver->flow().totals().momentum[0] / (mass(c) * section(c));
}

TEST(ClosingSheets, TakeTheStepsOfTheWholeChannel) {
  constexpr PorousLaw cloth{254.4, 37.6, false}, net{20.0, 900.0, false}, wall{0.0, 0.0, true};
  for (const CouplingMethod method : methods)
    for (const int nx : {16, 160})
      for (const std::vector<PorousLaw>& laws : {std::vector{cloth}, std::vector{net}, std::vector{wall},
                                                 std::vector{cloth, net, cloth}, std::vector{net, wall}}) {
        CoupledCase c = channel(nx, method);
        c.p.flow.pressure_drop = {200.0, 0.0, 0.0};
        std::vector<reference::ClosedChannelSheet> sheets;
        for (const PorousLaw& law : laws) {
          close(c, length(c) * (0.21 + 0.3 * static_cast<double>(sheets.size())), law);
          sheets.push_back({law.alpha, law.beta, law.impermeable, 0.0});
        }
        CoupledRun run(c);
        double velocity = 0.0;
        for (int step = 0; step < 12; ++step) {
          ASSERT_TRUE(run.advance(1));
          const auto expected =
              reference::closed_channel_step(velocity, 200.0 / mass(c), mass(c), sheets, c.p.flow.fixed_dt);
          velocity = expected.velocity;
          ASSERT_NEAR(mean_velocity(c, run), velocity, 1e-10) << nx << ' ' << laws.size() << ' ' << step;
          std::vector<Vector> forces(c.x.size());
          run.solver->download("sheet_force", numbers(forces));
          for (std::size_t k = 0; k < sheets.size(); ++k) {
            const ClosingSheet& sheet = c.p.sheet.closing[k];
            double sum = 0.0;
            for (int i = sheet.begin; i < sheet.end; ++i) sum += forces[static_cast<std::size_t>(i)][0];
            ASSERT_NEAR(sum, expected.pressure_jump[k] * section(c), 1e-7) << k << ' ' << step;
          }
        }
      }
}

TEST(ClosingSheets, CarryTheFluidOfALongChannel) {
  constexpr double amplitude = 0.02, omega = 20.0;
  for (const CouplingMethod method : methods) {
    CoupledCase c = channel(80, method);
    c.p.flow.fixed_dt = 0.005;
    close(c, 4.03, {0.0, 0.0, true});
    move_along_x(c, postfix({amplitude, omega, "t", "*", "sin", "*"}));
    CoupledRun run(c);
    double before = 0.0;
    for (int step = 1; step <= 60; ++step) {
      ASSERT_TRUE(run.advance(1));
      std::vector<Vector> x(c.x.size()), v(c.x.size());
      run.solver->fabric().download(x, v);
      const double dt = c.p.flow.fixed_dt, velocity = v[0][0];
      EXPECT_NEAR(velocity, amplitude * omega * std::cos(omega * step * dt), 1e-6) << step;
      EXPECT_NEAR(mean_velocity(c, run), velocity, 1e-12) << step;
      EXPECT_NEAR(run.force()[0], mass(c) * section(c) * (velocity - before) / dt, 1e-9) << step;
      before = velocity;
    }
  }
}

TEST(ClosingSheets, ObeyTheLawAtOnceWhereTheFlowRateIsPrescribed) {
  for (const CouplingMethod method : methods)
    for (const double filter : {0.0, 0.5}) {
      CoupledCase c = channel(96, method);
      c.p.sheet.filter = filter;
      close(c, 4.83, {254.4, 37.6, false});
      c.p.sheet.closing[0].inverse_mass = 0.0;
      c.p.flow.boundary[0].kind = flow::BoundaryKind::inflow;
      c.p.flow.boundary[0].velocity = {1.0, 0.0, 0.0};
      c.p.flow.boundary[1].kind = flow::BoundaryKind::outflow;
      c.p.flow.boundary[1].velocity = {1.0, 0.0, 0.0};
      CoupledRun run(c);
      fill(run.solver->flow(), "velocity_x", 1.0);
      run.solver->start();
      for (int step = 0; step < 10; ++step) {
        ASSERT_TRUE(run.advance(1));
        EXPECT_NEAR(run.force()[0], -292.0 * section(c), 1e-7) << filter << ' ' << step;
      }
    }
}

TEST(ClosingSheets, ContinueBitForBitAndBackendsAgree) {
  for (const CouplingMethod method : methods) {
    CoupledCase c = channel(32, method);
    c.p.flow.pressure_drop = {20.0, 0.0, 0.0};
    close(c, 0.83, {254.4, 37.6, false});
    close(c, 2.13, {5.0, 9.0, false});
    CoupledRun whole(c), first(c), second(c);
    ASSERT_TRUE(whole.advance(20));
    ASSERT_TRUE(first.advance(8));
    restore(coupled_state(*first.solver), *second.solver);
    ASSERT_TRUE(second.advance(12));
    EXPECT_EQ(second.force(), whole.force());
    std::vector<Vector> here(c.x.size()), there(c.x.size());
    whole.solver->download("sheet_force", numbers(here));
    for (const device::Backend backend : device::compiled_backends()) {
      const auto other = c.solver(backend);
      ASSERT_EQ(other->advance(1e9, 20, {}), flow::Stop::pause);
      other->download("sheet_force", numbers(there));
      for (std::size_t i = 0; i < here.size(); ++i)
        EXPECT_NEAR(there[i][0], here[i][0], drogue::testing::run_tolerance) << i;
    }
  }
}

TEST(ClosingSheets, RejectsSheetsOutOfRange) {
  for (const ClosingSheet& bad : {ClosingSheet{3, 0, 4, 1.0, 0.0}, ClosingSheet{0, 4, 4, 1.0, 0.0},
                                  ClosingSheet{0, 0, 1000, 1.0, 0.0}, ClosingSheet{0, 0, 4, -1.0, 0.0}}) {
    CoupledCase c = channel(16, CouplingMethod::spread);
    close(c, 0.83, {254.4, 37.6, false});
    c.p.sheet.closing[0] = bad;
    EXPECT_THROW(static_cast<void>(c.solver(drogue::testing::tested_backend)), std::invalid_argument);
  }
}

}  // namespace
}  // namespace drogue::coupling
