#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "kernels/reference/flow/momentum.hpp"
#include "tests/support/typed_flow.hpp"

// Changes of the frame of reference.

namespace drogue::flow {

// In the library: the tested code is that of the programs.
extern template class FlowSolver<DROGUE_TEST_SPACE>;

namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests
using reference::GridIndex;

TEST(FlowFrame, RatesOfThePreviousStepBecomeThoseOfTheNewFrame) {
  constexpr std::array<double, 3> frame = {0.3, -0.4, 0.0};
  for (const TimeIntegration& integration : time_integrations)
    for (const Advection advection : {Advection::central, Advection::weno_z}) {
      if (integration.time != TimeScheme::ab2) continue;
      Parameters p = periodic_box({9, 8, 7});
      for (const std::size_t side : {0U, 1U, 2U}) p.boundary[side].kind = BoundaryKind::outflow;
      p.boundary[3].kind = BoundaryKind::inflow;
      p.boundary[3].velocity = {0.2, -0.1, 0.3};
      p.boundary[1].velocity = {-0.5, 0.1, -0.2};
      p.viscosity = 0.02;
      p.advection = advection;
      integration.set(p);
      TypedFlow<DROGUE_TEST_SPACE> flow(p, 21);
      ASSERT_EQ(flow.solver.advance(endless, 1, {}), Stop::pause);
      const StaggeredField u = flow.velocity(), old = rates(flow.solver);
      flow.solver.change_frame(frame);
      const StaggeredField moved = flow.velocity(), rate = rates(flow.solver);
      Parameters moving = p;
      if (integration.diffusion == Diffusion::crank_nicolson) p.viscosity = moving.viscosity = 0.0;
      for (Boundary& side : moving.boundary)
        for (std::size_t c = 0; c < 3; ++c) side.velocity[c] -= frame[c];
      const StaggeredField before = reference::momentum_rate(FlowDomain(p), u, 0.0),
                           after = reference::momentum_rate(FlowDomain(moving), moved, 0.0);
      int entering = 0;
      flow.domain.for_each_face([&](std::size_t c, const GridIndex& face) {
        const std::size_t here = flow.domain.at(c, face);
        EXPECT_NEAR(moved[c][here], u[c][here] - frame[c], 1e-15);
        const int side = flow.domain.side_of(c, face);
        if (side == 3) return;
        EXPECT_NEAR(rate[c][here] - old[c][here], after[c][here] - before[c][here], 1e-11) << side;
        if (side >= 0 && (side % 2 == 0) == (moved[c][here] > 0.0)) ++entering;
      });
      EXPECT_GT(entering, 30);
    }
}

/// Frames that the tests below pass through, m/s, for a quarter of a second each.
constexpr double frames[] = {-0.5, -1.5, -0.3, -0.9};

/// Velocity after all frames of a flow that starts from `initial`, m/s.
StaggeredField after_all_frames(const Parameters& p,
                                const std::function<double(std::size_t, double)>& initial) {
  TypedFlow<DROGUE_TEST_SPACE> flow(p, 23);
  const StaggeredField u = sampled_field(flow.domain, [&](std::size_t c, const reference::Point& at) {
    return initial(c, at[0] + 2.0 * at[1]);
  });
  upload_velocity(flow.solver, u);
  flow.solver.start();
  double end = 0.0;
  for (const double speed : frames) {
    flow.solver.change_frame({speed, 0.5 * speed, 0.0});
    EXPECT_EQ(flow.solver.advance(end += 0.25, -1, {}), Stop::target);
  }
  return flow.velocity();
}

/// Orders of the errors of three steps, each half of the one before.
void expect_order(const Parameters& p, const std::vector<double>& errors) {
  for (std::size_t i = 1; i < errors.size(); ++i)
    EXPECT_GT(std::log2(errors[i - 1] / errors[i]), p.time_scheme == TimeScheme::rk3 ? 2.8 : 1.8)
        << errors[i - 1] << " " << errors[i] << " diffusion " << static_cast<int>(p.diffusion);
}

TEST(FlowFrame, EnteringFluidIsOfTheOrderOfTheSchemeWhereFramesChange) {
  // A body force f drives fluid that enters with the velocity V: du/dt = f - (u^2 - V^2) / (2 L).
  constexpr double f = 0.5, length = 2.0;
  double exact = 0.0, last = 0.0;
  for (const double speed : frames) {
    exact -= speed - last;
    last = speed;
    const double limit = std::sqrt(2.0 * f * length + speed * speed),
                 growth = std::tanh(0.25 * limit / (2.0 * length));
    exact = limit * (exact + limit * growth) / (limit + exact * growth);
  }
  for (const TimeIntegration& integration : time_integrations) {
    Parameters p = periodic_box({16, 4, 1});
    p.high[0] = length;
    p.body_force[0] = f;
    p.viscosity = 0.02;
    integration.set(p);
    for (const std::size_t side : {0U, 1U}) p.boundary[side].kind = BoundaryKind::outflow;
    std::vector<double> errors;
    for (const double dt : {0.25 / 16.0, 0.25 / 32.0, 0.25 / 64.0}) {
      p.fixed_dt = dt;
      std::vector<double> u = after_all_frames(p, [](std::size_t, double) { return 0.0; })[0];
      for (double& value : u) value -= exact;
      errors.push_back(largest(u));
    }
    expect_order(p, errors);
  }
}

TEST(FlowFrame, DisturbedStreamsAreOfTheOrderOfTheSchemeWhereFramesChange) {
  for (const TimeIntegration& integration : time_integrations) {
    Parameters p = periodic_box({12, 10, 1});
    p.viscosity = 0.01;
    p.advection = Advection::central;
    integration.set(p);
    for (const std::size_t side : {0U, 1U, 2U, 3U}) p.boundary[side].kind = BoundaryKind::outflow;
    const auto velocity = [&](double dt) {
      p.fixed_dt = dt;
      return after_all_frames(p, [](std::size_t c, double place) {
        return c == 2 ? 0.0 : 0.1 * std::sin(3.0 * place + static_cast<double>(c));
      });
    };
    const StaggeredField exact = velocity(0.25 / 512.0);
    std::vector<double> errors;
    for (const double dt : {0.25 / 32.0, 0.25 / 64.0, 0.25 / 128.0})
      errors.push_back(rms_difference(velocity(dt), exact));
    expect_order(p, errors);
  }
}

TEST(FlowFrame, FluidAtRestBetweenOutflowsStaysAtRest) {
  for (const TimeIntegration& integration : time_integrations) {
    Parameters p = periodic_box({9, 8, 7});
    for (const std::size_t side : {0U, 1U, 4U, 5U}) p.boundary[side].kind = BoundaryKind::outflow;
    p.viscosity = 0.01;
    integration.set(p);
    TypedFlow<DROGUE_TEST_SPACE> flow(p, 22);
    // A frame that moves faster from step to step.
    upload_velocity(flow.solver, flow.domain.zero_field());
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
