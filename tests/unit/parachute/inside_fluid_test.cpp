#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "miniapps/parachute/bodies/inside_fluid.hpp"
#include "miniapps/parachute/canopy/image_watch.hpp"

// Fluid inside of bodies, and images of sheets beyond periodic sides.

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

flow::Parameters unit_domain() {
  flow::Parameters p;
  p.cells = {16, 16, 16};
  p.high = {2.0, 2.0, 2.0};
  p.density = 3.0;
  for (flow::Boundary& side : p.boundary) side.kind = flow::BoundaryKind::periodic;
  return p;
}

Body body_of(BodyKind kind) {
  Body body;
  body.kind = kind;
  body.radius = 0.5;
  body.length = 2.0;
  body.axis = 2;
  body.edge_length = 0.05;
  body.spacing = {0.125, 0.125, 0.125};
  return body;
}

TEST(InsideFluid, VolumesOfClosedBodiesAreThoseOfTheirShapes) {
  flow::Parameters p = unit_domain();
  const double disk = std::numbers::pi * 0.25;
  Body sphere = body_of(BodyKind::sphere);
  EXPECT_NEAR(inside_volume(sphere, p), 4.0 / 3.0 * std::numbers::pi * 0.125, 2e-3);
  const double whole = inside_volume(sphere, p);
  sphere.retraction = 0.3;  // makes up for the width of the delta function
  EXPECT_DOUBLE_EQ(inside_volume(sphere, p), whole);
  Body tube = body_of(BodyKind::cylinder);
  EXPECT_NEAR(inside_volume(tube, p), 2.0 * disk, 5e-3);
  p.boundary[4].kind = p.boundary[5].kind = flow::BoundaryKind::outflow;
  EXPECT_EQ(inside_volume(tube, p), 0.0) << "open";
  tube.has_ends = true;
  EXPECT_NEAR(inside_volume(tube, p), 2.0 * disk, 5e-2);
  EXPECT_EQ(inside_volume(body_of(BodyKind::cup), p), 0.0);
  EXPECT_EQ(inside_volume(body_of(BodyKind::disk), p), 0.0);
}

TEST(InsideFluid, InertiaIsMassTimesAcceleration) {
  const flow::Parameters p = unit_domain();
  Body body = body_of(BodyKind::sphere);
  EXPECT_FALSE(InsideFluid(body, p).moves());
  body.motion[1] = "0.1*sin(4*t)";
  InsideFluid fluid(body, p);
  ASSERT_TRUE(fluid.moves());
  const double mass = 3.0 * inside_volume(body, p), dt = 1e-3, time = 0.7;
  const double expected = -mass * 0.1 * 16.0 * std::sin(4.0 * (time - 0.5 * dt));
  EXPECT_NEAR(fluid.inertia(time, dt)[1], expected, 1e-5 * std::abs(expected));
  EXPECT_EQ(fluid.inertia(time, dt)[0], 0.0);
  EXPECT_EQ(fluid.inertia(0.0, 0.0)[1], 0.0);
  body.porosity.law = PorosityLaw::forchheimer;
  EXPECT_FALSE(InsideFluid(body, p).moves()) << "fluid passes";
}

TEST(InsideFluid, DisplacementsBeforeTheStartAreNotNeeded) {
  Body body = body_of(BodyKind::sphere);
  body.motion[0] = "sqrt(t)^5";
  InsideFluid fluid(body, unit_domain());
  EXPECT_TRUE(std::isfinite(fluid.inertia(1e-3, 1e-3)[0]));
}

TEST(PeriodicImages, AreThoseAcrossPeriodicSides) {
  flow::Parameters p = unit_domain();
  EXPECT_EQ(periods_of(p).size(), 13U);
  p.boundary[2].kind = p.boundary[3].kind = flow::BoundaryKind::wall;
  EXPECT_EQ(periods_of(p).size(), 4U);
  p.cells[0] = 1;
  EXPECT_EQ(periods_of(p), (std::vector<Vector>{{0.0, 0.0, 2.0}}));
}

/// A triangle at the low side along x, and a line that ends at `to` within the image of it, at 2.2.
struct TriangleAndLine {
  std::vector<Vector> x = {
      {0.2, 0.0, 0.0}, {0.2, 1.0, 0.0}, {0.2, 0.0, 1.0}, {1.9, 0.3, 0.3}, {2.4, 0.3, 0.3}};
  std::vector<std::array<int, 3>> triangles = {{0, 1, 2}};
  std::vector<std::array<int, 2>> lines = {{3, 4}};
  SheetParts parts;
  std::vector<Vector> periods = periods_of(unit_domain());

  [[nodiscard]] std::vector<ImageIntersection> found() const {
    return image_intersections(x, {triangles, lines}, periods, parts);
  }
  [[nodiscard]] double distance() const { return distance_from_images(x, lines, periods, parts); }
};

SheetParts parts_with(std::size_t bodies, std::vector<std::size_t> ends) {
  const std::size_t n = ends.size();
  return {std::move(ends), bodies, n - bodies, std::vector<bool>(n, true)};
}

TEST(PeriodicImages, AreMetByTrianglesAndLines) {
  TriangleAndLine sheets;
  sheets.parts = parts_with(0, {5});
  const auto found = sheets.found();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].of_segment, 3);
  EXPECT_EQ(found[0].of_triangle, 0);
  sheets.parts = parts_with(0, {3, 5});
  EXPECT_EQ(sheets.found().size(), 1U);
  EXPECT_LE(sheets.distance(), 0.0);
  sheets.x[4][0] = 2.1;
  EXPECT_TRUE(sheets.found().empty());
  EXPECT_NEAR(sheets.distance(), 0.1, 1e-8) << "of the line from the image of the triangle";
}

TEST(PeriodicImages, MayTouchTheirOwnBodyAndNoOther) {
  TriangleAndLine sheets;
  sheets.parts = parts_with(1, {5});
  EXPECT_TRUE(sheets.found().empty());
  EXPECT_TRUE(std::isinf(sheets.distance()));
  sheets.parts = parts_with(2, {3, 5});
  EXPECT_EQ(sheets.found().size(), 1U);
  EXPECT_LE(sheets.distance(), 0.0);
  sheets.parts.moves = {false, false};
  EXPECT_EQ(sheets.found().size(), 1U);
  EXPECT_TRUE(std::isinf(sheets.distance())) << "they stay apart or not";
}

TEST(PeriodicImages, BeginWhereWhatReachesTheSidesEnds) {
  TriangleAndLine sheets;
  sheets.parts = parts_with(0, {3, 5});
  sheets.x[3][0] = 0.2, sheets.x[4][0] = 2.2;  // as long as the domain
  EXPECT_TRUE(sheets.found().empty());
  EXPECT_GT(sheets.distance(), 0.0);
  sheets.x[4][0] = 2.2 + 1e-8;
  EXPECT_EQ(sheets.found().size(), 1U);
}

TEST(PeriodicImages, PartsAreNamedAsInTheScene) {
  const SheetParts parts = parts_with(1, {3, 5, 9});
  EXPECT_EQ(parts.of(2), 0U);
  EXPECT_EQ(parts.of(3), 1U);
  EXPECT_EQ(parts.of(8), 2U);
  EXPECT_EQ(parts.name(0), "body[0]");
  EXPECT_EQ(parts.name(2), "canopy[1]");
}

/// A sheet of 1 m in a periodic box of 2 m: the image is 1 m away.
struct WatchedSheet {
  FlowScene scene;
  Sheets sheets;
  std::vector<Vector> velocities;

  WatchedSheet() {
    Canopy canopy;
    canopy.kind = CanopyKind::sheet;
    canopy.diameter = 1.0;
    canopy.gores = 8;
    canopy.vent = 0.0;
    canopy.edge_length = 0.1;
    canopy.centre = {1.0, 1.0, 1.0};
    scene.canopies = {canopy};
    scene.parameters = unit_domain();
    sheets = make_all_sheets({}, scene.canopies, 1.2, 1e-5);
    velocities.assign(sheets.positions.size(), {});
  }
};

TEST(ImageWatch, LooksBeforeSheetsCanHaveMet) {
  WatchedSheet sheet;
  ImageWatch watch(sheet.scene, sheet.sheets);
  ASSERT_TRUE(watch.applies());
  EXPECT_EQ(watch.next(), 0);
  const auto next = [&](double speed, double dt) {
    sheet.velocities[3] = {0.0, -speed, 0.0};
    EXPECT_FALSE(watch.look({100, 0.5, dt, sheet.sheets.positions, sheet.velocities}));
    return watch.next();
  };
  EXPECT_EQ(next(0.0, 0.01), 101) << "how it will move is not known";
  EXPECT_EQ(next(1e-3, 0.01), 116) << "slow";
  EXPECT_EQ(next(2.5, 0.01), 110) << "both may reach twice the speed";
  EXPECT_EQ(next(1e3, 0.01), 101);
}

TEST(ImageWatch, HasNothingToDoWithoutImagesOrMotion) {
  WatchedSheet sheet;
  for (flow::Boundary& side : sheet.scene.parameters.boundary) side.kind = flow::BoundaryKind::slip;
  EXPECT_FALSE(ImageWatch(sheet.scene, sheet.sheets).applies());
  FlowScene bodies;
  bodies.parameters = unit_domain();
  bodies.bodies = {body_of(BodyKind::disk)};
  const Sheets one = make_all_sheets(bodies.bodies, {}, 1.2, 1e-5);
  EXPECT_FALSE(ImageWatch(bodies, one).applies()) << "at rest";
  bodies.bodies[0].motion[0] = "t";
  ImageWatch watch(bodies, one);
  ASSERT_TRUE(watch.applies());
  const std::vector<Vector> velocities(one.positions.size());
  EXPECT_FALSE(watch.look({0, 0.0, 0.0, one.positions, velocities}));
  EXPECT_FALSE(watch.applies()) << "it may meet itself alone";
}

TEST(ImageWatch, NamesWhatMeetsAndWhere) {
  WatchedSheet sheet;
  Canopy second = sheet.scene.canopies[0];
  second.centre = {1.0, 1.0, 2.9};
  second.angle = 30.0;
  sheet.scene.canopies[0].centre[2] = 0.9;
  sheet.scene.canopies.push_back(second);
  const Sheets both = make_all_sheets({}, sheet.scene.canopies, 1.2, 1e-5);
  ImageWatch pair(sheet.scene, both);
  const std::vector<Vector> velocities(both.positions.size());
  const auto found = pair.look({7, 0.1, 0.01, both.positions, velocities});
  ASSERT_TRUE(found);
  EXPECT_NE(found->find("the image of canopy[0] beyond the periodic sides at ("), std::string::npos)
      << *found;
}

}  // namespace
}  // namespace drogue::parachute_app
