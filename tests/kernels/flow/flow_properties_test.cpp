#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/flow_case.hpp"

// Properties of the discrete equations: free of divergence, conserved momentum, uniform flow, and equal
// results of backends.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests

constexpr const auto& backend = testing::tested_backend;
constexpr Advection schemes[] = {Advection::central, Advection::weno_js, Advection::weno_z};
constexpr TimeScheme time_schemes[] = {TimeScheme::ab2, TimeScheme::rk3};

/// Channel along x from an inflow to an outflow, with slip sides in y and walls in z.
Parameters channel(const std::array<int, 3>& cells) {
  Parameters p;
  p.cells = cells;
  p.high = {2.0, 1.0, 1.0};
  p.viscosity = 1e-3;
  const BoundaryKind kinds[] = {BoundaryKind::inflow, BoundaryKind::outflow, BoundaryKind::slip,
                                BoundaryKind::slip,   BoundaryKind::wall,    BoundaryKind::wall};
  for (std::size_t side = 0; side < 6; ++side) p.boundary[side].kind = kinds[side];
  p.boundary[0].velocity = {0.7, 0.0, 0.0};
  return p;
}

TEST(FlowProperties, StepsLeaveNoDivergence) {
  for (const Advection scheme : schemes)
    for (const TimeIntegration& integration : time_integrations)
      for (Parameters p : {periodic_box({13, 12, 11}), periodic_box({61, 59, 1}), channel({24, 11, 10})}) {
        p.advection = scheme;
        integration.set(p);
        const FlowDomain domain(p);
        const auto solver = started(backend, p, random_field(domain, 5));
        ASSERT_EQ(solver->advance(endless, 5, {}), Stop::pause);
        const std::vector<double> divergence = reference::divergence(domain, velocity(*solver));
        // Rounding of velocities of order one on cells of 1/60 m at least.
        EXPECT_LT(largest(divergence), 1e-11);
        EXPECT_NEAR(solver->totals().divergence_max, largest(divergence), 1e-12);
      }
}

TEST(FlowProperties, PrimeNumbersOfCellsLeaveNoDivergence) {
  for (Parameters p : {periodic_box({61, 59, 127}), channel({61, 59, 127})}) {
    p.time_scheme = TimeScheme::ab2;
    const FlowDomain domain(p);
    const auto solver = started(backend, p, random_field(domain, 8));
    ASSERT_EQ(solver->advance(endless, 2, {}), Stop::pause);
    EXPECT_LT(largest(reference::divergence(domain, velocity(*solver))), 1e-11);
  }
}

TEST(FlowProperties, PeriodicBoxesConserveMomentumToRoundOff) {
  for (const Advection scheme : schemes)
    for (const TimeIntegration& integration : time_integrations)
      for (Parameters p : {periodic_box({13, 12, 11}), periodic_box({37, 1, 14})}) {
        p.advection = scheme;
        integration.set(p);
        p.viscosity = 0.01;
        const auto solver = started(backend, p, random_field(FlowDomain(p), 6));
        const Totals before = solver->totals();
        ASSERT_EQ(solver->advance(endless, 20, {}), Stop::pause);
        const Totals after = solver->totals();
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(after.momentum[c], before.momentum[c], 2e-15) << c;
      }
}

TEST(FlowProperties, BodyForceAndPressureDropAccelerateTheMean) {
  Parameters p = periodic_box({8, 9, 10});
  p.high = {2.0, 1.0, 0.5};
  p.density = 1.5;
  p.body_force = {0.3, -0.6, 0.0};
  p.pressure_drop = {0.0, 0.0, 0.9};
  p.fixed_dt = 0.01;
  const auto solver = started(backend, p, random_field(FlowDomain(p), 7));
  const Totals before = solver->totals();
  ASSERT_EQ(solver->advance(endless, 10, {}), Stop::pause);
  const double volume = 1.0, force[] = {0.3, -0.6, 0.9 / 0.5};
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(solver->totals().momentum[c] - before.momentum[c], 0.1 * force[c] * volume, 1e-14);
}

TEST(FlowProperties, KeepUniformFlowBitForBit) {
  for (const Advection scheme : schemes)
    for (const TimeScheme time : time_schemes) {
      Parameters p = periodic_box({13, 7, 9});
      p.viscosity = 0.1;
      p.advection = scheme;
      p.time_scheme = time;
      const std::array<double, 3> u{0.3, -1.7, 1e-3};
      const FlowDomain domain(p);
      const auto initial =
          sampled_field(domain, [&](std::size_t c, const reference::Point&) { return u[c]; });
      const auto solver = started(backend, p, initial);
      ASSERT_EQ(solver->advance(endless, 50, {}), Stop::pause);
      EXPECT_EQ(velocity(*solver), initial);
    }
}

TEST(FlowProperties, KeepUniformFlowFromInflowToOutflow) {
  Parameters p = channel({16, 8, 6});
  p.boundary[4].kind = p.boundary[5].kind = BoundaryKind::slip;
  const FlowDomain domain(p);
  const auto initial =
      sampled_field(domain, [](std::size_t c, const reference::Point&) { return c == 0 ? 0.7 : 0.0; });
  const auto solver = started(backend, p, initial);
  ASSERT_EQ(solver->advance(endless, 50, {}), Stop::pause);
  EXPECT_EQ(velocity(*solver), initial);
}

TEST(FlowProperties, CentralAdvectionConservesEnergyOfInviscidFlow) {
  Parameters p = periodic_box({12, 11, 10});
  p.advection = Advection::central;
  p.time_scheme = TimeScheme::rk3;
  p.fixed_dt = 1e-4;
  const auto solver = started(backend, p, random_field(FlowDomain(p), 8));
  const double before = solver->totals().kinetic_energy;
  ASSERT_EQ(solver->advance(endless, 20, {}), Stop::pause);
  EXPECT_NEAR(solver->totals().kinetic_energy, before, 1e-10 * before);
}

// ctest-label: exact
TEST(FlowProperties, BackendsAgree) {
#if defined(DROGUE_EXACT)
  const double tolerance = 0.0;
#else
  // cuFFT and cuBLAS sum in another order than FFTW; five steps let the differences of noise grow.
  const double tolerance = backend == device::Backend::cuda ? 1e-11 : 1e-12;
#endif
  const device::Backend other = device::compiled_backends().front();
  for (const TimeScheme time : time_schemes)
    for (Parameters p : {periodic_box({33, 20, 21}), channel({32, 17, 18})}) {
      p.time_scheme = time;
      const StaggeredField initial = random_field(FlowDomain(p), 9);
      const auto first = started(other, p, initial), second = started(backend, p, initial);
#if defined(DROGUE_EXACT)
      // The one solver of the pressure whose sums have the same order on all backends.
      EXPECT_STREQ(second->pressure_solver(), "diagonalization");
#endif
      ASSERT_EQ(first->advance(endless, 5, {}), Stop::pause);
      ASSERT_EQ(second->advance(endless, 5, {}), Stop::pause);
      EXPECT_LE(largest_difference(velocity(*first), velocity(*second)), tolerance);
      EXPECT_LE(std::abs(first->progress().time - second->progress().time), tolerance);
    }
}

}  // namespace
}  // namespace drogue::flow
