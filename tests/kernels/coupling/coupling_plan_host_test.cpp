#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "kernels/coupling/sheet/block_plan.hpp"

// Blocks of equal steps, and batches of them.

namespace drogue::coupling {
namespace {

constexpr double dt = 0.125;  // exact sums

flow::Progress at(std::int64_t step, double time) {
  flow::Progress now;
  now.step = step, now.time = time;
  return now;
}

/// Plan with a block of `steps` steps of the flow, each of two of the cloth, that has been taken.
BlockPlan after_block(std::int64_t steps, double fixed_dt = 0.0) {
  Parameters p;
  p.flow.fixed_dt = fixed_dt;
  p.longest_batch = 1.0;
  BlockPlan plan(p);
  if (steps == 0) return plan;
  plan.begin(at(0, 0.0), dt, 2);
  static_cast<void>(plan.begin_batch(0, steps));
  plan.end_batch(steps, 2 * steps, 0.5);
  plan.end_at(steps);
  return plan;
}

TEST(BlockPlan, NextStepFollowsTheFlowTheLastBlockAndTheTarget) {
  struct Case {
    const char* name;
    std::int64_t steps;  ///< of the block before
    double fixed_dt, admissible, left, expected;
  };
  const std::vector<Case> cases = {
      {"the first block", 0, 0.0, 0.3, 100.0, 0.3},
      {"growth by a factor of two", 16, 0.0, 1.0, 1000.0, 2.0 * dt},
      {"less growth", 16, 0.0, 1.5 * dt, 1000.0, 1.5 * dt},
      {"after a single step", 1, 0.0, 1.0, 1000.0, 1.0},
      {"a target within two blocks", 0, 0.0, 0.3, 3.0, 3.0 / 10.0},
      {"a target in fewer than 32 steps", 0, 0.0, 0.3, 9.5, 9.5 / 32.0},
      {"a target beyond two blocks", 0, 0.0, 0.3, 9.7, 0.3},
      {"a target closer than a step", 0, 0.0, 0.3, 0.1, 0.1},
      {"no step for a rounding", 0, 0.0, 0.25, 0.5 * (1.0 + 1e-10), 0.25 * (1.0 + 1e-10)},
      {"a fixed step", 16, 0.2, 1.0, 0.5, 0.2},
  };
  for (const Case& c : cases) {
    const BlockPlan plan = after_block(c.steps, c.fixed_dt);
    EXPECT_DOUBLE_EQ(plan.next_dt(0.0, c.left, c.admissible), c.expected) << c.name;
  }
}

TEST(BlockPlan, BlocksOfAFrameThatFollowsAFallGrowWithTheTimeSoFar) {
  Parameters p;
  p.follow.vertices = {{0, 1.0}};
  p.follow.axes = {false, false, true};
  const auto steps = [&](double time) {
    BlockPlan plan(p);
    plan.begin(at(100, time), dt, 2);
    return plan.block().end - 100;
  };
  EXPECT_EQ(steps(0.0), 16) << "without gravity";
  p.fabric.gravity = {0.0, 9.81, 0.0};
  EXPECT_EQ(steps(0.0), 16) << "gravity across the axes that it follows";
  p.fabric.gravity = {0.0, 0.0, -9.81};
  EXPECT_EQ(steps(0.0), 1);
  EXPECT_EQ(steps(47.0 * dt), 2);
  EXPECT_EQ(steps(48.0 * dt), 3);
  EXPECT_EQ(steps(256.0 * dt), 16);
  EXPECT_EQ(steps(1e9), 16);
  p.follow = {};
  EXPECT_EQ(steps(0.0), 16) << "a frame at rest";
}

TEST(BlockPlan, BlocksOfASingleStepBoundTheNextStepWhereTheyArePlanned) {
  Parameters p;
  p.longest_batch = 1.0;
  p.follow.vertices = {{0, 1.0}};
  p.follow.axes = {false, false, true};
  p.fabric.gravity = {0.0, 0.0, -9.81};
  BlockPlan plan(p);
  EXPECT_EQ(plan.longest_dt(100.0), 100.0);
  plan.begin(at(0, 0.0), dt, 2);
  ASSERT_EQ(plan.block().end, 1);
  static_cast<void>(plan.begin_batch(0, 1));
  plan.end_batch(1, 2, 0.5);
  EXPECT_EQ(plan.longest_dt(100.0), 2.0 * dt);
}

TEST(BlockPlan, DividesWhatIsLeftToATarget) {
  struct Case {
    std::int64_t step;
    double target;
    std::int64_t end;
    double step_dt;
  };
  for (const Case& c : std::vector<Case>{{4, 16 * dt, 16, dt},            // the end of the block
                                         {4, 20 * dt, 16, dt},            // beyond
                                         {4, 7 * dt, 7, dt},              // whole steps
                                         {4, 6.5 * dt, 7, 2.5 * dt / 3},  // a fraction
                                         {4, 4.25 * dt, 5, 0.25 * dt}}) {
    BlockPlan plan = after_block(0);
    plan.begin(at(0, 0.0), dt, 2);
    static_cast<void>(plan.begin_batch(0, c.step));
    plan.end_batch(c.step, 2 * c.step, 0.5);
    const double now = static_cast<double>(c.step) * dt;
    plan.divide_rest(at(c.step, now), c.target);
    EXPECT_EQ(plan.block().end, c.end) << c.target;
    EXPECT_DOUBLE_EQ(plan.block().dt, c.step_dt) << c.target;
    EXPECT_EQ(plan.cloth_time().step, 2 * c.step);
    EXPECT_DOUBLE_EQ(plan.cloth_time().dt, 0.5 * c.step_dt);
    EXPECT_DOUBLE_EQ(plan.cloth_time().time(), now);
  }
}

TEST(BlockPlan, BatchesGrowWhileTheyAreShort) {
  BlockPlan plan = after_block(0);
  plan.begin(at(0, 0.0), dt, 1);
  std::vector<std::int64_t> taken;
  const auto take = [&](std::int64_t left, double seconds) {
    const std::int64_t steps = plan.begin_batch(0, left);
    plan.end_batch(steps, 0, seconds);
    taken.push_back(steps);
  };
  for (int k = 0; k < 6; ++k) take(100, 0.1);
  EXPECT_EQ(taken, (std::vector<std::int64_t>{1, 2, 4, 8, 16, 16})) << "no longer than a block";
  take(100, 1.5), take(100, 0.8), take(3, 0.1), take(100, 0.8);
  EXPECT_EQ(taken.back(), 8) << "halved after a long one; one that a pause ends says nothing";
  EXPECT_EQ(plan.begin_batch(10, 100), 6) << "to the end of the block";
}

TEST(BlockPlan, ReturnsWithinABatch) {
  BlockPlan plan = after_block(0);
  plan.begin(at(0, 0.0), dt, 3);
  static_cast<void>(plan.begin_batch(0, 8));
  plan.end_batch(8, 24, 0.1);
  static_cast<void>(plan.begin_batch(8, 4));
  plan.end_batch(4, 36, 0.1);
  plan.return_to(at(10, 10 * dt));
  EXPECT_EQ(plan.cloth_time().step, 30);
  EXPECT_EQ(plan.cloth_time().since, 30);
  EXPECT_EQ(plan.cloth_time().time(), 10 * dt);
}

}  // namespace
}  // namespace drogue::coupling
