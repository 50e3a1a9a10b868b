#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/support/flow_case.hpp"
#if defined(DROGUE_HAVE_HYPRE)
#include "tests/support/hypre_session.hpp"
#endif
#include "tests/support/profiled.hpp"

// Launches, fences, copies and allocations of steps with options that the standard step lacks.

namespace drogue::flow {
namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests
using device::ProfilingCounters;

constexpr const auto& backend = testing::tested_backend;
const bool on_device = backend == device::Backend::cuda;

/// Box with an inflow and an outflow along z, and slip sides.
Parameters tunnel() {
  Parameters p = periodic_box({9, 8, 7});
  p.viscosity = 0.01;
  for (std::size_t side = 0; side < 4; ++side) p.boundary[side].kind = BoundaryKind::slip;
  p.boundary[4].kind = BoundaryKind::inflow;
  p.boundary[4].velocity = {0.0, 0.0, 1.0};
  p.boundary[5].kind = BoundaryKind::outflow;
  return p;
}

/// Launches, fences, allocations and copies between two readings of the counters.
ProfilingCounters difference(const ProfilingCounters& later, const ProfilingCounters& earlier) {
  ProfilingCounters between = later;
  between.kernel_launches -= earlier.kernel_launches;
  between.fences -= earlier.fences;
  between.allocations -= earlier.allocations;
  between.copies -= earlier.copies;
  between.h2d_bytes -= earlier.h2d_bytes;
  between.d2h_bytes -= earlier.d2h_bytes;
  return between;
}

/// Counters of 50 steps, without those of an advance itself.
ProfilingCounters cost_of_50_steps(Solver& solver) {
  const auto cost = [&](std::int64_t steps) {
    const std::int64_t now = solver.progress().step;
    const ProfilingCounters before = profiled();
    EXPECT_EQ(solver.advance(endless, now + steps, {}), Stop::pause);
    return difference(profiled(), before);
  };
  const ProfilingCounters few = cost(10);
  return difference(cost(60), few);
}

/// Option of a step and the kernels that it adds to a stage on a host.
struct Option {
  std::string name;
  std::function<void(Parameters&)> apply;
  std::int64_t kernels;
};

std::vector<Option> options() {
  const auto inflow_in_time = [](Parameters& p) {
    device::ExpressionBuilder builder;
    builder.push("t");
    p.boundary[4].velocity_expressions.assign(3, builder.program());
    p.horizon = 1.0;
  };
  // Instead of six transforms and a scaling, four products and the systems along z.
  return {{"products with matrices",
           [](Parameters& p) { p.pressure_solver = PressureSolver::diagonalization; }, -2},
          {"Smagorinsky", [](Parameters& p) { p.turbulence = Turbulence::smagorinsky; }, 2},
          {"Vreman", [](Parameters& p) { p.turbulence = Turbulence::vreman; }, 2},
          {"external force", [](Parameters& p) { p.external_force = true; }, 0},
          {"inflow in time", inflow_in_time, 1},
          // A table on each side, and the net inflow.
          {"equal flows in and out in time",
           [inflow_in_time](Parameters& p) {
             inflow_in_time(p);
             p.boundary[5] = p.boundary[4];
           },
           3}};
}

TEST(FlowCounters, OptionsOfAStepAddOnlyTheirKernels) {
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3})
    for (const Option& option : options()) {
      Parameters p = tunnel();
      p.time_scheme = time;
      // A device has transforms of periodic axes alone, and one launch whatever the solver is.
      if (!on_device) p.pressure_solver = PressureSolver::fft;
      option.apply(p);
      const auto solver = started(backend, p, random_field(FlowDomain(p), 4));
      ASSERT_EQ(solver->advance(endless, 1, {}), Stop::pause) << option.name;
      const ProfilingCounters cost = cost_of_50_steps(*solver);
      EXPECT_EQ(cost.fences, 0) << option.name;
      EXPECT_EQ(cost.allocations, 0) << option.name;
      EXPECT_EQ(cost.copies, 0) << option.name;
      EXPECT_EQ(cost.h2d_bytes + cost.d2h_bytes, 0) << option.name;
      // Momentum, boundary faces, divergence, six transforms, scaling, correction and ghost cells.
      const std::int64_t stages = time == TimeScheme::ab2 ? 1 : 3;
      EXPECT_LE(cost.kernel_launches, 50 * (on_device ? 1 : stages * (12 + option.kernels) + 1))
          << option.name;
    }
}

#if defined(DROGUE_HAVE_HYPRE)
TEST(FlowCounters, IterativePressureSolverCopiesTwoFieldsInEachStageOnADevice) {
  testing::start_hypre();
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
    Parameters p = tunnel();
    p.time_scheme = time;
    p.pressure_solver = PressureSolver::hypre_pfmg;
    const FlowDomain domain(p);
    const auto solver = started(backend, p, random_field(domain, 4));
    ASSERT_EQ(solver->advance(endless, 1, {}), Stop::pause);
    const ProfilingCounters cost = cost_of_50_steps(*solver);
    const std::int64_t solves = 50 * (time == TimeScheme::ab2 ? 1 : 3);
    const std::int64_t bytes = 9 * 8 * 7 * static_cast<std::int64_t>(sizeof(double));
    EXPECT_EQ(cost.fences, solves * (on_device ? 2 : 1));
    EXPECT_EQ(cost.copies, on_device ? 2 * solves : 0);
    EXPECT_EQ(cost.d2h_bytes, on_device ? solves * bytes : 0);
    EXPECT_EQ(cost.h2d_bytes, on_device ? solves * bytes : 0);
    EXPECT_EQ(cost.allocations, 0);
    // Momentum, boundary faces, divergence, correction and ghost cells; no transforms.
    EXPECT_LE(cost.kernel_launches, solves * 5 + 50);
  }
}
#endif

TEST(FlowCounters, DestructionReleasesTheMemory) {
  constexpr std::int64_t scratch = 1 << 20;  // bytes that the backend itself keeps
  Parameters p = tunnel();
  p.cells = {32, 32, 32};
  const std::int64_t before = profiled().device_bytes;
  auto solver = started(backend, p, FlowDomain(p).zero_field());
  ASSERT_GT(profiled().device_bytes - before, 2 * scratch);
  solver.reset();
  EXPECT_LE(profiled().device_bytes - before, scratch);
}

}  // namespace
}  // namespace drogue::flow
