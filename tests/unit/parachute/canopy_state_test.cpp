#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "miniapps/parachute/canopy/canopy_state.hpp"
#include "miniapps/parachute/verify/canopy_checks.hpp"

// Measures of canopies, and checks of them in rows.

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

SheetState state_of(const Sheets& sheets) {
  SheetState state;
  state.positions = sheets.positions;
  state.velocities.resize(sheets.positions.size());
  state.on_air.resize(sheets.positions.size());
  state.elastic.resize(sheets.positions.size());
  return state;
}

TEST(CanopyState, InversionIsTheShareOfTheSkirtThatIsInsideOut) {
  Canopy canopy;
  canopy.edge_length = 0.5;
  for (const double angle : {0.0, 60.0, 180.0}) {
    canopy.angle = angle;
    const Sheets sheets = make_all_sheets({}, {canopy}, 1.225, 1.8e-5);
    SheetState state = state_of(sheets);
    EXPECT_EQ(measure(sheets.canopies[0], sheets.fabric, state, false).inversion, 0.0) << angle;
    // The flat cloth lies between the payload and its image: seen from there, its other side is outside.
    Vector& payload = state.positions[*sheets.canopies[0].payload];
    for (std::size_t axis = 0; axis < 3; ++axis) payload[axis] = 2.0 * canopy.centre[axis] - payload[axis];
    EXPECT_EQ(measure(sheets.canopies[0], sheets.fabric, state, false).inversion, 1.0) << angle;
  }
  // A quarter of the skirt turns over: its vertices and those of the next ring change places.
  canopy.angle = 0.0;
  const Sheets sheets = make_all_sheets({}, {canopy}, 1.225, 1.8e-5);
  SheetState state = state_of(sheets);
  for (Vector& x : state.positions) {
    const double radius = std::hypot(x[0], x[1]);
    if (x[0] > 0.0 && x[1] > 0.0 && radius > 3.9)
      for (std::size_t axis = 0; axis < 2; ++axis) x[axis] *= (7.0 - radius) / radius;
  }
  EXPECT_NEAR(measure(sheets.canopies[0], sheets.fabric, state, false).inversion, 0.25, 0.08);
}

TEST(CanopyState, LeanIsThatOfTheAxisFromThePayloadToTheSkirt) {
  Canopy canopy;
  canopy.edge_length = 0.5;
  canopy.azimuth = 20.0;
  for (const auto& [angle, lean] : {std::pair{0.0, 0.0}, {35.0, 35.0}, {120.0, 60.0}}) {
    canopy.angle = angle;
    const Sheets sheets = make_all_sheets({}, {canopy}, 1.225, 1.8e-5);
    EXPECT_NEAR(measure(sheets.canopies[0], sheets.fabric, state_of(sheets), false).lean, lean, 1e-9);
  }
}

TEST(CanopyState, ProjectedAreaIsThatOfTheShadow) {
  Canopy canopy;
  canopy.edge_length = 0.2;
  for (const double angle : {0.0, 60.0, 180.0}) {
    canopy.angle = angle;
    const Sheets sheets = make_all_sheets({}, {canopy}, 1.225, 1.8e-5);
    const double exact = 0.25 * std::numbers::pi * (8.534 * 8.534 - 0.457 * 0.457) *
                         std::abs(std::cos(angle * std::numbers::pi / 180.0));
    EXPECT_NEAR(projected_area(sheets.positions, sheets.fabric.mesh.triangles) / exact, 1.0, 0.01) << angle;
  }
  // Two layers cast one shadow.
  const std::vector<Vector> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
  const std::vector<std::array<int, 3>> layers = {{0, 1, 2}, {5, 4, 3}};
  EXPECT_NEAR(projected_area(points, layers), 0.5, 0.01);
  EXPECT_EQ(projected_area(points, {}), 0.0);
}

TEST(CanopyState, LeakIsTheFlowRelativeToTheCloth) {
  // Air at 2 x + 3 z m/s along z through the triangle of the origin, (1, 0, 0) and (0, 1, 0), which moves.
  SheetState state;
  state.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  state.velocities.assign(4, {5.0, 6.0, 0.25});
  for (const Vector& x : state.positions) state.air.push_back({-7.0, 8.0, 2.0 * x[0] + 3.0 * x[2]});
  // The integral of 2 x over the triangle is 1/3.
  const std::array<int, 3> base = {0, 1, 2}, turned = {0, 2, 1};
  EXPECT_NEAR(leak_through({&base, 1}, state), 1.0 / 3.0 - 0.125, 1e-15);
  EXPECT_NEAR(leak_through({&turned, 1}, state), 0.125 - 1.0 / 3.0, 1e-15);
  // Out of a tetrahedron: its volume times the divergence of the air.
  const std::vector<std::array<int, 3>> closed = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  EXPECT_NEAR(leak_through(closed, state), 3.0 / 6.0, 1e-14);
}

TEST(CanopyState, LeakIsPositiveFromTheSideOfTheLines) {
  Canopy canopy;
  canopy.edge_length = 0.5;
  const Sheets sheets = make_all_sheets({}, {canopy}, 1.225, 1.8e-5);
  SheetState state = state_of(sheets);
  EXPECT_LT(state.positions[sheets.canopies[0].payload.value()][2], -1.0) << "the lines are below";
  EXPECT_EQ(measure(sheets.canopies[0], sheets.fabric, state, false).leak, 0.0) << "without air";
  state.air.assign(state.positions.size(), {0.0, 0.0, 2.0});
  for (Vector& velocity : state.velocities) velocity = {0.0, 0.0, -1.0};
  const CanopyMeasures one = measure(sheets.canopies[0], sheets.fabric, state, false);
  EXPECT_NEAR(one.leak / (3.0 * one.projected_area), 1.0, 0.01);
}

TEST(CanopyState, MeasuresBelongToTheirCanopy) {
  Canopy first, second;
  first.edge_length = second.edge_length = 0.5;
  second.centre = {20.0, 0.0, 0.0};
  const Sheets sheets = make_all_sheets({}, {first, second}, 1.225, 1.8e-5);
  SheetState state = state_of(sheets);
  const CanopyRows& rows = sheets.canopies[1];
  for (Vector& force : state.on_air) force = {1.0, 0.0, -2.0};
  state.elastic[rows.payload.value()] = {0.0, 3.0, 4.0};
  state.velocities[rows.payload.value()] = {0.0, 0.0, -5.0};
  for (std::size_t i = rows.begin; i < rows.cloth_end; ++i)
    for (std::size_t axis = 0; axis < 2; ++axis)
      state.positions[i][axis] += 0.1 * (state.positions[i][axis] - second.centre[axis]);
  const CanopyMeasures one = measure(sheets.canopies[0], sheets.fabric, state, false),
                       other = measure(rows, sheets.fabric, state, false);
  EXPECT_EQ(one.line_force, (Vector{}));
  EXPECT_NEAR(one.largest_strain, 0.0, 1e-12);
  EXPECT_EQ(other.line_force, (Vector{0.0, 3.0, 4.0}));
  EXPECT_EQ(other.velocity, (Vector{0.0, 0.0, -5.0}));
  EXPECT_NEAR(other.largest_strain, 0.1, 1e-12);
  const auto cloth = static_cast<double>(rows.cloth_end - rows.begin);
  EXPECT_EQ(other.force, (Vector{-cloth, 0.0, 2.0 * cloth}));
  EXPECT_NEAR(other.projected_area / one.projected_area, 1.21, 0.02);
}

TEST(CanopyState, RisersPullOnlyWhereTheyAreTautAndWhole) {
  Canopy canopy;
  canopy.edge_length = 0.5;
  canopy.riser = Riser{2.0, 1000.0, 1.0};
  const Sheets sheets = make_all_sheets({}, {canopy}, 1.225, 1.8e-5);
  const CanopyRows& rows = sheets.canopies[0];
  SheetState state = state_of(sheets);
  EXPECT_NEAR(measure(rows, sheets.fabric, state, false).line_force[2], 0.0, 1e-9);
  state.positions[rows.payload.value()][2] -= 0.2;
  EXPECT_NEAR(measure(rows, sheets.fabric, state, false).line_force[2], 100.0, 1e-9);
  EXPECT_EQ(measure(rows, sheets.fabric, state, true).line_force, (Vector{}));
  state.positions[rows.payload.value()][2] += 0.4;
  EXPECT_EQ(measure(rows, sheets.fabric, state, false).line_force, (Vector{}));
}

TEST(CanopyState, SheetWithoutPayloadHasItsCentreOfMass) {
  Canopy canopy;
  canopy.kind = CanopyKind::sheet;
  canopy.edge_length = 0.5;
  canopy.centre = {1.0, 2.0, 3.0};
  const Sheets sheets = make_all_sheets({}, {canopy}, 1.225, 1.8e-5);
  SheetState state = state_of(sheets);
  for (Vector& velocity : state.velocities) velocity = {0.0, 0.0, -4.0};
  const CanopyMeasures one = measure(sheets.canopies[0], sheets.fabric, state, false);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(one.payload[axis], canopy.centre[axis], 1e-9);
  EXPECT_NEAR(one.velocity[2], -4.0, 1e-12);
}

TEST(CanopyState, ForceBalanceComparesTotalAndSum) {
  const std::vector<Vector> forces = {{3.0, 4.0, 0.0}, {0.0, 0.0, 5.0}};
  EXPECT_EQ(force_balance({3.0, 4.0, 5.0}, forces), 0.0);
  EXPECT_NEAR(force_balance({3.0, 4.0, 4.0}, forces), 0.1, 1e-15);
  EXPECT_EQ(force_balance({0.0, 0.0, 0.0}, std::vector<Vector>(2)), 0.0);
}

TEST(CanopyState, DragCoefficientIsThatOfTheForceAlongTheStream) {
  // 2 F / (rho U^2 S) = F / 25 at U = 5 m/s, with a density of 1 kg/m^3 and an area of 2 m^2.
  EXPECT_NEAR(drag_coefficient({0.0, 9.0, 25.0}, {0.0, 0.0, 5.0}, 1.0, 2.0), 1.0, 1e-15);
  EXPECT_NEAR(drag_coefficient({30.0, 40.0, 0.0}, {-3.0, -4.0, 0.0}, 1.0, 2.0), -2.0, 1e-15);
  EXPECT_EQ(drag_coefficient({1.0, 0.0, 0.0}, {}, 1.0, 2.0), 0.0) << "still air";
}

TEST(CanopyState, AirspeedNeedsAStreamOrAPayloadThatMoves) {
  FlowScene scene;
  scene.fluid.emplace();
  scene.canopies.resize(2);
  scene.canopies[0].payload.fixed = true;
  EXPECT_EQ(scene.lack_of_airspeed(0), "which is 0: fluid.velocity is 0 and canopy[0].payload.fixed is true");
  EXPECT_EQ(scene.lack_of_airspeed(1), "");
  scene.canopies[1].payload.shared = 0;
  EXPECT_EQ(scene.lack_of_airspeed(1), "which is 0: fluid.velocity is 0 and canopy[0].payload.fixed is true");
  scene.velocity = {"0", "0", "2+1"};
  EXPECT_EQ(scene.lack_of_airspeed(0), "");
  EXPECT_EQ(scene.stream(), (Vector{0.0, 0.0, 3.0}));
  scene.velocity = {"0", "0", "3+t"};
  EXPECT_EQ(scene.lack_of_airspeed(0), "which needs a fluid.velocity that does not vary");
  scene.fluid.reset();
  EXPECT_EQ(scene.lack_of_airspeed(0), "which needs [fluid]");
}

/// Rows in which air leaks inwards and outwards, with U = 5 m/s and an area of 4 m^2.
run::History leaking_rows() {
  return {{"time", {0.0, 1.0, 3.0, 4.0}},
          {"canopy_0_leak", {1e6, -3.0, 1.0, -1.0}},
          {"canopy_0_airspeed", {5.0, 5.0, 5.0, 5.0}},
          {"canopy_0_projected_area", {4.0, 4.0, 4.0, 4.0}}};
}

/// Mean and root mean square of a leak in the group `canopies`.
std::array<double, 2> leak_between(double from, double to, const run::History& history) {
  Verify wanted;
  wanted.leaks = {{0, from, to, 1.0, {}}};
  run::ResultDocument result;
  check_canopies(wanted, PeakPulls(1, false), history, result);
  EXPECT_EQ(result.checks.size(), 1U);
  return {result.metrics.real("canopies", "leak_0").value(),
          result.metrics.real("canopies", "leak_rms_0").value()};
}

TEST(CanopyChecks, LeakIsThatOfAnIntervalRelativeToTheStream) {
  const run::History history = leaking_rows();
  // Trapezoids: means of the leak of -1 for 2 s and 0 for 1 s, and of its square of 5 and 1.
  const auto [mean, rms] = leak_between(1.0, 5.0, history);
  EXPECT_NEAR(mean, 2.0 / 3.0 / (5.0 * 4.0), 1e-15);
  EXPECT_NEAR(rms, std::sqrt(11.0 / 3.0) / (5.0 * 4.0), 1e-15);
  EXPECT_NEAR(leak_between(1.0, 3.0, history)[0], 1.0 / (5.0 * 4.0), 1e-15);
  for (const double value : leak_between(3.5, 5.0, history))
    EXPECT_TRUE(std::isnan(value)) << "one row is no interval";
}

TEST(CanopyChecks, LeakRelativeToStillAirIsNoNumber) {
  run::History history = leaking_rows();
  history["canopy_0_airspeed"].assign(4, 0.0);
  for (const double value : leak_between(0.5, 5.0, history)) EXPECT_TRUE(std::isnan(value));
  history["canopy_0_leak"].assign(4, 0.0);
  for (const double value : leak_between(0.5, 5.0, history)) EXPECT_TRUE(std::isnan(value));
}

TEST(CanopyChecks, TakeTheLargestOfAllRows) {
  Verify wanted;
  wanted.force_balance = 1e-15;
  wanted.intersections = 2.0;
  run::ResultDocument result;
  run::History history = {
      {"time", {0.0, 1.0, 2.0}}, {"force_balance", {0.0, 3e-16, 2e-16}}, {"intersections", {0.0, 3.0, 1.0}}};
  check_canopies(wanted, PeakPulls(1, false), history, result);
  ASSERT_EQ(result.checks.size(), 2U);
  EXPECT_EQ(result.checks[0].value, 3e-16);
  EXPECT_TRUE(result.checks[0].passed);
  EXPECT_EQ(result.checks[1].value, 3.0);
  EXPECT_FALSE(result.checks[1].passed);
  history["force_balance"][1] = std::nan("");
  check_canopies(wanted, PeakPulls(1, false), history, result);
  EXPECT_FALSE(result.checks[2].passed) << "a balance that is not finite is not hidden";
}

}  // namespace
}  // namespace drogue::parachute_app
