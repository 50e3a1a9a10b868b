#include "perf/measure/repeats.hpp"

#include <gtest/gtest.h>

namespace drogue::perf {
namespace {

TEST(Repeats, FillTheShortestSample) {
  EXPECT_EQ(repeats_of(1e-3, 1e-3), 5);
  EXPECT_EQ(repeats_of(0.9e-3, 0.9e-3), 6);
  EXPECT_EQ(repeats_of(5e-3, 5e-3), 1);
  EXPECT_EQ(repeats_of(1.0, 1.0), 1);
}

TEST(Repeats, AreBoundedForShortWorks) {
  EXPECT_EQ(repeats_of(1e-9, 1e-9), 200);
  EXPECT_EQ(repeats_of(0.0, 0.0), 200);
}

// 20 steps that compute for a millisecond, between copies that take ten.
TEST(Repeats, AreFewerIfThatWhichIsNotTimedTakesLonger) {
  EXPECT_EQ(repeats_of(1e-3, 10e-3), 2);
  EXPECT_EQ(repeats_of(1e-3, 30e-3), 1);
}

}  // namespace
}  // namespace drogue::perf
