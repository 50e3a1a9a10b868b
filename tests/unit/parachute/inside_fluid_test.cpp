#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "miniapps/parachute/bodies/inside_fluid.hpp"
#include "miniapps/parachute/canopy/periodic_images.hpp"

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

TEST(PeriodicImages, AreMetByTrianglesAndLines) {
  const std::vector<Vector> periods = periods_of(unit_domain());
  // A triangle at the low side, and one that sticks out of the high side across its image.
  std::vector<Vector> x = {
      {0.2, 0.0, 0.0}, {0.2, 1.0, 0.0}, {0.2, 0.0, 1.0}, {1.9, 0.3, 0.3}, {2.4, 0.3, 0.3}};
  const std::vector<std::array<int, 3>> triangles = {{0, 1, 2}};
  const std::vector<std::array<int, 2>> lines = {{3, 4}};
  const auto found = image_intersections(x, triangles, lines, periods, 0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].of_segment, 3);
  EXPECT_EQ(found[0].of_triangle, 0);
  EXPECT_TRUE(image_intersections(x, triangles, lines, periods, 5).empty()) << "both are bodies";
  x[4][0] = 2.1;
  EXPECT_TRUE(image_intersections(x, triangles, lines, periods, 0).empty());
}

}  // namespace
}  // namespace drogue::parachute_app
