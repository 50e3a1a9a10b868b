#include <gtest/gtest.h>

#include <cmath>

#include "kernels/reference/gas/exact_riemann.hpp"
#include "kernels/reference/gas/run.hpp"

namespace drogue::reference {
namespace {

gas::Parameters sod_parameters() {
  gas::Parameters p;
  p.cells = 100;
  p.positivity = gas::Positivity::off;
  return p;
}

Primitive sod(double x) { return x < 0.0 ? Primitive{1, 0, 1} : Primitive{.125, 0, .1}; }

double sod_error(const gas::Parameters& p) {
  const GasRun run = reference_run(p, sod, 0.4);
  const ExactRiemann exact({1, 0, 1}, {.125, 0, .1}, 1.4);
  return l1_density(run, p, [&](double x) { return exact.sample(x / 0.4).rho; });
}

TEST(ReferenceRun, KeepsAUniformFlowExactly) {
  for (const gas::TimeScheme time : {gas::TimeScheme::ssprk3, gas::TimeScheme::ssprk43}) {
    gas::Parameters p = sod_parameters();
    p.time_scheme = time;
    p.positivity = gas::Positivity::on;
    const Primitive w = {1.0, 0.5, 2.0};
    const GasRun run = reference_run(
        p, [&](double) { return w; }, 0.2);
    const Conserved start = to_conserved(w, 1.4);
    for (const Conserved& U : run.state)
      for (std::size_t s = 0; s < 3; ++s)
        EXPECT_NEAR(U[s], start[s], 4e-16 * start[s] * static_cast<double>(run.steps));
    EXPECT_EQ(run.limited_faces, 0);
  }
}

TEST(ReferenceRun, RampsTheFirstTwentySteps) {
  gas::Parameters p = sod_parameters();
  GasRun run = start_run(p, [](double) {
    return Primitive{1.4, 0.0, 1.0};
  });  // constant wave speed 1, dt = ramp * 0.012
  double expected = 0.0;
  for (int k = 0; k < 25; ++k) expected += 0.012 * (k < 20 ? 0.1 + 0.045 * k : 1.0);
  advance(run, p, expected);
  EXPECT_EQ(run.steps, 25);
}

TEST(ReferenceRun, SoundWavesCrossPeriodicEndsAndReflectFromWalls) {
  // A small right-going sound pulse: unchanged after one period, mirrored with -u after one reflection.
  gas::Parameters p = sod_parameters();
  p.x_min = 0.0;
  p.x_max = 1.0;
  const auto pulse = [](double x) {
    const double a = 1e-6 * std::exp(-200.0 * (x - 0.5) * (x - 0.5));
    return Primitive{1.4 * (1.0 + a), a, 1.0 + 1.4 * a};
  };
  p.left = p.right = gas::Boundary::periodic;
  const GasRun around = reference_run(p, pulse, 1.0);
  p.left = p.right = gas::Boundary::reflecting;
  const GasRun back = reference_run(p, pulse, 1.0);
  for (std::size_t i = 0; i < 100; ++i) {
    const Primitive start = pulse(cell_centre(p, i));
    EXPECT_NEAR(to_primitive(around.state[i], 1.4).u, start.u, 1.5e-8);
    EXPECT_NEAR(to_primitive(back.state[i], 1.4).u, -start.u, 1.5e-8);
    EXPECT_NEAR(back.state[i][0], start.rho, 1.5e-8);
  }
}

TEST(ReferenceRun, SodErrorsMatchPublishedValues) {
  gas::Parameters p = sod_parameters();
  const auto near = [](double error, double published) { EXPECT_NEAR(error, published, 0.01 * published); };
  p.weno = gas::Weno::js;
  near(sod_error(p), 1.23e-2);
  p.weno = gas::Weno::z;
  near(sod_error(p), 1.01e-2);
  p.weno = gas::Weno::teno5;
  near(sod_error(p), 1.01e-2);
  // Published at 200 cells for JS: per-field alpha over the mesh, and one alpha for all fields.
  p.cells = 200;
  p.weno = gas::Weno::js;
  p.splitting = gas::Splitting::lf_global;
  near(sod_error(p), 6.12e-3);
  p.splitting = gas::Splitting::lf_single;
  near(sod_error(p), 6.94e-3);
}

TEST(ReferenceRun, FourStageSchemeKeepsTheErrorWithTwiceTheStep) {
  gas::Parameters p = sod_parameters();
  const double three_stages = sod_error(p);
  p.time_scheme = gas::TimeScheme::ssprk43;
  p.cfl = 1.2;
  EXPECT_NEAR(sod_error(p), three_stages, 0.06 * three_stages);
}

TEST(ReferenceRun, AutomaticPositivityCompletesRunsThatFailWithoutIt) {
  gas::Parameters p = sod_parameters();
  p.x_min = 0.0;
  p.x_max = 9.0;
  p.gamma = 5.0 / 3.0;
  p.weno = gas::Weno::teno5;
  const auto leblanc = [](double x) {
    return x < 3.0 ? Primitive{1, 0, 2.0 / 3.0 * 1e-1} : Primitive{1e-3, 0, 2.0 / 3.0 * 1e-10};
  };
  const GasRun lost = reference_run(p, leblanc, 6.0);
  EXPECT_TRUE(lost.failed);
  EXPECT_LT(lost.time, 6.0);
  p.positivity = gas::Positivity::automatic;
  const GasRun saved = reference_run(p, leblanc, 6.0);
  EXPECT_FALSE(saved.failed);
  EXPECT_EQ(saved.time, 6.0);
  EXPECT_GT(saved.redone_steps, 0);
  EXPECT_GT(saved.limited_faces, 0);
}

TEST(ReferenceRun, AutomaticPositivityStaysOffWithoutFailures) {
  gas::Parameters p = sod_parameters();
  const GasRun off = reference_run(p, sod, 0.4);
  p.positivity = gas::Positivity::automatic;
  const GasRun automatic = reference_run(p, sod, 0.4);
  EXPECT_EQ(off.state, automatic.state);
  EXPECT_EQ(automatic.redone_steps, 0);
}

TEST(ReferenceRun, StopsAtMaxSteps) {
  gas::Parameters p = sod_parameters();
  p.max_steps = 7;
  const GasRun run = reference_run(p, sod, 0.4);
  EXPECT_TRUE(run.failed);
  EXPECT_EQ(run.steps, 7);
}

}  // namespace
}  // namespace drogue::reference
