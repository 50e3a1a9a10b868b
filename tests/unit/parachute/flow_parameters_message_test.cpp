#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "miniapps/parachute/parallel/parameters_message.hpp"

namespace drogue::parachute_app {
namespace {

std::string message_of(const coupling::Parameters& parameters) {
  MessageWriter writer;
  put_parameters(writer, parameters);
  return writer.take();
}

coupling::Parameters uncommon_parameters() {
  coupling::Parameters all;
  flow::Parameters& p = all.flow;
  p.cells = {5, 6, 7};
  p.high = {2.0, 3.0, 4.0};
  p.viscosity = 0.25;
  p.boundary[1].kind = flow::BoundaryKind::outflow;
  p.boundary[2].velocity = {1.0, 2.0, 3.0};
  device::ExpressionBuilder builder;
  builder.push("constant", 2.5);
  p.boundary[4].velocity_expressions = {builder.program(), builder.program(), builder.program()};
  p.time_scheme = flow::TimeScheme::rk3;
  p.turbulence = flow::Turbulence::vreman;
  p.max_steps = 77;
  p.driver = flow::Driver::plain;
  fabric::Parameters& cloth = all.fabric;
  cloth.mesh.rest = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  cloth.mesh.lines = {{0, 1}};
  cloth.mass = {0.5, 0.75};
  cloth.pinned = {7, 1};
  cloth.motions = {{2, {1, 0}, builder.program()}};
  cloth.timed_loads = {{builder.program(), {{0.0, 0.0, 9.0}, {0.0, 0.0, 8.0}}}};
  cloth.follower_pressures = {{builder.program(), {0.25, 0.5}}};
  cloth.contact.bodies.resize(2);
  cloth.contact.bodies[1].radius = 0.125;
  cloth.contact.friction = 0.375;
  cloth.patch = 5;
  all.sheet.law_of_vertex = {{1.0, 2.0, false, true}, {3.0, 4.0, true, false}};
  all.sheet.filter = 0.625;
  all.sheet.closing = {{0, 0, 2, 0.5, 3.0}};
  all.follow.vertex = 1;
  all.substeps = 9;
  return all;
}

TEST(FlowParametersMessage, KeepsEveryMember) {
  const std::string sent = message_of(uncommon_parameters());
  MessageReader reader(sent);
  const coupling::Parameters everything = get_parameters(reader);
  const flow::Parameters& received = everything.flow;
  const fabric::Parameters& cloth = everything.fabric;
  EXPECT_EQ(sent, message_of(everything));
  EXPECT_NE(sent, message_of({}));
  EXPECT_EQ(7, received.cells[2]);
  EXPECT_EQ(flow::BoundaryKind::outflow, received.boundary[1].kind);
  EXPECT_EQ(3.0, received.boundary[2].velocity[2]);
  ASSERT_EQ(3U, received.boundary[4].velocity_expressions.size());
  EXPECT_EQ(1, received.boundary[4].velocity_expressions[2].length);
  EXPECT_EQ(flow::Turbulence::vreman, received.turbulence);
  EXPECT_EQ(77, received.max_steps);
  EXPECT_EQ(flow::Driver::plain, received.driver);
  EXPECT_EQ(6.0, cloth.mesh.rest.at(1)[2]);
  ASSERT_EQ(1U, cloth.motions.size());
  EXPECT_EQ((std::vector<int>{1, 0}), cloth.motions[0].vertices);
  EXPECT_EQ(8.0, cloth.timed_loads.at(0).direction.at(1)[2]);
  EXPECT_EQ(0.5, cloth.follower_pressures.at(0).weight.at(1));
  EXPECT_EQ(0.125, cloth.contact.bodies.at(1).radius);
  EXPECT_EQ(0.375, cloth.contact.friction);
  EXPECT_EQ(5, cloth.patch);
  EXPECT_TRUE(everything.sheet.law_of_vertex.at(0).no_slip);
  EXPECT_EQ(0.5, everything.sheet.closing.at(0).inverse_mass);
  EXPECT_EQ(1, everything.follow.vertex);
  EXPECT_EQ(9, everything.substeps);
}

TEST(FlowParametersMessage, RejectsTruncatedMessages) {
  std::string sent = message_of(uncommon_parameters());
  sent.pop_back();
  MessageReader reader(sent);
  EXPECT_THROW(static_cast<void>(get_parameters(reader)), std::out_of_range);
}

}  // namespace
}  // namespace drogue::parachute_app
