#include "perf/models/messages.hpp"

#include <gtest/gtest.h>

namespace drogue::perf {
namespace {

TEST(Messages, CountsRoundsThatWaitForOneAnother) {
  EXPECT_EQ(0, message_rounds({1, 1, 1}));
  EXPECT_EQ(3 + 1 + 2, message_rounds({1, 1, 2}));
  EXPECT_EQ(3 + 3 + 4, message_rounds({1, 1, 4}));
  EXPECT_EQ(3 + 2 + 2, message_rounds({1, 2, 1}));
  EXPECT_EQ(3 + 2 + 4 + 6, message_rounds({1, 2, 3}));
}

TEST(Messages, TakesBandwidthFromTheTimeBeyondTheLatency) {
  const Link link = make_link(2e-6, 12e-6, 1e5);
  EXPECT_DOUBLE_EQ(2e-6, link.latency);
  EXPECT_DOUBLE_EQ(1e10, link.bandwidth);
  EXPECT_DOUBLE_EQ(6e-6 + 1e-5, message_time(link, 3, 1e5));
  EXPECT_GT(make_link(2e-6, 1e-6, 1e5).bandwidth, 0.0);
}

TEST(Messages, EstimatesAStepOfTheLargestSlab) {
  const FlowMachine machine{.fixed_time = 1e-4,
                            .time_per_cell = 1e-9,
                            .in_node = {1e-5, 1e11},
                            .between_nodes = {2e-5, 1e10},
                            .ranks_per_node = 2};
  EXPECT_DOUBLE_EQ(1e-4 + 1e-6 * 70, estimate_step(machine, {100, 10, 70}, 1).total());
  const StepEstimate two = estimate_step(machine, {100, 10, 69}, 2);
  EXPECT_DOUBLE_EQ(1e-4 + 1e-6 * 35, two.compute);
  EXPECT_DOUBLE_EQ(3e-5 + 8.0 * 20.0 * 1000 / 1e11, two.ghosts);
  EXPECT_DOUBLE_EQ(1e-5 + 8.0 * 2.0 * 1000 / 1e11, two.gather);
  EXPECT_DOUBLE_EQ(2e-5, two.agreement);
  EXPECT_DOUBLE_EQ(two.compute + two.ghosts + two.gather + two.agreement, two.total());
  const StepEstimate three = estimate_step(machine, {100, 10, 69}, 3);
  EXPECT_DOUBLE_EQ(2 * (2e-5 + 8.0 * 2.0 * 1000 / 1e10), three.gather);
  EXPECT_DOUBLE_EQ(4 * 2e-5, three.agreement);
}

}  // namespace
}  // namespace drogue::perf
