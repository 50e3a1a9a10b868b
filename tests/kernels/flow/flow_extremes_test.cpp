#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "kernels/flow/observables/extremes.hpp"
#include "kernels/reference/flow/observables.hpp"
#include "tests/support/flow_case.hpp"

// Extremes over all steps against sums of the oracle after each.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests

constexpr const auto& backend = testing::tested_backend;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Extremes of energies, J, after steps of 0.5 s, with speeds of the same numbers, m/s.
Extremes of_energies(const std::vector<double>& energies) {
  Extremes extremes;
  for (std::size_t k = 0; k < energies.size(); ++k)
    add_step(extremes, static_cast<std::int64_t>(k), 0.5 * static_cast<double>(k), energies[k], energies[k]);
  return extremes;
}

TEST(FlowExtremes, RiseIsThatAboveTheLeastEnergyBefore) {
  EXPECT_DOUBLE_EQ(0.3, of_energies({2.0, 1.5, 1.7, 1.6, 1.8, 1.2, 1.3}).largest_rise);
  EXPECT_EQ(0.0, of_energies({2.0, 1.5, 1.5}).largest_rise);
  EXPECT_EQ(2.0, of_energies({2.0, 1.5, 1.7}).largest_speed);
}

TEST(FlowExtremes, DissipationIsThatOfOneStepAtItsMiddle) {
  const Extremes extremes = of_energies({2.0, 1.9, 1.6, 1.7, 1.5});
  EXPECT_DOUBLE_EQ(0.6, extremes.peak_dissipation);
  EXPECT_EQ(0.75, extremes.peak_time);
}

TEST(FlowExtremes, KeepWhatIsNoNumber) {
  const Extremes extremes = of_energies({2.0, not_a_number, 1.9, 1.8});
  EXPECT_TRUE(std::isnan(extremes.largest_rise));
  EXPECT_TRUE(std::isnan(extremes.largest_speed));
  EXPECT_TRUE(std::isnan(extremes.peak_dissipation));
}

TEST(FlowExtremes, LargestTotalsKeepWhatIsNoNumber) {
  double whole[total_count] = {}, part[total_count] = {};
  part[total_divergence] = not_a_number;
  combine_totals(whole, part);
  part[total_divergence] = 1.0;
  combine_totals(whole, part);
  EXPECT_TRUE(std::isnan(whole[total_divergence]));
}

/// Decaying flow, and flow that a force drives past a wall.
std::vector<Parameters> cases() {
  Parameters decaying = periodic_box({9, 8, 7}), driven = periodic_box({8, 7, 1});
  decaying.viscosity = 0.02;
  decaying.density = 1.3;
  driven.high[2] = 0.3;
  driven.body_force = {30.0, 0.0, 0.0};
  driven.boundary[2].kind = driven.boundary[3].kind = BoundaryKind::wall;
  driven.time_scheme = TimeScheme::ab2;
  for (Parameters* p : {&decaying, &driven}) p->watches_extremes = true;
  return {decaying, driven};
}

void expect_equal(const Extremes& a, const Extremes& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.energy, b.energy);
  EXPECT_EQ(a.least_energy, b.least_energy);
  EXPECT_EQ(a.largest_rise, b.largest_rise);
  EXPECT_EQ(a.largest_speed, b.largest_speed);
  EXPECT_EQ(a.peak_dissipation, b.peak_dissipation);
  EXPECT_EQ(a.peak_time, b.peak_time);
}

TEST(FlowExtremes, AreThoseOfTheReferenceAfterEveryStep) {
  for (const Parameters& p : cases()) {
    const FlowDomain domain(p);
    const auto solver = started(backend, p, random_field(domain, 31));
    double least = endless, rise = 0.0, fastest = 0.0, peak = 0.0, peak_time = 0.0, before = 0.0, begin = 0.0;
    for (std::int64_t step = 0; step <= 12; ++step) {
      if (step > 0) {
        ASSERT_EQ(solver->advance(endless, step, {}), Stop::pause);
      }
      const auto sums = reference::flow_sums(domain, velocity(*solver), 0.0);
      const double time = solver->progress().time, energy = sums.kinetic_energy;
      least = std::min(least, energy);
      rise = std::max(rise, energy - least);
      fastest = std::max(fastest, sums.max_speed);
      if (step > 0 && (before - energy) / (time - begin) > peak)
        peak = (before - energy) / (time - begin), peak_time = 0.5 * (begin + time);
      before = energy, begin = time;
    }
    const Extremes found = solver->extremes();
    const double round_off = 1e-13 * (least + rise);
    EXPECT_EQ(12, found.step);
    EXPECT_EQ(begin, found.time);
    EXPECT_NEAR(before, found.energy, round_off);
    EXPECT_NEAR(least, found.least_energy, round_off);
    EXPECT_NEAR(rise, found.largest_rise, round_off);
    EXPECT_NEAR(fastest, found.largest_speed, 1e-14 * fastest);
    EXPECT_NEAR(peak, found.peak_dissipation, 1e-9 * (1.0 + peak));
    EXPECT_EQ(peak_time, found.peak_time);
    EXPECT_TRUE(rise > 0.0 || peak > 0.0);
    // The division of the steps into advances does not matter.
    const auto whole = started(backend, p, random_field(domain, 31));
    ASSERT_EQ(whole->advance(endless, 12, {}), Stop::pause);
    expect_equal(found, whole->extremes());
  }
}

TEST(FlowExtremes, ContinueAfterARestart) {
  for (const Parameters& p : cases()) {
    const auto solver = started(backend, p, random_field(FlowDomain(p), 32));
    ASSERT_EQ(solver->advance(endless, 5, {}), Stop::pause);
    const auto restarted = create_solver(backend, p);
    copy_state(*solver, *restarted);
    restarted->restore(solver->progress());
    restarted->set_extremes(solver->extremes());
    ASSERT_EQ(solver->advance(endless, 9, {}), Stop::pause);
    ASSERT_EQ(restarted->advance(endless, 9, {}), Stop::pause);
    expect_equal(solver->extremes(), restarted->extremes());
  }
}

TEST(FlowExtremes, BeginAnewAndLeaveOutStepsThatFail) {
  Parameters p = cases()[0];
  const auto solver = started(backend, p, random_field(FlowDomain(p), 33));
  ASSERT_EQ(solver->advance(endless, 5, {}), Stop::pause);
  solver->start();
  EXPECT_EQ(0, solver->extremes().step);
  EXPECT_DOUBLE_EQ(solver->totals().kinetic_energy, solver->extremes().energy);
  p.fixed_dt = 10.0;  // is not stable
  const auto failing = started(backend, p, random_field(FlowDomain(p), 33));
  EXPECT_EQ(failing->advance(endless, 5, {}), Stop::failed);
  EXPECT_EQ(0, failing->extremes().step);
}

TEST(FlowExtremes, AreWatchedOnRequest) {
  Parameters p = cases()[0];
  p.watches_extremes = false;
  const auto solver = started(backend, p, random_field(FlowDomain(p), 34));
  EXPECT_EQ(-1, solver->extremes().step);
  EXPECT_THROW(solver->set_extremes({}), std::invalid_argument);
}

}  // namespace
}  // namespace drogue::flow
