#include <gtest/gtest.h>

#include "miniapps/parachute/verify/target.hpp"

namespace drogue::parachute_app {
namespace {

TEST(Targets, HoldRelativeAndAbsoluteIntervals) {
  run::ResultDocument result;
  check_target(result, "force", -0.32, {-0.3, 0.1});
  check_target(result, "drag", 0.5, {0.3, 0.1});
  check_distance(result, "place", 2.5, 2.0, 1.0);
  ASSERT_EQ(result.checks.size(), 3);
  EXPECT_NEAR(result.checks[0].value, 0.02 / 0.3, 1e-15);
  EXPECT_EQ(result.checks[0].tolerance, 0.1);
  EXPECT_EQ(result.checks[0].measured(), "-0.32 in [-0.33, -0.27]");
  EXPECT_EQ(result.checks[1].measured(), "0.5 not in [0.27, 0.33]");
  EXPECT_EQ(result.checks[2].value, 0.5);
  EXPECT_EQ(result.checks[2].measured(), "2.5 in [1, 3]");
}

}  // namespace
}  // namespace drogue::parachute_app
