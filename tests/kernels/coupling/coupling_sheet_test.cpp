#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "kernels/coupling/sheet/no_slip.hpp"
#include "kernels/reference/coupling/porous_sheet.hpp"
#include "tests/support/coupled_case.hpp"

// Sheets of cloth in air: the porous law, leaks, layers, momentum and stability. The numbers come from a
// two-dimensional prototype of the same scheme.

namespace drogue::coupling {
namespace {

using drogue::testing::CoupledCase;
using drogue::testing::CoupledRun;
using drogue::testing::taut_strip;
using fabric::Vector;

constexpr double h = 0.1;

TEST(PorousLaw, ImpulseMatchesTheReference) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> exponent(-4.0, 4.0), side(-1.0, 1.0);
  const auto positive = [&] { return std::pow(10.0, exponent(engine)); };
  for (int k = 0; k < 2000; ++k) {
    const double alpha = k % 5 == 0 ? 0.0 : positive(), beta = k % 7 == 0 ? 0.0 : positive(),
                 w = std::copysign(positive(), side(engine)), tau = positive(), inverse_mass = positive();
    const double expected = reference::porous_impulse(alpha, beta, w, tau, inverse_mass);
    EXPECT_NEAR(porous_impulse({alpha, beta, false}, w, tau, inverse_mass), expected,
                1e-12 * std::abs(expected));
  }
}

TEST(PorousLaw, StopsTheFlowThroughAnImpermeableSheet) {
  EXPECT_DOUBLE_EQ(porous_impulse({254.4, 37.6, true}, -3.0, 0.1, 2.0), -1.5);
  EXPECT_EQ(porous_impulse({0.0, 0.0, true}, 3.0, 0.1, 0.0), 0.0);
}

TEST(NoSlip, ImpulseMatchesTheReference) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> exponent(-2.0, 2.0), side(-1.0, 1.0);
  const auto positive = [&] { return std::pow(10.0, exponent(engine)); };
  for (int k = 0; k < 2000; ++k) {
    const double alpha = k % 5 == 0 ? 0.0 : positive(), beta = k % 7 == 0 ? 0.0 : positive(),
                 tau = positive();
    Vector n{side(engine), side(engine), k % 3 == 0 ? 0.0 : side(engine)}, w{}, m{};
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      n[axis] /= length;
      w[axis] = side(engine), m[axis] = positive();
    }
    const Vector expected = reference::no_slip_impulse(alpha, beta, n, w, tau, m);
    const spatial::Point found = no_slip_impulse({alpha, beta, false, true}, {n[0], n[1], n[2]},
                                                 {w[0], w[1], w[2]}, tau, {m[0], m[1], m[2]});
    const double scale = std::abs(w[0] / m[0]) + std::abs(w[1] / m[1]) + std::abs(w[2] / m[2]);
    EXPECT_NEAR(found.x, expected[0], 1e-12 * scale);
    EXPECT_NEAR(found.y, expected[1], 1e-12 * scale);
    EXPECT_NEAR(found.z, expected[2], 1e-12 * scale);
  }
}

TEST(NoSlip, ImpermeableSheetsStopAllRelativeMotion) {
  const spatial::Point found =
      no_slip_impulse({0.0, 0.0, true, true}, {0.6, 0.8, 0.0}, {1.0, -2.0, 3.0}, 0.1, {1.0, 2.0, 4.0});
  EXPECT_EQ(found.x, 1.0);
  EXPECT_EQ(found.y, -1.0);
  EXPECT_EQ(found.z, 0.75);
}

/// Mean velocity of the air relative to the vertices of a strip, weighted by their areas, along a normal,
/// m/s.
double leak_of(const CoupledCase& c, CoupledRun& run, const Vector& normal) {
  std::vector<Vector> x(c.x.size()), v(c.x.size()), air(c.x.size());
  run.solver->fabric().download(x, v);
  run.solver->air_velocity(air);
  double sum = 0.0, mass = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mass += c.p.fabric.mass[i];
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum += c.p.fabric.mass[i] * normal[axis] * (air[i][axis] - v[i][axis]);
  }
  return sum / mass;
}

/// Mean velocity of the air, m/s.
Vector mean_velocity(const CoupledCase& c, CoupledRun& run) {
  const flow::Totals totals = run.solver->flow().totals();
  Vector mean{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    mean[axis] = totals.momentum[axis] / (c.p.flow.density * c.volume());
  return mean;
}

TEST(FixedSheet, FollowsThePorousLaw) {
  for (const double dp : {30.0, 300.0})
    for (const flow::TimeScheme time : {flow::TimeScheme::ab2, flow::TimeScheme::rk3}) {
      CoupledCase c(16, 8, h, 0.01);
      c.p.flow.time_scheme = time;
      c.p.flow.pressure_drop = {dp, 0.0, 0.0};
      c.add_strip(0.83, 0.0, 0.83, 0.8, 16);
      CoupledRun run(c);
      ASSERT_TRUE(run.advance(400));
      const double law = CoupledCase::law_velocity(dp);
      EXPECT_NEAR(mean_velocity(c, run)[0], law, 1e-6 * law) << dp;
      EXPECT_NEAR(leak_of(c, run, {1.0, 0.0, 0.0}), law, 1e-6 * law) << dp;
      EXPECT_NEAR(run.force()[0], -dp * 0.8 * h, 1e-6 * dp * 0.8 * h) << dp;
    }
}

TEST(FixedSheet, LayersOfTwoLawsAddTheirPressureDifferences) {
  CoupledCase c(24, 4, h, 0.01);
  c.p.flow.pressure_drop = {300.0, 0.0, 0.0};
  c.add_strip(0.9, 0.0, 0.9, 0.4, 8);
  c.p.sheet.law_of_vertex.assign(c.x.size(), {100.0, 0.0, false});
  c.add_strip(1.3, 0.0, 1.3, 0.4, 8);
  c.p.sheet.law_of_vertex.resize(c.x.size(), {200.0, 0.0, false});
  CoupledRun run(c);
  ASSERT_TRUE(run.advance(600));
  EXPECT_NEAR(mean_velocity(c, run)[0], 1.0, 1e-5);
}

/// Box whose diagonal of slope 2 is a strip of cloth, and a force on the air along the normal of the strip
/// that balances dp, Pa, over its area. Returns the mean normal velocity, m/s, after `steps`.
double velocity_through_tilted_sheet(double dp, bool impermeable, double spacing, int steps) {
  CoupledCase c(8, 16, h, 0.005);
  const double length = std::hypot(0.8, 1.6), nx = 1.6 / length, ny = -0.8 / length;
  const double strength = dp * length * h / c.volume();
  c.p.flow.body_force = {strength * nx, strength * ny, 0.0};
  c.p.sheet.law.impermeable = impermeable;
  c.p.sheet.filter = 0.2;
  c.add_strip(0.013, 0.0, 0.813, 1.6, static_cast<int>(std::lround(length / spacing)));
  CoupledRun run(c);
  EXPECT_TRUE(run.advance(steps));
  const Vector mean = mean_velocity(c, run);
  return mean[0] * nx + mean[1] * ny;
}

TEST(FixedSheet, FollowsThePorousLawAtAnySlope) {
  const double law = CoupledCase::law_velocity(100.0);
  EXPECT_NEAR(velocity_through_tilted_sheet(100.0, false, 0.5 * h, 200), law, 1e-3 * law);
}

TEST(FixedSheet, DoesNotLeakIfImpermeable) {
  EXPECT_LE(std::abs(velocity_through_tilted_sheet(100.0, true, 0.5 * h, 200)), 1e-3);
}

// ctest-label: no-sanitizer
TEST(FixedSheet, LayersAddTheirPressureDifferences) {
  for (const int layers : {1, 2, 5, 10})
    for (const double gap : {0.05, 0.5}) {
      CoupledCase c(24, 4, h, 0.01);
      c.p.flow.pressure_drop = {100.0, 0.0, 0.0};
      for (int k = 0; k < layers; ++k) {
        const double x = 0.9 + k * gap * h;
        c.add_strip(x, 0.0, x, 0.4, 8);
      }
      CoupledRun run(c);
      ASSERT_TRUE(run.advance(600));
      const double law = CoupledCase::law_velocity(100.0 / layers);
      EXPECT_NEAR(mean_velocity(c, run)[0], law, 1e-5 * law) << layers << " layers at " << gap << " h";
    }
}

/// Total of air and cloth.
double energy(CoupledRun& run) {
  const fabric::Totals cloth = run.solver->fabric().totals();
  return run.solver->flow().totals().kinetic_energy + cloth.kinetic + cloth.elastic;
}

TEST(FreeSheet, ExchangesMomentumWithTheAirWithoutLoss) {
  for (const int kind : {0, 1, 2, 3}) {
    CoupledCase c(16, 16, h, 0.004);
    c.add_strip(0.61, 0.2, 0.87, 1.4, 24);
    for (std::uint8_t& axes : c.p.fabric.pinned) axes = 0;
    for (std::size_t i = 0; i < c.v.size(); ++i) c.v[i] = {4.0, 1.0 + 0.5 * c.x[i][1], 0.0};
    c.p.sheet.law.impermeable = kind % 2 == 1;
    c.p.sheet.law.no_slip = kind > 1;
    c.p.sheet.edge_inset = kind % 3 == 0 ? 0.55 : 0.0;
    c.p.substeps = 40;
    CoupledRun run(c);
    const auto momentum = [&] {
      const flow::Totals air = run.solver->flow().totals();
      const fabric::Totals cloth = run.solver->fabric().totals();
      Vector sum{};
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] = air.momentum[axis] + cloth.momentum[axis];
      return sum;
    };
    const Vector first = momentum();
    Vector last = first;
    for (int step = 0; step < 50; ++step) {
      ASSERT_TRUE(run.advance(1));
      const Vector now = momentum();
      for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(now[axis], last[axis], 1e-14 * first[0]);
      last = now;
    }
    // Half of it has passed to the air at least.
    EXPECT_GT(run.solver->flow().totals().momentum[0], 0.5 * first[0]);
  }
}

/// A free canopy in a periodic box of 1.2 m of air: a square sheet of 49 vertices, askew to all axes, on
/// whose corners four lines and a riser hold a free payload.
CoupledCase canopy_with_payload() {
  constexpr int cells = 12, rows = 7;
  constexpr double spacing = 0.09, payload = 0.4;
  CoupledCase c(cells, cells, h, 0.002);
  c.p.flow.cells[2] = cells;
  c.p.flow.high[2] = cells * h;
  fabric::Parameters& cloth = c.p.fabric;
  for (int k = 0; k < rows; ++k)
    for (int j = 0; j < rows; ++j) {
      const double a = spacing * (j - 3), b = spacing * (k - 3);
      cloth.mesh.rest.push_back({0.63 + 0.9 * a, 0.57 + 0.9 * b, 0.85 + 0.3 * a + 0.2 * b});
      if (j + 1 == rows || k + 1 == rows) continue;
      const int at = rows * k + j;
      cloth.mesh.triangles.push_back({at, at + 1, at + rows});
      cloth.mesh.triangles.push_back({at + 1, at + rows + 1, at + rows});
    }
  const int confluence = rows * rows;
  cloth.mesh.rest.push_back({0.6, 0.6, 0.45});
  cloth.mesh.rest.push_back({0.6, 0.6, 0.3});
  cloth.mesh.lines = {{0, confluence},
                      {rows - 1, confluence},
                      {rows * (rows - 1), confluence},
                      {rows * rows - 1, confluence},
                      {confluence, confluence + 1}};
  cloth.mesh.line_stiffness.assign(5, 50.0);
  for (const auto& line : cloth.mesh.lines) {
    const Vector &a = cloth.mesh.rest[static_cast<std::size_t>(line[0])],
                 &b = cloth.mesh.rest[static_cast<std::size_t>(line[1])];
    cloth.mesh.line_length.push_back(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
  }
  cloth.material.membrane_modulus = 200.0;
  cloth.material.tension_only = true;
  cloth.mass = fabric::lumped_masses(cloth.mesh, 0.05, 0.01, fabric::Lumping::area);
  cloth.mass.back() = payload;
  c.x = cloth.mesh.rest;
  for (const Vector& place : c.x) c.v.push_back({0.8, 0.3 * std::sin(7.0 * place[0]), -0.5});
  c.v.back() = {1.0, -0.5, -3.0};
  return c;
}

TEST(FreeSheet, ClothLinesPayloadAndAirKeepTheirMomentumInThreeDimensions) {
  for (const flow::TimeScheme time : {flow::TimeScheme::ab2, flow::TimeScheme::rk3})
    for (const bool no_slip : {false, true}) {
      CoupledCase c = canopy_with_payload();
      c.p.flow.time_scheme = time;
      c.p.sheet.law.no_slip = no_slip;
      c.p.sheet.edge_inset = no_slip == (time == flow::TimeScheme::ab2) ? 0.55 : 0.0;
      c.p.fabric.gravity = {1.0, 2.0, -9.81};
      CoupledRun run(c);
      double mass = 0.0, scale = 0.0;
      for (std::size_t i = 0; i < c.x.size(); ++i) {
        mass += c.p.fabric.mass[i];
        scale += c.p.fabric.mass[i] * std::hypot(c.v[i][0], c.v[i][1], c.v[i][2]);
      }
      const auto momentum = [&] {
        const flow::Totals air = run.solver->flow().totals();
        const fabric::Totals cloth = run.solver->fabric().totals();
        Vector sum{};
        for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] = air.momentum[axis] + cloth.momentum[axis];
        return sum;
      };
      Vector last = momentum();
      for (int step = 0; step < 50; ++step) {
        ASSERT_TRUE(run.advance(1));
        const Vector now = momentum();
        // Gravity acts on cloth, lines and payload alone.
        for (std::size_t axis = 0; axis < 3; ++axis)
          EXPECT_NEAR(now[axis] - last[axis], mass * c.p.fabric.gravity[axis] * c.p.flow.fixed_dt,
                      1e-14 * scale)
              << step;
        last = now;
      }
      // The lines have slowed down the payload, and the canopy has moved the air.
      run.solver->fabric().download(c.x, c.v);
      EXPECT_GT(c.v.back()[2], -3.5);
      EXPECT_GT(std::abs(run.solver->flow().totals().momentum[2]), 0.01 * scale);
    }
}

TEST(FreeSheet, EnergyNeverGrowsWithoutTheFilteredAcceleration) {
  struct Setting {
    double mass, dt;
    bool impermeable, no_slip = false;
    double edge_inset = 0.0;
  };
  for (const Setting& setting : {Setting{0.00373, 0.01, false},
                                 {0.0373, 0.01, false},
                                 {0.373, 0.01, true},
                                 {0.0373, 0.1, false},
                                 {0.0373, 0.1, true},
                                 {0.0373, 0.01, false, true},
                                 {0.0373, 0.1, true, true},
                                 {0.00373, 0.01, false, false, 1.0},
                                 {0.0373, 0.1, true, false, 0.55}}) {
    CoupledCase c = taut_strip(16, 16, h, setting.dt, 32);
    c.set_mass(1.1 * setting.mass);
    c.p.substeps = static_cast<int>(std::ceil(setting.dt * 1e4 * std::sqrt(0.0373 / setting.mass)));
    c.p.sheet.law.impermeable = setting.impermeable;
    c.p.sheet.law.no_slip = setting.no_slip;
    c.p.sheet.edge_inset = setting.edge_inset;
    c.p.sheet.filter = 0.0;
    CoupledRun resting(c);
    const double at_rest = energy(resting);
    std::mt19937 engine(11);
    std::uniform_real_distribution<double> noise(-0.05, 0.05);
    for (std::size_t i = 0; i < c.v.size(); ++i)
      if (c.p.fabric.pinned[i] == 6) c.v[i][0] = noise(engine);
    CoupledRun run(c);
    const double first = energy(run) - at_rest;
    double last = first;
    for (int step = 0; step < 15; ++step) {
      ASSERT_TRUE(run.advance(1));
      const double now = energy(run) - at_rest;
      // The energy of the symplectic method oscillates.
      EXPECT_LE(now - last, 1e-4 * first) << setting.mass << " kg/m^2, dt " << setting.dt;
      last = now;
    }
    EXPECT_LT(last, 0.5 * first);
  }
}

// ctest-label: no-sanitizer
TEST(FreeSheet, NoiseDecaysWithTheFilteredAcceleration) {
  for (const double mass : {0.00373, 0.0373, 0.373})
    for (const bool impermeable : {false, true}) {
      CoupledCase c = taut_strip(16, 16, h, 0.004, 32);
      c.set_mass(1.1 * mass);
      c.p.substeps = 0;
      c.p.sheet.law.impermeable = impermeable;
      std::mt19937 engine(11);
      std::uniform_real_distribution<double> noise(-0.3, 0.3);
      for (std::size_t i = 0; i < c.v.size(); ++i)
        if (c.p.fabric.pinned[i] == 6) c.v[i][0] = noise(engine);
      CoupledRun run(c);
      ASSERT_TRUE(run.advance(200));
      std::vector<Vector> x(c.x.size()), v(c.x.size());
      run.solver->fabric().download(x, v);
      for (const Vector& of_vertex : v) EXPECT_LT(std::abs(of_vertex[0]), 0.03) << mass << ' ' << impermeable;
    }
}

/// Angular frequency of the free oscillation of a strip of one period of 2 pi / k, rad/s, from its zero
/// crossings.
double frequency(const CoupledCase& c) {
  CoupledCase displaced = c;
  const double length = c.p.flow.high[1], k = 2.0 * std::numbers::pi / length;
  const std::size_t top = c.x.size() / 4;  // quarter of the length
  for (Vector& x : displaced.x) x[0] += 1e-3 * length * std::sin(k * x[1]);
  CoupledRun run(displaced);
  std::vector<Vector> x(c.x.size()), v(c.x.size());
  double before = 1.0, crossing[2] = {};
  for (int found = 0, step = 1; found < 2 && step < 2000; ++step) {
    EXPECT_TRUE(run.advance(1));
    run.solver->fabric().download(x, v);
    const double now = x[top][0] - c.x[top][0];
    if (now * before < 0.0) crossing[found++] = (step - now / (now - before)) * c.p.flow.fixed_dt;
    before = now;
  }
  return std::numbers::pi / (crossing[1] - crossing[0]);
}

TEST(FreeSheet, OscillatesWithTheAddedMassOfTheAir) {
  // Potential flow on both sides of a sheet that moves as sin(k y): added mass 2 rho / k.
  double excess[2];
  for (int level = 0; level < 2; ++level) {
    const int cells = 16 << level;
    const double spacing = 3.2 / cells, k = 2.0 * std::numbers::pi / 3.2;
    CoupledCase c = taut_strip(cells, cells, spacing, 0.0025, cells);
    c.p.sheet.law.impermeable = true;
    CoupledCase vacuum = c;
    vacuum.p.sheet.law = {};
    vacuum.p.flow.fixed_dt = 2e-4, vacuum.p.substeps = 4 << level;
    const double in_air = frequency(c), in_vacuum = frequency(vacuum), mass = 0.0373,
                 added = mass * (std::pow(in_vacuum / in_air, 2) - 1.0);
    excess[level] = added / (2.0 * c.p.flow.density / k) - 1.0;
  }
  // The delta function widens the sheet by some cells: more added mass, to first order in the spacing.
  EXPECT_GT(excess[1], 0.0);
  EXPECT_LT(excess[1], 0.15);
  EXPECT_NEAR(excess[0] / excess[1], 2.0, 0.1);
}

}  // namespace
}  // namespace drogue::coupling
