#include "kernels/reference/gas/muscl_hancock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kernels/reference/gas/exact_riemann.hpp"

namespace drogue::reference {
namespace {

gas::Parameters parameters(std::int64_t cells) {
  gas::Parameters p;
  p.cells = cells;
  p.cfl = 0.8;
  return p;
}

GasRun finished(const gas::Parameters& p, const std::function<Primitive(double)>& initial, double end_time) {
  GasRun run = start_run(p, initial);
  muscl_hancock(run, p, end_time);
  return run;
}

double wave_error(std::int64_t cells) {
  gas::Parameters p = parameters(cells);
  p.left = p.right = gas::Boundary::periodic;
  const auto rho = [](double x) { return 1.0 + 0.2 * std::sin(std::numbers::pi * x); };
  const GasRun run = finished(
      p,
      [&](double x) {
        return Primitive{rho(x), 1.0, 1.0};
      },
      2.0);
  return l1_density(run, p, rho);
}

// ctest-label: no-sanitizer
TEST(MusclHancock, ConvergesWithSecondOrder) {
  // The limiter clips the two extrema, in a decreasing fraction of the cells.
  const double order = std::log2(wave_error(40) / wave_error(320)) / 3.0;
  EXPECT_GT(order, 1.9);
  EXPECT_LT(order, 2.3);
}

struct Tube {
  const char* name;
  Primitive left, right;
  double x_min, x_max, x0, end_time, gamma;
  double weno_js;  ///< L1 error of the density of WENO5-JS on 200 cells, from an independent code
};

double tube_error(const Tube& tube, std::int64_t cells) {
  gas::Parameters p = parameters(cells);
  p.gamma = tube.gamma;
  p.x_min = tube.x_min, p.x_max = tube.x_max;
  const GasRun run = finished(
      p, [&](double x) { return x < tube.x0 ? tube.left : tube.right; }, tube.end_time);
  EXPECT_FALSE(run.failed);
  EXPECT_EQ(run.time, tube.end_time);
  const ExactRiemann exact(tube.left, tube.right, tube.gamma);
  return l1_density(run, p, [&](double x) { return exact.sample((x - tube.x0) / tube.end_time).rho; });
}

TEST(MusclHancock, ConvergesOnShockTubesWithErrorsCloseToWeno) {
  for (const Tube& tube :
       {Tube{"sod", {1, 0, 1}, {.125, 0, .1}, -1, 1, 0, .4, 1.4, 6.13e-3},
        Tube{"toro 1", {1, .75, 1}, {.125, 0, .1}, 0, 1, .3, .2, 1.4, 3.46e-3},
        Tube{"toro 2", {1, -2, .4}, {1, 2, .4}, 0, 1, .5, .15, 1.4, 5.21e-3},
        Tube{"toro 3", {1, 0, 1000}, {1, 0, .01}, 0, 1, .5, .012, 1.4, .0698},
        Tube{"leblanc", {1, 0, 1e-1 / 1.5}, {1e-3, 0, 1e-10 / 1.5}, 0, 9, 3, 6, 5. / 3, 4.1e-2}}) {
    const double error = tube_error(tube, 200);
    EXPECT_LT(error, 1.5 * tube.weno_js) << tube.name;
    EXPECT_LT(tube_error(tube, 400), 0.75 * error) << tube.name;
  }
}

TEST(MusclHancock, ReflectingWallsConserveMassAndEnergyOfBlasts) {
  gas::Parameters p = parameters(400);
  p.x_min = 0.0;
  p.left = p.right = gas::Boundary::reflecting;
  GasRun run = start_run(p, [](double x) { return Primitive{1, 0, x < .1 ? 1000 : x < .9 ? .01 : 100}; });
  const auto sum = [&](std::size_t k) {
    double total = 0.0;
    for (const Conserved& u : run.state) total += u[k];
    return total;
  };
  const double mass = sum(0), energy = sum(2);
  muscl_hancock(run, p, 0.038);
  EXPECT_FALSE(run.failed);
  EXPECT_NEAR(sum(0), mass, 1e-12 * mass);
  EXPECT_NEAR(sum(2), energy, 1e-12 * energy);
}

TEST(MusclHancock, KeepsMovingContactsMonotone) {
  gas::Parameters p = parameters(100);
  p.left = p.right = gas::Boundary::periodic;
  const GasRun run = finished(
      p,
      [](double x) {
        return Primitive{std::abs(x) < 0.5 ? 2.0 : 1.0, 1.0, 1.0};
      },
      2.0);
  for (const Conserved& u : run.state) {
    EXPECT_GT(u[0], 1.0 - 1e-12);
    EXPECT_LT(u[0], 2.0 + 1e-12);
  }
}

TEST(MusclHancock, ReportsFailureAndKeepsTheLastGoodState) {
  gas::Parameters p = parameters(50);
  const auto tube = [](double x) { return Primitive{x < 0 ? 1.0 : .125, 0, x < 0 ? 1.0 : .1}; };
  p.max_steps = 3;
  EXPECT_TRUE(finished(p, tube, .4).failed);
  EXPECT_TRUE(finished(
                  parameters(50),
                  [](double x) {
                    return Primitive{1, 0, x < 0 ? 1.0 : -1.0};
                  },
                  .4)
                  .failed);
  // Far above the stable time step a state becomes unphysical during the run.
  p = parameters(50);
  p.cfl = 6.0;
  p.ramp_steps = 0;
  const GasRun run = finished(p, tube, .4);
  EXPECT_TRUE(run.failed);
  EXPECT_LT(run.time, .4);
  for (const Conserved& u : run.state) {
    EXPECT_GT(u[0], 0.0);
    EXPECT_GT(pressure(u, p.gamma), 0.0);
  }
}

}  // namespace
}  // namespace drogue::reference
