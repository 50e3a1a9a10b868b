// ctest-label: exact
#include <gtest/gtest.h>

#include <string>

#include "tests/support/backend.hpp"
#include "tests/support/gas_state.hpp"

// Complete solvers against the serial reference on random states, and the transfer of their state.

namespace drogue::gas {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests

constexpr const auto& backend = testing::tested_backend;

#if defined(DROGUE_EXACT)
constexpr bool exact_arithmetic = true;
#else
constexpr bool exact_arithmetic = false;
#endif

/// State after about ten steps, and the state of the reference.
struct Comparison {
  GasState state, expected;
  RestartState restart;
  reference::GasRun run;
};

Comparison compare_with_reference(const Parameters& p, const GasState& state, double end_time) {
  const auto solver = started(backend, p, state);
  EXPECT_EQ(solver->advance(end_time, -1, 0, {}, {}), Stop::target);
  reference::GasRun run = reference_from(state);
  reference::advance(run, p, end_time);
  EXPECT_FALSE(run.failed);
  return {download(*solver, p), state_of(run), solver->restart_state(), run};
}

/// Combination number n of scheme, splitting, average and time scheme, with varying boundaries, mesh and
/// block.
Parameters combination(int n, std::string& text) {
  constexpr std::int64_t meshes[] = {8, 9, 127, 128, 129, 257};
  constexpr int blocks[] = {0, 32, 64, 128};
  constexpr Boundary ends[][2] = {{Boundary::outflow, Boundary::reflecting},
                                  {Boundary::periodic, Boundary::periodic},
                                  {Boundary::reflecting, Boundary::outflow},
                                  {Boundary::outflow, Boundary::outflow},
                                  {Boundary::reflecting, Boundary::reflecting}};
  const int scheme = n % 5, splitting = n / 5 % 3, average = n / 15 % 3, time = n / 45;
  Parameters p;
  p.weno = scheme == 4 ? Weno::z : static_cast<Weno>(scheme);
  p.weno_power = scheme == 4 ? 2 : 1;
  p.splitting = static_cast<Splitting>(splitting);
  p.face_average = static_cast<FaceAverage>(average);
  p.time_scheme = time == 0 ? TimeScheme::ssprk3 : TimeScheme::ssprk43;
  p.positivity = Positivity::off;
  p.gamma = n % 2 == 0 ? 1.4 : 5.0 / 3.0;
  p.cells = meshes[(n + n / 6) % 6];
  p.block = blocks[n % 4];
  p.left = ends[(n + n / 5) % 5][0];
  p.right = ends[(n + n / 5) % 5][1];
  p.x_min = 0.25;
  p.ramp_steps = 4;
  text = "combination " + std::to_string(n) + " of " + std::to_string(p.cells) + " cells";
  return p;
}

// ctest-label: smoke
TEST(GasSolver, MatchesTheReference) {
  for (int n = 0; n < 90; ++n) {
    std::string text;
    const Parameters p = combination(n, text);
    const GasState state = random_state(p, static_cast<unsigned>(n), rough);
    const Comparison got = compare_with_reference(p, state, time_of(p, state, 8));
    EXPECT_GE(got.restart.step, 9) << text;
    EXPECT_EQ(got.restart.step, got.run.steps) << text;
    EXPECT_LT(distance(got.state, got.expected), 1e-12) << text;
  }
}

TEST(GasSolver, MatchesTheReferenceWithTheLimiter) {
  std::int64_t limited_faces = 0, redone = 0;
  for (int n = 0; n < 90; ++n) {
    std::string text;
    Parameters p = combination(n, text);
    p.positivity = n % 2 == 0 ? Positivity::on : Positivity::automatic;
    const GasState state = random_state(p, static_cast<unsigned>(n), extreme);
    const Comparison got = compare_with_reference(p, state, time_of(p, state, 4));
    EXPECT_EQ(got.restart.step, got.run.steps) << text;
    EXPECT_EQ(got.restart.limited_faces, got.run.limited_faces) << text;
    EXPECT_EQ(got.restart.redone, got.run.redone_steps) << text;
    // A pressure of 1e-5 of the total energy loses five digits, and so do all quantities derived from it.
    EXPECT_LT(distance(got.state, got.expected), 1e-8) << text;
    limited_faces += got.restart.limited_faces;
    redone += got.restart.redone;
  }
  EXPECT_GT(limited_faces, 1000);
  EXPECT_GT(redone, 20);
}

TEST(GasSolver, SplitPrecisionStaysCloseToTheReference) {
  for (int n = 0; n < 90; ++n) {
    std::string text;
    Parameters p = combination(n, text);
    p.precision = Precision::split;
    // A wave instead of noise: TENO5 keeps or drops a stencil, and must decide equally in both precisions.
    const double length = p.x_max - p.x_min;
    const GasState state = make_state(p, [&](std::int64_t i) {
      const double s = std::sin(6.283 * (centre(p, i) - p.x_min) / length);
      return reference::Primitive{1 + 0.2 * s, 0.3 * s, 1 + 0.3 * s};
    });
    const Comparison got = compare_with_reference(p, state, time_of(p, state, 8));
    const double error = distance(got.state, got.expected);
    EXPECT_LT(error, p.weno == Weno::teno5 ? 1e-3 : 1e-6) << text;
    EXPECT_GT(error, 0.0) << text;
  }
}

TEST(GasSolver, BaselineMatchesTheReferenceOfTheDissertationsScheme) {
  Parameters p;
  p.cells = 100;
  p.ramp_steps = 4;
  const GasState state = random_state(p, 5, rough);
  const auto solver = create_baseline_solver(backend, p);
  solver->upload(0, fields(state));
  solver->start();
  const double end_time = time_of(p, state, 8);
  EXPECT_EQ(solver->advance(end_time, -1, 0, {}, {}), Stop::target);
  p.weno = Weno::js;
  p.face_average = FaceAverage::conserved;
  p.splitting = Splitting::lf_global;
  p.positivity = Positivity::off;
  reference::GasRun run = reference_from(state);
  reference::advance(run, p, end_time);
  EXPECT_EQ(solver->restart_state().step, run.steps);
  EXPECT_LT(distance(download(*solver, p), state_of(run)), 1e-12);
  const PhaseTimes phase_times = solver->phase_times();
  EXPECT_GT(phase_times.h2d, 0.0);
  EXPECT_GT(phase_times.compute, 0.0);
  EXPECT_GT(phase_times.d2h, 0.0);
}

TEST(GasSolver, BaselineResultIsIndependentOfMemoryAndTeamSize) {
  Parameters p;
  p.cells = 1000;
  const GasState start = random_state(p, 6, rough);
  GasState first;
  for (const bool pinned : {false, true})
    for (const int block : {0, 32, 512}) {
      p.pinned = pinned;
      p.block = block;
      const auto solver = create_baseline_solver(backend, p);
      solver->upload(0, fields(start));
      solver->start();
      EXPECT_EQ(solver->advance(1.0, 20, 0, {}, {}), Stop::pause);
      const GasState state = download(*solver, p);
      if (first[0].empty()) first = state;
      EXPECT_TRUE(exact_arithmetic ? same_bits(state, first) : distance(state, first) < 1e-12)
          << "block " << block << (pinned ? ", pinned" : ", pageable");
    }
}

TEST(GasSolver, ResultIsIndependentOfTheTileSize) {
  for (const auto& [positivity, splitting] :
       {std::pair{Positivity::off, Splitting::lf_global}, std::pair{Positivity::on, Splitting::lf_global},
        std::pair{Positivity::off, Splitting::lf_stencil}})
    for (const std::int64_t cells : {31, 257, 1000}) {
      Parameters p;
      p.cells = cells;
      p.positivity = positivity;
      p.splitting = splitting;
      p.driver = Driver::graph;  // its tiles have the size of a block
      const GasState start = random_state(p, 11, positivity == Positivity::on ? extreme : rough);
      GasState first;
      // The largest teams of a device have more threads than slots.
      for (const int block : {32, 64, 96, 128, 384, 512}) {
        p.block = block;
        const auto solver = started(backend, p, start);
        EXPECT_EQ(solver->advance(1.0, 20, 0, {}, {}), Stop::pause);
        const GasState state = download(*solver, p);
        if (first[0].empty()) first = state;
        if (exact_arithmetic)
          EXPECT_TRUE(same_bits(state, first)) << cells << " cells, block " << block;
        else
          EXPECT_LT(distance(state, first), 1e-12) << cells << " cells, block " << block;
      }
    }
}

TEST(GasSolver, TotalsSumEveryCell) {
  for (const std::int64_t cells : {8, 63, 64, 65, 4096, 4097, 300'001}) {
    Parameters p;
    p.cells = cells;
    p.x_max = static_cast<double>(cells);
    p.x_min = 0.0;
    // Whole numbers: every order of additions has the same exact result.
    GasState state;
    double sum[3] = {};
    for (std::int64_t i = 0; i < cells; ++i) {
      const double u[3] = {static_cast<double>(1 + i % 7), static_cast<double>(i % 5 - 1),
                           static_cast<double>(100 + i % 11)};
      for (std::size_t k = 0; k < 3; ++k) {
        state[k].push_back(u[k]);
        sum[k] += u[k];
      }
    }
    const auto solver = started(backend, p, state);
    const HistoryRow row = solver->totals();
    EXPECT_EQ(row.mass, sum[0]) << cells;
    EXPECT_EQ(row.momentum, sum[1]) << cells;
    EXPECT_EQ(row.energy, sum[2]) << cells;
    double fastest = 0.0;
    for (const reference::Conserved& u : reference_from(state).state)
      fastest =
          std::max({fastest, reference::wave_speeds(u, p.gamma)[0], reference::wave_speeds(u, p.gamma)[2]});
    EXPECT_NEAR(row.max_speed, fastest, 1e-14 * fastest);
  }
}

TEST(GasSolver, TotalsRestartWithASecondStart) {
  Parameters p;
  p.cells = 64;
  const GasState state = random_state(p, 1, rough);
  const auto solver = started(backend, p, state);
  const HistoryRow first = solver->totals();
  EXPECT_EQ(solver->advance(1.0, 5, 1, {}, {}), Stop::pause);
  EXPECT_NE(solver->totals().mass, first.mass);
  solver->upload(0, fields(state));
  solver->start();
  const HistoryRow again = solver->totals();
  EXPECT_EQ(again.mass, first.mass);
  EXPECT_EQ(again.energy, first.energy);
  EXPECT_EQ(again.step, 0);
}

TEST(GasSolver, SnapshotsAreUnaffectedByLaterSteps) {
  Parameters p;
  p.cells = 1000;
  const auto solver = started(backend, p, random_state(p, 2, rough));
  for (const std::int64_t pause : {5, 9}) {
    EXPECT_EQ(solver->advance(1.0, pause, 0, {}, {}), Stop::pause);
    const GasState then = download(*solver, p);
    solver->begin_snapshot();
    EXPECT_EQ(solver->advance(1.0, pause + 2, 0, {}, {}), Stop::pause);
    const ConstConservedFields snapshot = solver->finish_snapshot();
    const auto copy = [](std::span<const double> values) {
      return std::vector<double>(values.begin(), values.end());
    };
    EXPECT_TRUE(same_bits({copy(snapshot.rho), copy(snapshot.momentum), copy(snapshot.energy)}, then));
    EXPECT_FALSE(same_bits(download(*solver, p), then));
  }
}

bool same_progress(const RestartState& a, const RestartState& b) {
  return a.time == b.time && a.step == b.step && a.limited == b.limited && a.limited_left == b.limited_left &&
         a.dt_scale == b.dt_scale && std::memcmp(a.speed, b.speed, sizeof(a.speed)) == 0 &&
         std::memcmp(a.boundary, b.boundary, sizeof(a.boundary)) == 0 && a.redone == b.redone &&
         a.limited_faces == b.limited_faces && a.last_dt == b.last_dt && a.dt_min == b.dt_min &&
         a.dt_max == b.dt_max;
}

/// Runs to step 60 at once, with pauses, and in a new solver from the restart state at step 23.
TEST(GasSolver, RestartContinuesBitForBit) {
  for (int n = 0; n < 90; n += 7) {
    std::string text;
    Parameters p = combination(n, text);
    p.positivity = static_cast<Positivity>(n % 3);
    p.ramp_steps = 30;
    const GasState state = random_state(p, static_cast<unsigned>(n), n % 3 == 0 ? rough : extreme);
    const auto whole = started(backend, p, state);
    ASSERT_EQ(whole->advance(100.0, 60, 0, {}, {}), Stop::pause) << text;

    const auto parts = started(backend, p, state);
    ASSERT_EQ(parts->advance(100.0, 23, 0, {}, {}), Stop::pause) << text;
    const auto resumed = create_solver(backend, p);
    std::vector<std::uint8_t> limited_cells(
        p.positivity == Positivity::off ? 0 : static_cast<std::size_t>(p.cells));
    parts->download_limited_cells(0, limited_cells);
    resumed->upload(0, fields(download(*parts, p)));
    resumed->upload_limited_cells(0, limited_cells);
    resumed->restore(parts->restart_state());
    for (const auto& solver : {parts.get(), resumed.get()}) {
      ASSERT_EQ(solver->advance(100.0, 41, 0, {}, {}), Stop::pause) << text;
      ASSERT_EQ(solver->advance(100.0, 60, 0, {}, {}), Stop::pause) << text;
      EXPECT_TRUE(same_bits(download(*solver, p), download(*whole, p))) << text;
      EXPECT_TRUE(same_progress(solver->restart_state(), whole->restart_state())) << text;
      EXPECT_EQ(solver->limited_cells(), whole->limited_cells()) << text;
      EXPECT_EQ(solver->totals().energy, whole->totals().energy) << text;
    }
  }
}

TEST(GasSolver, RowsContinueAfterARestart) {
  Parameters p;
  p.cells = 100;
  const auto first = started(backend, p, random_state(p, 4, rough));
  ASSERT_EQ(first->advance(10.0, 37, 0, {}, {}), Stop::pause);
  const auto second = create_solver(backend, p);
  second->upload(0, fields(download(*first, p)));
  second->restore(first->restart_state());
  std::vector<std::int64_t> steps;
  ASSERT_EQ(second->advance(10.0, 65, 10, [&](const HistoryRow& row) { steps.push_back(row.step); }, {}),
            Stop::pause);
  EXPECT_EQ(steps, (std::vector<std::int64_t>{40, 50, 60}));
}

TEST(GasSolver, RejectsParametersOutOfRange) {
  const auto refused = [](auto&& change) {
    Parameters p;
    change(p);
    EXPECT_THROW(static_cast<void>(create_solver(backend, p)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(create_baseline_solver(backend, p)), std::invalid_argument);
  };
  refused([](Parameters& p) { p.cells = 7; });
  refused([](Parameters& p) { p.cells = (std::int64_t{1} << 28) + 1; });
  refused([](Parameters& p) { p.gamma = 1.0; });
  refused([](Parameters& p) { p.x_max = p.x_min; });
  refused([](Parameters& p) { p.left = Boundary::periodic; });
  refused([](Parameters& p) { p.weno_power = 3; });
  refused([](Parameters& p) { p.cfl = 0.0; });
  refused([](Parameters& p) { p.cfl = std::nan(""); });
  refused([](Parameters& p) { p.block = 16; });
  refused([](Parameters& p) { p.block = 1056; });
}

}  // namespace
}  // namespace drogue::gas
