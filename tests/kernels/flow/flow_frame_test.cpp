#include <gtest/gtest.h>

#include "tests/support/typed_flow.hpp"

// Changes of the frame of reference.

namespace drogue::flow {

// In the library: the tested code is that of the programs.
extern template class FlowSolver<DROGUE_TEST_SPACE>;

namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests
using reference::GridIndex;

TEST(FlowFrame, RatesOnOutflowsChangeByUpwindDifferences) {
  Parameters p = periodic_box({9, 8, 7});
  p.boundary[0].kind = p.boundary[1].kind = BoundaryKind::outflow;
  p.time_scheme = TimeScheme::ab2;
  TypedFlow<DROGUE_TEST_SPACE> grid(p, 21);
  ASSERT_EQ(grid.solver.advance(endless, 1, {}), Stop::pause);
  const FlowDomain& domain = grid.domain;
  const StaggeredField u = grid.arrays(StateField::velocity_x), old = grid.arrays(StateField::rate_x);
  constexpr double shift = 0.3;
  grid.solver.change_frame({shift, 0.0, 0.0});
  const StaggeredField moved = grid.arrays(StateField::velocity_x), rate = grid.arrays(StateField::rate_x);
  const double h = domain.spacing(0);
  int outgoing = 0, incoming = 0;
  const auto at = [&](const StaggeredField& field, int i, const GridIndex& face) {
    return field[0][domain.at(0, {i, face[1], face[2]})];
  };
  domain.for_each_face([&](std::size_t c, const GridIndex& face) {
    const std::size_t here = domain.at(c, face);
    EXPECT_NEAR(moved[c][here], u[c][here] - (c == 0 ? shift : 0.0), 1e-15);
    if (c != 0) return;
    const int i = face[0], n = p.cells[0];
    double slope = 0.0;
    if (i > 0 && i < n) {
      slope = (at(u, i + 1, face) - at(u, i - 1, face)) / (2.0 * h);
    } else {
      const bool leaves = i == 0 ? u[0][here] < 0.0 : u[0][here] > 0.0;
      ++(leaves ? outgoing : incoming);
      if (leaves) slope = (i == 0 ? at(u, 1, face) - u[0][here] : u[0][here] - at(u, n - 1, face)) / h;
    }
    EXPECT_NEAR(rate[0][here] - old[0][here], shift * slope, 1e-13) << i;
  });
  EXPECT_GT(outgoing, 10);
  EXPECT_GT(incoming, 10);
}

TEST(FlowFrame, FluidAtRestBetweenOutflowsStaysAtRest) {
  for (const TimeIntegration& integration : time_integrations) {
    Parameters p = periodic_box({9, 8, 7});
    for (const std::size_t side : {0U, 1U, 4U, 5U}) p.boundary[side].kind = BoundaryKind::outflow;
    p.viscosity = 0.01;
    integration.set(p);
    TypedFlow<DROGUE_TEST_SPACE> flow(p, 22);
    // A frame that moves faster from step to step.
    const StaggeredField rest = flow.domain.zero_field();
    for (std::size_t c = 0; c < 3; ++c) flow.solver.upload(static_cast<StateField>(c), rest[c]);
    flow.solver.start();
    for (int step = 1; step <= 20; ++step) {
      const std::array<double, 3> frame{0.05 * step, 0.0, -0.1 * step};
      flow.solver.change_frame(frame);
      ASSERT_EQ(flow.solver.advance(endless, step, {}), Stop::pause);
      const StaggeredField u = flow.velocity();
      for (std::size_t c = 0; c < 3; ++c)
        for (const double value : u[c]) ASSERT_NEAR(value, -frame[c], 1e-13) << step;
    }
  }
}

}  // namespace
}  // namespace drogue::flow
