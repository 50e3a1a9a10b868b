#include "miniapps/parachute/verify/body_drag.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "miniapps/parachute/simulation/history_columns.hpp"
#include "miniapps/parachute/verify/flight.hpp"
#include "tests/support/held_canopy.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;
using std::numbers::pi;

const char* const sphere_in_air = R"(app = "parachute"
[fluid]
density = 1.25
viscosity = 0.01
velocity = [10, 0, 0]
[grid]
cells = [40, 40, 40]
domain = [[-2, 2], [-2, 2], [-2, 2]]
boundary = { x = ["inflow", "outflow"], y = "slip", z = "slip" }
[[body]]
kind = "sphere"
centre = [0, 0, 0]
radius = 0.5
edge_length = 0.07
retraction = 0.3
[run]
end_time = 4
)";

Body sized_body(BodyKind kind) {
  Body body;
  body.kind = kind;
  body.axis = 2;
  body.lengths = {0.4, 0.6};
  body.radius = 0.5;
  body.length = 2.0;
  body.edge_length = 0.02;
  return body;
}

TEST(BodyDrag, RefersToTheAreaAcrossTheStream) {
  const Vector along = {0.0, 0.0, -1.0}, across = {1.0, 0.0, 0.0}, between = {0.6, 0.0, 0.8};
  const double circle = pi / 4.0;
  EXPECT_DOUBLE_EQ(frontal_area(sized_body(BodyKind::sphere), between), circle);
  EXPECT_DOUBLE_EQ(frontal_area(sized_body(BodyKind::plate), along), 0.24);
  EXPECT_DOUBLE_EQ(frontal_area(sized_body(BodyKind::plate), between), 0.8 * 0.24);
  EXPECT_EQ(frontal_area(sized_body(BodyKind::disk), across), 0.0);
  EXPECT_DOUBLE_EQ(frontal_area(sized_body(BodyKind::cup), along), circle);
  EXPECT_DOUBLE_EQ(frontal_area(sized_body(BodyKind::cup), across), 0.5 * circle);
  EXPECT_DOUBLE_EQ(frontal_area(sized_body(BodyKind::cylinder), across), 2.0);
  Body closed = sized_body(BodyKind::cylinder);
  closed.has_ends = true;
  EXPECT_DOUBLE_EQ(frontal_area(closed, along), circle);
  // A rectangle and an ellipse, by its shadow.
  EXPECT_NEAR(frontal_area(closed, between), 0.6 * 2.0 + 0.8 * circle, 0.01 * 1.8);
}

/// Result of forces on the sphere with a drag coefficient of 0.5 in the second half, at 401 rows.
run::ResultDocument described(const FlowScene& scene, double noise) {
  run::History history;
  for (const run::Column& column : history_columns(scene)) history[column.name].resize(401);
  const double force = 0.5 * 0.5 * 1.25 * 100.0 * pi / 4.0;
  for (std::size_t k = 0; k <= 400; ++k) {
    history["time"].push_back(0.01 * static_cast<double>(k));
    history.at("body_0_force_x")[k] =
        (k < 190 ? 7.0 : 1.0) * force * (1.0 + noise * std::sin(40.0 * static_cast<double>(k)));
  }
  run::ResultDocument result;
  describe_bodies(scene, history, result);
  return result;
}

TEST(BodyDrag, IsTheMeanOfTheSecondHalfWithItsErrorBar) {
  const SceneFile file(sphere_in_air);
  const run::ResultDocument result = described(file.read(), 0.1);
  EXPECT_EQ(result.metrics.real("body_0", "from"), 2.0);
  EXPECT_NEAR(result.metrics.real("body_0", "frontal_area").value(), pi / 4.0, 1e-12) << "without retraction";
  EXPECT_NEAR(result.metrics.real("body_0", "drag_coefficient").value(), 0.5, 1e-3);
  const double error = result.metrics.real("body_0", "drag_coefficient_error").value();
  EXPECT_GT(error, 0.0);
  EXPECT_LT(error, 0.01);
  EXPECT_TRUE(flight_report(result).starts_with(
      "body[0] of 0.785 m^2, means from 2 s on; +- is 95 % by the scatter in this run\n"
      "  C_D                               0.5"))
      << flight_report(result);
  EXPECT_EQ(flight_title("body_0.drag_coefficient"), "body[0] C_D");
}

TEST(BodyDrag, BeginsAfterTheStartOfTheWakeIfTheRunGoesOnFarEnough) {
  const SceneFile file(sphere_in_air);
  const auto begin = [&](const std::string& speed) {
    return described(file.read({"fluid.velocity=[" + speed + ",0,0]"}), 0.0)
        .metrics.real("body_0", "from")
        .value();
  };
  EXPECT_DOUBLE_EQ(begin("11.9"), 2.0) << "too short a run";
  EXPECT_DOUBLE_EQ(begin("12.5"), 3.2) << "40 diameters";
  EXPECT_DOUBLE_EQ(begin("25"), 2.0) << "the second half";
}

TEST(BodyNotes, NameASectionThatIsTooNarrowAndARunThatIsTooShort) {
  const SceneFile file(sphere_in_air);
  const auto notes = [&](const std::vector<std::string>& sets) { return file.read(sets).notices; };
  const std::string narrow =
      "grid.domain: the body covers 4.91 % of its section across x, so that its drag is that in a duct and "
      "not in free air; a square section of 6.27 m has at most 2 %";
  EXPECT_EQ(notes({}),
            (std::vector<std::string>{
                narrow,
                "run.end_time: 40 widths of body[0] pass with the stream, and its wake starts up in "
                "some 40, so that its drag is not yet that of a steady stream; 4.8 s leave time for a "
                "mean"}));
  EXPECT_EQ(notes({"run.end_time=4.8"}), std::vector{narrow});
  const std::vector<std::string> wide = {"grid.domain=[[-3.2,3.2],[-3.2,3.2],[-3.2,3.2]]",
                                         "grid.cells=[64,64,64]", "run.end_time=4.8"};
  EXPECT_TRUE(notes(wide).empty());
  // A steady wake, at a Reynolds number of 100.
  EXPECT_EQ(notes({"fluid.viscosity=0.125", "run.end_time=1.5"}), std::vector{narrow});
  // What has no drag coefficient has no note.
  EXPECT_TRUE(notes({"fluid.velocity=[\"10+y\", 0, 0]"}).empty());
  EXPECT_TRUE(notes({"body[0].motion.y=\"0.1*sin(t)\""}).empty());
}

TEST(BodyDrag, NeedsASteadyStreamAndABodyAtRest) {
  const SceneFile file(sphere_in_air);
  const auto has_drag = [&](const std::vector<std::string>& sets) {
    return described(file.read(sets), 0.0).metrics.real("body_0", "drag_coefficient").has_value();
  };
  EXPECT_TRUE(has_drag({"fluid.velocity=[\"10*(1-exp(-5*t))\", 0, 0]"})) << "a start from rest";
  EXPECT_FALSE(has_drag({"fluid.velocity=[\"10+t\", 0, 0]"}));
  EXPECT_FALSE(has_drag({"fluid.velocity=[\"10+y\", 0, 0]"}));
  EXPECT_FALSE(has_drag({"fluid.velocity=[0, 0, 0]"}));
  EXPECT_FALSE(has_drag({"body[0].motion.y=\"0.1*sin(t)\""}));
}

}  // namespace
}  // namespace drogue::parachute_app
