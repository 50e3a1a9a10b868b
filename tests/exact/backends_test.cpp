#include <gtest/gtest.h>

#include <string>

#include "kernels/device/runtime.hpp"
#include "tests/support/cuda_device.hpp"
#include "tests/support/gas_state.hpp"
#include "tests/support/in_child.hpp"

// Bitwise equality of all backends and numbers of threads, on meshes with work for four threads. Kokkos can
// be initialised once per process, so each run is a child process that writes its bytes to a file.

namespace drogue {
namespace {

using testing::GasState;
using testing::has_cuda_device;
using testing::in_child;

struct Runner {
  device::Backend backend;
  int threads;
  gas::Driver driver = gas::Driver::automatic;
};

template <class T>
void append(std::string& bytes, const T* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values),
               count * sizeof(T));  // NOLINT: compares bits
}

enum class Count : std::size_t { stop, step, redone, limited_faces, cell };

/// All results of a run: counters, rows, totals, state, restart state and marks of the limiter.
std::string run_bytes(const Runner& runner, gas::Parameters p, const GasState& state, std::int64_t steps) {
  p.driver = runner.driver;
  const auto solver = testing::started(runner.backend, p, state);
  std::string rows;
  const auto keep = [&](const gas::HistoryRow& row) {
    for (const double value : {row.time, row.dt, row.mass, row.momentum, row.energy, row.max_speed})
      append(rows, &value, 1);
    append(rows, row.boundary, 3);
  };
  const gas::Stop stop = solver->advance(1e9, steps, 10, keep, {});
  keep(solver->totals());
  const gas::RestartState r = solver->restart_state();
  std::string bytes;
  for (const std::int64_t count : {static_cast<std::int64_t>(stop), r.step, r.redone, r.limited_faces,
                                   solver->failure().index, static_cast<std::int64_t>(r.limited_left)})
    append(bytes, &count, 1);
  bytes += rows;
  for (const auto& values : testing::download(*solver, p)) append(bytes, values.data(), values.size());
  append(bytes, r.speed, 3);
  append(bytes, r.boundary[0], 6);
  append(bytes, r.compensation[0], 6);
  std::vector<std::uint8_t> limited_cells(
      p.positivity == gas::Positivity::off ? 0 : static_cast<std::size_t>(p.cells));
  solver->download_limited_cells(0, limited_cells);
  append(bytes, limited_cells.data(), limited_cells.size());
  return bytes;
}

std::vector<Runner> runners() {
  std::vector<Runner> all = {{device::Backend::serial, 1}};
  for (const device::Backend backend : device::compiled_backends()) {
    if (backend == device::Backend::openmp)
      for (const int threads : {1, 2, 4}) all.push_back({backend, threads});
    if (backend == device::Backend::cuda && has_cuda_device())
      for (const auto driver : {gas::Driver::plain, gas::Driver::graph, gas::Driver::persistent})
        all.push_back({backend, 1, driver});
  }
  return all;
}

std::int64_t count(const std::string& bytes, Count which) {
  std::int64_t value = -1;
  bytes.copy(reinterpret_cast<char*>(&value), sizeof(value), static_cast<std::size_t>(which) * sizeof(value));
  return value;
}

/// Runs on all backends; returns the bytes of the serial backend.
std::string expect_same_bits(const gas::Parameters& p, const GasState& state, std::int64_t steps) {
  std::string serial;
  for (const Runner& runner : runners()) {
    const std::string bytes = in_child([&] {
      const device::Runtime runtime({"--kokkos-num-threads=" + std::to_string(runner.threads)});
      return run_bytes(runner, p, state, steps);
    });
    EXPECT_GT(bytes.size(), static_cast<std::size_t>(3 * 8 * p.cells));
    if (serial.empty()) serial = bytes;
    EXPECT_TRUE(bytes == serial) << device::name(runner.backend) << " with " << runner.threads
                                 << " threads, driver " << static_cast<int>(runner.driver);
  }
  return serial;
}

gas::Parameters parameters(std::int64_t cells, gas::Weno weno, gas::Splitting splitting,
                           gas::Positivity positivity) {
  gas::Parameters p;
  p.cells = cells;
  p.weno = weno;
  p.splitting = splitting;
  p.positivity = positivity;
  return p;
}

TEST(GasExact, BackendsAgreeOnAShockTube) {
  const auto p = parameters(10000, gas::Weno::z, gas::Splitting::lf_stencil, gas::Positivity::automatic);
  const std::string serial =
      expect_same_bits(p, testing::riemann_state(p, 0.0, {1, 0, 1}, {0.125, 0, 0.1}), 60);
  EXPECT_EQ(count(serial, Count::step), 60);
}

TEST(GasExact, BackendsAgreeWithGlobalSpeedsAndLimiter) {
  auto p = parameters(8199, gas::Weno::js, gas::Splitting::lf_global, gas::Positivity::on);
  p.face_average = gas::FaceAverage::roe;
  p.time_scheme = gas::TimeScheme::ssprk43;
  const std::string serial = expect_same_bits(p, testing::random_state(p, 1, testing::extreme), 20);
  EXPECT_GT(count(serial, Count::limited_faces), 0);
}

// If several steps share a launch, an active limiter ends the launch.
TEST(GasExact, BackendsAgreeOnTheAutomaticLimiterWithinOneLaunch) {
  auto p = parameters(3000, gas::Weno::z, gas::Splitting::lf_stencil, gas::Positivity::automatic);
  p.left = gas::Boundary::reflecting;
  const std::string serial = expect_same_bits(p, testing::random_state(p, 6, testing::extreme), 240);
  EXPECT_GT(count(serial, Count::redone), 0);
  EXPECT_EQ(count(serial, Count::step), 240);
}

TEST(GasExact, BackendsAgreeOnStepsRepeatedByTheAutomaticLimiter) {
  auto p = parameters(6000, gas::Weno::teno5, gas::Splitting::lf_single, gas::Positivity::automatic);
  p.left = p.right = gas::Boundary::periodic;
  p.face_average = gas::FaceAverage::conserved;
  const std::string serial = expect_same_bits(p, testing::random_state(p, 2, testing::extreme), 40);
  EXPECT_GT(count(serial, Count::redone), 0);
  EXPECT_GT(count(serial, Count::limited_faces), 0);
}

TEST(GasExact, BackendsAgreeInSplitPrecision) {
  auto p = parameters(5001, gas::Weno::m, gas::Splitting::lf_global, gas::Positivity::automatic);
  p.precision = gas::Precision::split;
  p.left = gas::Boundary::reflecting;
  const std::string serial = expect_same_bits(p, testing::random_state(p, 3, testing::rough), 40);
  EXPECT_EQ(count(serial, Count::step), 40);
}

TEST(GasExact, BackendsFailInTheSameCell) {
  auto p = parameters(7000, gas::Weno::z, gas::Splitting::lf_stencil, gas::Positivity::off);
  p.weno_power = 2;
  p.cfl = 3.0;
  const std::string serial = expect_same_bits(p, testing::random_state(p, 4, testing::extreme), 1000);
  EXPECT_EQ(count(serial, Count::stop), static_cast<std::int64_t>(gas::Stop::failed));
  EXPECT_GE(count(serial, Count::cell), 0);
}

// One kernel per step and one kernel per stage are the same method, with and without the limiter.
TEST(GasExact, FusedStepEqualsSeparateStages) {
  using gas::Boundary;
  unsigned seed = 5;
  bool limited_cells = false;
  for (const gas::Weno weno : {gas::Weno::js, gas::Weno::z, gas::Weno::m, gas::Weno::teno5})
    for (const std::int64_t cells : {8, 23, 300, 1001})
      for (const auto time : {gas::TimeScheme::ssprk3, gas::TimeScheme::ssprk43})
        for (const auto& [left, right] : {std::pair{Boundary::periodic, Boundary::periodic},
                                          std::pair{Boundary::outflow, Boundary::reflecting},
                                          std::pair{Boundary::reflecting, Boundary::outflow}}) {
          auto p = parameters(cells, weno, gas::Splitting::lf_stencil, gas::Positivity::off);
          p.time_scheme = time;
          p.left = left, p.right = right;
          p.precision = ++seed % 3 == 0 ? gas::Precision::split : gas::Precision::full;
          p.block = seed % 2 == 0 ? 32 : 0;
          p.cfl = 0.2;
          p.positivity = seed % 5 < 2 ? gas::Positivity::on : gas::Positivity::off;
          const bool limits = p.positivity == gas::Positivity::on;
          const GasState state = testing::random_state(
              p, seed, limits ? testing::extreme : testing::GasRange{0.9, 1.1, 0.9, 1.1, 0.1});
          for (const Runner& runner : runners()) {
            if (runner.threads == 2 || runner.threads == 4) continue;
            Runner stages = runner;
            stages.driver = gas::Driver::stages;
            const std::string bytes = in_child([&] {
              const device::Runtime runtime({"--kokkos-num-threads=1"});
              const std::string fused = run_bytes(runner, p, state, 9);
              return fused + (fused == run_bytes(stages, p, state, 9) ? "=" : "!");
            });
            EXPECT_EQ(count(bytes, Count::step), 9);
            limited_cells = limited_cells || count(bytes, Count::limited_faces) > 0;
            EXPECT_EQ(bytes.back(), '=')
                << device::name(runner.backend) << ", driver " << static_cast<int>(runner.driver) << ", "
                << cells << " cells, seed " << seed;
          }
        }
  EXPECT_TRUE(limited_cells);
}

}  // namespace
}  // namespace drogue
