#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "miniapps/parachute/parallel/parameters_message.hpp"

namespace drogue::parachute_app {
namespace {

std::string message_of(const flow::Parameters& parameters) {
  MessageWriter writer;
  put_parameters(writer, parameters);
  return writer.take();
}

flow::Parameters uncommon_parameters() {
  flow::Parameters p;
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
  return p;
}

TEST(FlowParametersMessage, KeepsEveryMember) {
  const std::string sent = message_of(uncommon_parameters());
  MessageReader reader(sent);
  const flow::Parameters received = get_parameters(reader);
  EXPECT_EQ(sent, message_of(received));
  EXPECT_NE(sent, message_of({}));
  EXPECT_EQ(7, received.cells[2]);
  EXPECT_EQ(flow::BoundaryKind::outflow, received.boundary[1].kind);
  EXPECT_EQ(3.0, received.boundary[2].velocity[2]);
  ASSERT_EQ(3U, received.boundary[4].velocity_expressions.size());
  EXPECT_EQ(1, received.boundary[4].velocity_expressions[2].length);
  EXPECT_EQ(flow::Turbulence::vreman, received.turbulence);
  EXPECT_EQ(77, received.max_steps);
  EXPECT_EQ(flow::Driver::plain, received.driver);
}

TEST(FlowParametersMessage, RejectsTruncatedMessages) {
  std::string sent = message_of(uncommon_parameters());
  sent.pop_back();
  MessageReader reader(sent);
  EXPECT_THROW(static_cast<void>(get_parameters(reader)), std::out_of_range);
}

}  // namespace
}  // namespace drogue::parachute_app
