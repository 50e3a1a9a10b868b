#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "kernels/device/profiling_counters.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/gas_state.hpp"

// Launches, fences, allocations and copies of stepping, and its stopping criteria.

namespace drogue::gas {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests
using device::ProfilingCounters;

constexpr const auto& backend = testing::tested_backend;
const bool on_device = backend == device::Backend::cuda;
constexpr auto never = std::numeric_limits<double>::max();

/// Profiling counters; the first call starts profiling.
ProfilingCounters counted() {
  static const bool once = (device::start_profiling(), true);
  static_cast<void>(once);
  return device::profiling_counters();
}

ProfilingCounters operator-(const ProfilingCounters& after, const ProfilingCounters& before) {
  ProfilingCounters d;
  d.kernel_launches = after.kernel_launches - before.kernel_launches;
  d.fences = after.fences - before.fences;
  d.allocations = after.allocations - before.allocations;
  d.h2d_bytes = after.h2d_bytes - before.h2d_bytes;
  d.d2h_bytes = after.d2h_bytes - before.d2h_bytes;
  d.copies = after.copies - before.copies;
  d.device_bytes = after.device_bytes - before.device_bytes;
  return d;
}

/// Counters of `advance` by `steps` steps of a warm solver, with rows every `row_every`.
ProfilingCounters cost(Solver& solver, std::int64_t steps, int row_every = 0) {
  const std::int64_t now = solver.restart_state().step;
  const ProfilingCounters before = counted();
  EXPECT_EQ(solver.advance(never, now + steps, row_every, {}, {}), Stop::pause);
  return counted() - before;
}

Parameters sod(Positivity positivity = Positivity::automatic) {
  Parameters p;
  p.positivity = positivity;
  p.left = p.right = Boundary::reflecting;  // never leaves the domain
  return p;
}
GasState sod_state(const Parameters& p) { return riemann_state(p, 0.0, {1, 0, 1}, {0.125, 0, 0.1}); }

std::unique_ptr<Solver> warm(const Parameters& p) {
  auto solver = started(backend, p, sod_state(p));
  EXPECT_EQ(solver->advance(never, 1, 0, {}, {}), Stop::pause);
  return solver;
}

TEST(GasLaunches, StepsWithoutOutputDoNotFenceAllocateOrCopy) {
  for (const TimeScheme time : {TimeScheme::ssprk3, TimeScheme::ssprk43})
    for (const Positivity positivity : {Positivity::off, Positivity::on, Positivity::automatic}) {
      Parameters p = sod(positivity);
      p.time_scheme = time;
      const auto solver = warm(p);
      const ProfilingCounters few = cost(*solver, 50), many = cost(*solver, 500);
      EXPECT_EQ(many.fences, few.fences);
      EXPECT_LE(many.fences, 4);
      EXPECT_EQ(many.allocations, 0);
      EXPECT_EQ(many.copies, 0);
      EXPECT_EQ(many.h2d_bytes + many.d2h_bytes, 0);
      // All stages are one kernel, and a second kernel ends the step. On a device a captured step is one
      // launch, and without the limiter one launch takes many steps.
      const std::int64_t a_step = on_device ? 1 : 2;
      if (on_device && positivity != Positivity::on) {
        EXPECT_STREQ(solver->driver(), "persistent");
        EXPECT_GE(many.kernel_launches, 2);
        EXPECT_LE(many.kernel_launches, 8);
      } else {
        EXPECT_LE(many.kernel_launches, 500 * a_step + 1);
      }
    }
}

TEST(GasLaunches, RequestedDriversBoundTheNumberOfKernels) {
  for (const Driver driver : {Driver::plain, Driver::graph, Driver::stages})
    for (const Positivity positivity : {Positivity::off, Positivity::on}) {
      Parameters p = sod(positivity);
      p.driver = driver;
      const auto solver = warm(p);
      const bool stages = driver == Driver::stages;
      const bool graph = on_device && driver != Driver::plain;
      EXPECT_STREQ(solver->driver(), stages ? "stages" : graph ? "graph" : "plain");
      const ProfilingCounters few = cost(*solver, 50), many = cost(*solver, 500);
      EXPECT_LE(many.kernel_launches, 500 * (graph ? 1 : stages ? 4 : 2) + 1);
      EXPECT_EQ(many.fences, few.fences);
      EXPECT_EQ(many.allocations, 0);
      EXPECT_EQ(many.copies, 0);
    }
}

TEST(GasLaunches, UnusedAutomaticPositivityAddsNoLaunches) {
  const ProfilingCounters off = cost(*warm(sod(Positivity::off)), 300);
  const auto automatic = warm(sod(Positivity::automatic));
  const ProfilingCounters idle = cost(*automatic, 300);
  EXPECT_EQ(automatic->restart_state().redone, 0);
  EXPECT_EQ(idle.fences, off.fences);
  if (!on_device) {
    EXPECT_LE(idle.kernel_launches, off.kernel_launches);
  }
  const auto state = download(*automatic, sod());
  const auto plain = warm(sod(Positivity::off));
  cost(*plain, 300);
  EXPECT_TRUE(same_bits(state, download(*plain, sod())));
}

TEST(GasLaunches, HistoryRowsAddLaunchesButNoFencesAndKeepTheBits) {
  const auto plain = warm(sod());
  cost(*plain, 500);
  for (const int every : {1, 7, 100}) {
    const auto solver = warm(sod());
    const ProfilingCounters rows = cost(*solver, 500, every);
    EXPECT_LE(rows.fences, 5);
    EXPECT_EQ(rows.allocations, 0);
    EXPECT_EQ(rows.copies, 0);
    EXPECT_TRUE(same_bits(download(*solver, sod()), download(*plain, sod())));
    if (!on_device) {
      // 200 cells: one level of sums and the row itself.
      const std::int64_t expected = 501 / every * 2 + 500 * 2 + 1;
      EXPECT_LE(rows.kernel_launches, expected + 2);
    }
  }
}

// ctest-label: no-sanitizer
TEST(GasLaunches, UsesAtMostEightyBytesPerCell) {
  constexpr std::int64_t cells = 1 << 20;
  const ProfilingCounters before = counted();
  Parameters p = sod();
  p.cells = cells;
  const GasState state = sod_state(p);
  const auto solver = started(backend, p, state);
  EXPECT_EQ(solver->advance(never, 3, 1, {}, {}), Stop::pause);
  const std::int64_t stepping = (counted() - before).device_bytes;
  EXPECT_GE(stepping, 72 * cells);
  EXPECT_LE(stepping, 80 * cells + (std::int64_t{1} << 20));
  solver->begin_snapshot();
  solver->finish_snapshot();
  EXPECT_LE((counted() - before).device_bytes, 104 * cells + (std::int64_t{1} << 20));
  EXPECT_GE(counted().peak_device_bytes, 96 * cells);
  EXPECT_LE(counted().peak_device_bytes, before.device_bytes + 104 * cells + (std::int64_t{1} << 20));
}

TEST(GasLaunches, DestructionReleasesTheMemory) {
  const ProfilingCounters before = counted();
  warm(sod());
  EXPECT_LE((counted() - before).device_bytes, 1 << 20);  // scratch of the backend itself
}

// ---- rows, pauses, ends ----

TEST(GasStops, WritesRowsAtMultiplesOfTheInterval) {
  for (const int every : {1, 3, 10}) {
    const auto solver = warm(sod());
    std::vector<HistoryRow> rows;
    const RowSink keep = [&](const HistoryRow& row) { rows.push_back(row); };
    EXPECT_EQ(solver->advance(never, 20, every, keep, {}), Stop::pause);
    EXPECT_EQ(solver->advance(never, 31, every, keep, {}), Stop::pause);
    ASSERT_EQ(rows.size(), static_cast<std::size_t>(31 / every - 1 / every));
    for (std::size_t k = 0; k < rows.size(); ++k) {
      EXPECT_EQ(rows[k].step, every * static_cast<std::int64_t>(k + 1 + (every == 1 ? 1 : 0)));
      // The reflecting ends conserve mass and energy.
      EXPECT_NEAR(rows[k].mass, 1.125, 1e-13);
      EXPECT_NEAR(rows[k].energy, 2.75, 1e-13);
      EXPECT_GT(rows[k].dt, 0.0);
      if (k > 0) {
        EXPECT_GT(rows[k].time, rows[k - 1].time);
      }
    }
  }
}

TEST(GasStops, DeliversMoreRowsThanTheRingHolds) {
  Parameters p = sod();
  p.cells = 16;
  const auto solver = started(backend, p, sod_state(p));
  std::int64_t next = 1;
  const RowSink in_order = [&](const HistoryRow& row) { EXPECT_EQ(row.step, next++); };
  EXPECT_EQ(solver->advance(never, 5000, 1, in_order, {}), Stop::pause);
  EXPECT_EQ(next, 5001);
}

TEST(GasStops, MeetsTargetsAndPausesExactly) {
  const auto solver = warm(sod());
  for (const double target : {0.01, 0.0137, 0.1}) {
    EXPECT_EQ(solver->advance(target, -1, 3, {}, {}), Stop::target);
    EXPECT_EQ(solver->restart_state().time, target);
    EXPECT_EQ(solver->totals().time, target);
  }
  const std::int64_t step = solver->restart_state().step;
  EXPECT_EQ(solver->advance(0.1, -1, 0, {}, {}), Stop::target) << "nothing is left to do";
  EXPECT_EQ(solver->restart_state().step, step);
  EXPECT_EQ(solver->advance(0.2, step + 3, 0, {}, {}), Stop::pause);
  EXPECT_EQ(solver->restart_state().step, step + 3);
}

TEST(GasStops, AvoidsATinyLastStepBeforeATarget) {
  // If the remainder after a step would be below rounding, the step extends to the target.
  Parameters p = sod();
  p.fixed_dt = 0.001;
  const auto solver = started(backend, p, sod_state(p));
  EXPECT_EQ(solver->advance(0.1, -1, 0, {}, {}), Stop::target);
  EXPECT_EQ(solver->restart_state().step, 100);
  EXPECT_NEAR(solver->restart_state().dt_min, 0.001, 1e-15);
}

TEST(GasStops, StopsAtTheMaximumNumberOfSteps) {
  Parameters p = sod();
  p.max_steps = 17;
  const auto solver = started(backend, p, sod_state(p));
  EXPECT_EQ(solver->advance(never, -1, 0, {}, {}), Stop::max_steps);
  EXPECT_EQ(solver->restart_state().step, 17);
  EXPECT_EQ(solver->advance(never, -1, 0, {}, {}), Stop::max_steps);
  EXPECT_EQ(solver->restart_state().step, 17);
}

TEST(GasStops, PollInterruptsBetweenSteps) {
  const auto solver = warm(sod());
  const Poll stop_at_30 = [](const Status& status) { return status.step < 30; };
  EXPECT_EQ(solver->advance(never, -1, 0, {}, stop_at_30), Stop::interrupted);
  const std::int64_t step = solver->restart_state().step;
  EXPECT_GE(step, 30);
  EXPECT_LE(step, on_device ? 30'000'000 : 30);
  // Later steps have the bits of an uninterrupted run.
  EXPECT_EQ(solver->advance(never, step + 20, 0, {}, {}), Stop::pause);
  const auto whole = started(backend, sod(), sod_state(sod()));
  EXPECT_EQ(whole->advance(never, step + 20, 0, {}, {}), Stop::pause);
  EXPECT_TRUE(same_bits(download(*solver, sod()), download(*whole, sod())));
}

TEST(GasStops, FailureReportsReasonCellAndStep) {
  Parameters p = sod(Positivity::off);
  p.cells = 100;
  p.cfl = 20.0;
  p.ramp_steps = 0;
  const auto solver = started(backend, p, sod_state(p));
  EXPECT_EQ(solver->advance(never, -1, 10, {}, {}), Stop::failed);
  const StepFailure failed = solver->failure();
  const RestartState last = solver->restart_state();
  EXPECT_EQ(failed.step, last.step + 1);
  EXPECT_EQ(failed.time, last.time);
  EXPECT_GT(failed.dt, 0.0);
  ASSERT_GE(failed.index, 0);
  ASSERT_LT(failed.index, 100);
  EXPECT_TRUE(failed.reason == FailureReason::density || failed.reason == FailureReason::pressure);
  // The reference fails at the same step, and the solver keeps the last admissible state.
  reference::GasRun run = reference_from(sod_state(p));
  reference::advance(run, p, 1e9);
  EXPECT_TRUE(run.failed);
  EXPECT_EQ(run.steps, last.step);
  EXPECT_LT(distance(download(*solver, p), state_of(run)), 1e-10);
  EXPECT_EQ(solver->advance(never, -1, 0, {}, {}), Stop::failed) << "a failed run stays where it is";
  EXPECT_EQ(solver->restart_state().step, last.step);
}

TEST(GasStops, FailureReportsTheCell) {
  for (const std::int64_t cell : {3, 37, 126, 127, 128, 197}) {
    Parameters p;
    p.positivity = Positivity::off;
    p.cfl = 5.0;
    p.ramp_steps = 0;
    // Two uniform streams diverge at one face: a step that is too long empties the cells beside it.
    const GasState state = make_state(p, [&](std::int64_t i) {
      return reference::Primitive{1.0, i < cell ? -5.0 : 5.0, 1.0};
    });
    const auto solver = started(backend, p, state);
    EXPECT_EQ(solver->advance(never, -1, 0, {}, {}), Stop::failed);
    EXPECT_LE(std::abs(static_cast<double>(solver->failure().index - cell) + 0.5), 3.0) << cell;
    EXPECT_EQ(solver->failure().step, 1);
    EXPECT_EQ(solver->restart_state().step, 0);
    EXPECT_TRUE(same_bits(download(*solver, p), state));
  }
}

TEST(GasStops, NeverShortensAFixedStep) {
  for (const Positivity positivity : {Positivity::on, Positivity::automatic}) {
    Parameters p = sod(positivity);
    p.fixed_dt = 1.0;
    const auto solver = started(backend, p, sod_state(p));
    EXPECT_EQ(solver->advance(never, -1, 0, {}, {}), Stop::failed);
    EXPECT_EQ(solver->failure().dt, 1.0);
    EXPECT_EQ(solver->restart_state().step, 0);
    reference::GasRun run = reference_from(sod_state(p));
    reference::advance(run, p, 1e9);
    EXPECT_TRUE(run.failed);
    EXPECT_EQ(run.steps, 0);
  }
}

TEST(GasStops, RejectsStatesWithNaN) {
  for (const Positivity positivity : {Positivity::off, Positivity::on, Positivity::automatic})
    for (std::size_t k = 0; k < 3; ++k) {
      const Parameters p = sod(positivity);
      GasState state = sod_state(p);
      state[k][100] = std::nan("");
      const auto solver = started(backend, p, state);
      EXPECT_EQ(solver->advance(never, 10, 0, {}, {}), Stop::failed);
      EXPECT_EQ(solver->restart_state().step, 0);
    }
}

// ---- positivity on demand ----

TEST(GasPositivity, AutomaticLimiterCompletesARunThatFailsWithoutIt) {
  Parameters p;
  p.cells = 100;
  p.x_min = 0.0;
  p.x_max = 9.0;
  p.gamma = 5.0 / 3.0;
  p.weno = Weno::teno5;
  const GasState leblanc = riemann_state(p, 3.0, {1, 0, 2.0 / 30}, {1e-3, 0, 2.0 / 3e10});
  p.positivity = Positivity::off;
  EXPECT_EQ(started(backend, p, leblanc)->advance(6.0, -1, 0, {}, {}), Stop::failed);

  p.positivity = Positivity::automatic;
  const auto solver = started(backend, p, leblanc);
  const ProfilingCounters before = counted();
  EXPECT_EQ(solver->advance(6.0, -1, 0, {}, {}), Stop::target);
  const RestartState end = solver->restart_state();
  EXPECT_GT(end.redone, 0);
  EXPECT_LT(end.redone, end.step / 10);
  EXPECT_GT(end.limited_faces, 0);
  EXPECT_GT(solver->limited_cells(), 0);
  EXPECT_LE(solver->limited_cells(), 100);
  if (!on_device) {
    EXPECT_LT((counted() - before).kernel_launches, (end.step + end.redone) * 4 + 10);
  }

  reference::GasRun run = reference_from(leblanc);
  reference::advance(run, p, 6.0);
  EXPECT_FALSE(run.failed);
  EXPECT_EQ(end.redone, run.redone_steps);
  EXPECT_EQ(end.step, run.steps);
  EXPECT_LT(distance(download(*solver, p), state_of(run)), 1e-6);
}

TEST(GasPositivity, AutomaticLimiterTurnsOffAgain) {
  // Waves fill a near vacuum within some steps: after the last failure come 100 limited steps, then none.
  Parameters p;
  p.cells = 100;
  p.weno = Weno::teno5;
  p.left = p.right = Boundary::periodic;
  const GasState state = random_state(p, 3, extreme);
  const auto solver = started(backend, p, state);
  EXPECT_EQ(solver->advance(never, 2000, 0, {}, {}), Stop::pause);
  const RestartState later = solver->restart_state();
  EXPECT_GT(later.redone, 0);
  EXPECT_EQ(later.limited, 0);
  EXPECT_EQ(later.limited_left, 0);
}

TEST(GasPositivity, RunsOnEightCells) {
  Parameters p = sod(Positivity::on);
  p.cells = 8;
  const auto solver = started(backend, p, sod_state(p));
  EXPECT_EQ(solver->advance(1.0, -1, 1, {}, {}), Stop::target);
  const HistoryRow row = solver->totals();
  EXPECT_NEAR(row.mass, 1.125, 1e-13);
  EXPECT_NEAR(row.energy, 2.75, 1e-13);
}

}  // namespace
}  // namespace drogue::gas
