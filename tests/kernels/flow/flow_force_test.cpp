#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "kernels/coupling/interpolate.hpp"
#include "kernels/coupling/spread.hpp"
#include "kernels/device/copy.hpp"
#include "kernels/flow/face_views.hpp"
#include "kernels/reference/coupling/grid_transfer.hpp"
#include "kernels/reference/flow/momentum.hpp"
#include "tests/support/typed_flow.hpp"

// Coupling with other kernels: the force field and its effect on a step, failures that it causes, transfer to
// and from points.

namespace drogue::flow {

// In the library: the tested code is that of the programs.
extern template class FlowSolver<DROGUE_TEST_SPACE>;

namespace {

using namespace drogue::testing;  // NOLINT: helpers of these tests
using Space = DROGUE_TEST_SPACE;
using reference::GridIndex;

/// Solver with a force field.
struct TypedCase : TypedFlow<Space> {
  explicit TypedCase(const Parameters& p) : TypedFlow<Space>(p, 1) {}

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
  Parameters p = forced_box({8, 1, 6});
  p.time_scheme = TimeScheme::ab2;  // whose first step is Euler's
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

/// Channel with all kinds of sides but walls.
Parameters forced_channel() {
  Parameters p = forced_box({9, 8, 7});
  const BoundaryKind kinds[] = {BoundaryKind::inflow, BoundaryKind::outflow,  BoundaryKind::slip,
                                BoundaryKind::slip,   BoundaryKind::periodic, BoundaryKind::periodic};
  for (std::size_t side = 0; side < 6; ++side) p.boundary[side].kind = kinds[side];
  p.boundary[0].velocity = {0.6, 0.1, 0.0};
  return p;
}

TEST(FlowForce, ActsOnOutflowsAsABodyForceDoes) {
  for (const TimeScheme time : {TimeScheme::ab2, TimeScheme::rk3}) {
    Parameters p = forced_channel(), with_body_force = p;
    p.boundary[0] = p.boundary[1];
    with_body_force.boundary = p.boundary;
    with_body_force.body_force = {0.4, 0.0, 0.3};
    p.time_scheme = with_body_force.time_scheme = time;
    TypedCase forced(p), accelerated(with_body_force);
    StaggeredField force = forced.domain.zero_field();
    for (std::size_t c = 0; c < 3; ++c)
      for (double& value : force[c]) value = with_body_force.body_force[c];
    forced.set_force(force);
    ASSERT_EQ(forced.solver.advance(endless, 3, {}), Stop::pause);
    ASSERT_EQ(accelerated.solver.advance(endless, 3, {}), Stop::pause);
    EXPECT_LT(largest_difference(forced.velocity(), accelerated.velocity()), 1e-13);
  }
}

/// Points away from the sides, so that no delta function is cut off, and forces on them, N.
constexpr int number_of_points = 40;
using PointViews = Kokkos::View<double* [3], Kokkos::LayoutLeft, Space::memory_space>;
using HostPoints = std::vector<std::array<double, 3>>;

HostPoints random_points(double low, double high, unsigned seed) {
  std::mt19937 engine(seed);
  HostPoints points(number_of_points);
  for (auto& point : points)
    for (double& value : point) value = low + (high - low) * std::generate_canonical<double, 53>(engine);
  return points;
}

PointViews on_device(const Space& space, const HostPoints& points) {
  std::vector<double> values;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const auto& point : points) values.push_back(point[axis]);
  PointViews view("points", points.size());
  device::copy_in(space, view, values.data(), values.size());
  space.fence();
  return view;
}

TEST(FlowCoupling, InterpolatesTheVelocityWhereTheSolverKeepsIt) {
  for (const Parameters& p : {forced_box({7, 6, 5}), forced_box({12, 9, 1}), forced_channel()}) {
    TypedCase flow(p);
    const Space& space = flow.instance.space();
    const coupling::StaggeredGrid grid = coupling_grid(flow.solver.grid());
    const HostPoints points = random_points(0.2, 0.8, 5);
    const coupling::GridTransfer<Space> transfer(space, grid, coupling::DeltaFunction::cbs43,
                                                 number_of_points);
    const PointViews x = on_device(space, points), zero("zero", number_of_points), u("u", number_of_points);
    coupling::freeze_positions(space, transfer, x, zero, 0.0);
    coupling::interpolate(space, transfer, face_views<Space>(flow.solver.grid(), flow.solver.velocity()), u);
    std::vector<double> values(3U * number_of_points);
    device::copy_out(space, values.data(), u, values.size());
    space.fence();
    const auto expected =
        reference::interpolate(grid, coupling::DeltaFunction::cbs43, flow.velocity(), points);
    for (std::size_t i = 0; i < expected.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(values[axis * number_of_points + i], expected[i][axis], 1e-14);
  }
}

TEST(FlowCoupling, SpreadForcesActInTheNextStep) {
  for (const Parameters& p : {forced_box({7, 6, 5}), forced_channel()}) {
    TypedCase forced(p), copied(p);
    const Space& space = forced.instance.space();
    const coupling::StaggeredGrid grid = coupling_grid(forced.solver.grid());
    const HostPoints points = random_points(0.3, 0.7, 6), forces = random_points(-1.0, 1.0, 7);
    const coupling::GridTransfer<Space> transfer(space, grid, coupling::DeltaFunction::cbs43,
                                                 number_of_points);
    const PointViews x = on_device(space, points), zero("zero", number_of_points);
    coupling::freeze_positions(space, transfer, x, zero, 0.0);
    coupling::spread(space, transfer, on_device(space, forces),
                     face_views<Space>(forced.solver.grid(), forced.solver.force()));
    copied.set_force(reference::spread(grid, coupling::DeltaFunction::cbs43, points, forces));
    ASSERT_EQ(forced.solver.advance(endless, 2, {}), Stop::pause);
    ASSERT_EQ(copied.solver.advance(endless, 2, {}), Stop::pause);
    EXPECT_LT(largest_difference(forced.velocity(), copied.velocity()), 1e-13);
  }
}

TEST(FlowForce, IsEmptyUnlessRequested) {
  TypedCase flow(periodic_box({8, 7, 6}));
  EXPECT_EQ(flow.solver.force().extent(0), 0U);
}

}  // namespace
}  // namespace drogue::flow
