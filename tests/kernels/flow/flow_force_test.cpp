#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/flow/flow_solver.hpp"
#include "kernels/reference/flow/momentum.hpp"
#include "tests/support/flow_case.hpp"

// Force field of other kernels: its effect on a step, and failures that it causes.

namespace drogue::flow {

// In the library: the tested code is that of the programs.
extern template class FlowSolver<DROGUE_TEST_SPACE>;

namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests
using Space = DROGUE_TEST_SPACE;
using reference::GridIndex;

/// Solver of the caller's type, with its instance.
struct TypedCase {
  explicit TypedCase(const Parameters& p) : parameters(p), domain(p), solver(instance, p) {
    const StaggeredField u = random_field(domain, 1);
    for (std::size_t c = 0; c < 3; ++c) solver.upload(static_cast<StateField>(c), u[c]);
    solver.start();
  }
  [[nodiscard]] StaggeredField velocity() {
    StaggeredField u = domain.zero_field();
    for (std::size_t c = 0; c < 3; ++c) solver.download(static_cast<StateField>(c), u[c]);
    return u;
  }
  /// Sets the force on all faces inside, N/m^3.
  void set_force(const StaggeredField& force) {
    const MacGrid& g = solver.grid();
    std::vector<double> values(solver.force().extent(0), 0.0);
    domain.for_each_face([&](std::size_t c, const GridIndex& face) {
      values[static_cast<std::size_t>(static_cast<std::int64_t>(c) * g.component +
                                      g.offset(face[0], face[1], face[2]))] = force[c][domain.at(c, face)];
    });
    device::copy_in(instance.space(), solver.force(), values.data(), values.size());
    instance.space().fence();
  }

  Parameters parameters;
  FlowDomain domain;
  device::Instance<Space> instance{4};
  FlowSolver<Space> solver;
};

Parameters forced_box(const std::array<int, 3>& cells) {
  Parameters p = periodic_box(cells);
  p.density = 1.6;
  p.external_force = true;
  p.fixed_dt = 0.01;
  return p;
}

TEST(FlowForce, ActsForTheWholeStepWithoutExtrapolation) {
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
    Parameters p = forced_box({7, 6, 5});
    p.time_scheme = time;
    TypedCase forced(p), free(p);
    // A gradient-free force moves the mean of each component alone.
    StaggeredField force = forced.domain.zero_field();
    for (std::size_t c = 0; c < 3; ++c)
      for (double& value : force[c]) value = 0.4 * static_cast<double>(c + 1);
    forced.set_force(force);
    for (int step = 1; step <= 3; ++step) {
      ASSERT_EQ(forced.solver.advance(endless, step, {}), Stop::pause);
      ASSERT_EQ(free.solver.advance(endless, step, {}), Stop::pause);
      const Totals totals = forced.solver.totals(), other = free.solver.totals();
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(totals.momentum[c] - other.momentum[c], 0.4 * (c + 1) * 0.01 * step, 1e-14);
      if (step == 1) forced.set_force(force);  // keeps its values, so that setting them again changes nothing
    }
  }
}

TEST(FlowForce, AddsItsProjectionToTheFirstStep) {
  const Parameters p = forced_box({8, 1, 6});
  TypedCase forced(p), free(p);
  const StaggeredField force = random_field(forced.domain, 3);
  forced.set_force(force);
  ASSERT_EQ(forced.solver.advance(endless, 1, {}), Stop::pause);
  ASSERT_EQ(free.solver.advance(endless, 1, {}), Stop::pause);
  StaggeredField expected = force;
  reference::project(forced.domain, expected, 1.0);
  const StaggeredField with = forced.velocity(), without = free.velocity();
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < expected[c].size(); ++i)
      EXPECT_NEAR(with[c][i] - without[c][i], p.fixed_dt / p.density * expected[c][i], 1e-14);
}

TEST(FlowForce, NonFiniteForceFailsAtItsFirstCellAndKeepsTheState) {
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3})
    for (const double bad : {std::nan(""), 1e200}) {
      Parameters p = forced_box({9, 8, 7});
      p.time_scheme = time;
      TypedCase flow(p);
      ASSERT_EQ(flow.solver.advance(endless, 4, {}), Stop::pause);
      const StaggeredField before = flow.velocity();
      StaggeredField force = flow.domain.zero_field();
      force[2][flow.domain.at(2, {3, 4, 5})] = bad;
      flow.set_force(force);
      ASSERT_EQ(flow.solver.advance(endless, 10, {}), Stop::failed);
      const StepFailure failure = flow.solver.failure();
      EXPECT_EQ(failure.reason, FailureReason::not_finite);
      EXPECT_EQ(failure.step, 5);
      EXPECT_EQ(failure.index, static_cast<std::int64_t>(flow.domain.cell_at({3, 4, 4})));
      EXPECT_EQ(flow.solver.progress().step, 4);
      EXPECT_EQ(flow.velocity(), before);
      EXPECT_EQ(flow.solver.advance(endless, 10, {}), Stop::failed);
    }
}

TEST(FlowForce, IsEmptyUnlessRequested) {
  TypedCase flow(periodic_box({8, 7, 6}));
  EXPECT_EQ(flow.solver.force().extent(0), 0U);
}

}  // namespace
}  // namespace drogue::flow
