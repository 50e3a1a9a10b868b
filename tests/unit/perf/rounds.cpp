#include "perf/measure/rounds.hpp"

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

TEST(WarmUp, CountsWorkOnADeviceApartFromThatOnHosts) {
  WarmUp warmth;
  warmth.add(false, 5.0);
  EXPECT_TRUE(warmth.has_reached(1.0));
  warmth.add(true, 0.4);
  EXPECT_FALSE(warmth.has_reached(1.0)) << "work of hosts must not warm the device";
  warmth.add(true, 0.6);
  EXPECT_TRUE(warmth.has_reached(1.0));
}

TEST(WarmUp, WaitsForHostsWithoutADevice) {
  WarmUp warmth;
  warmth.add(false, 0.5);
  EXPECT_FALSE(warmth.has_reached(1.0));
  warmth.add(false, 0.5);
  EXPECT_TRUE(warmth.has_reached(1.0));
}

TEST(WarmUp, GoesOnWhileTheClockRises) {
  WarmUp warmth;
  warmth.add(true, 1.0);
  EXPECT_TRUE(warmth.is_over(1.0)) << "no clock is known";
  warmth.add_clock(345);
  EXPECT_TRUE(warmth.is_over(1.0)) << "one reading shows no change";
  warmth.add_clock(1980);
  EXPECT_FALSE(warmth.is_over(1.0));
  warmth.add_clock(1985);
  EXPECT_TRUE(warmth.is_over(1.0)) << "settled";
  warmth.add_clock(1500);
  EXPECT_TRUE(warmth.is_over(1.0)) << "throttled, which no warm-up mends";
  warmth.add_clock(1980);
  EXPECT_FALSE(warmth.is_over(1.0));
  warmth.add(true, 1.0);
  EXPECT_TRUE(warmth.is_over(1.0)) << "twice the time is enough";
}

}  // namespace
}  // namespace drogue::perf
