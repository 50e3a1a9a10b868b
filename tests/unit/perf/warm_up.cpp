#include "perf/measure/warm_up.hpp"

#include <gtest/gtest.h>

namespace drogue::perf {
namespace {

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

}  // namespace
}  // namespace drogue::perf
