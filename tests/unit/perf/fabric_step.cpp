#include "perf/models/fabric_step.hpp"

#include <gtest/gtest.h>

namespace drogue::perf {
namespace {

TEST(FabricStepBytes, CountEachArrayOfEachKernelOnce) {
  // First half 6 vectors, second half 8, twice rest positions, inverse mass and axes.
  EXPECT_EQ(fabric_step_bytes(FabricKernels::halves, 1, 0), 144.0 + 192.0 + 2 * 33.0);
  // Four stages of 6 vectors, inverse mass and axes; one vector less in the first, two more in the last.
  EXPECT_EQ(fabric_step_bytes(FabricKernels::stages, 1, 0), 4 * 153.0 + 24.0);
}

TEST(FabricStepBytes, CountSlotsOnceAKernel) {
  EXPECT_EQ(
      fabric_step_bytes(FabricKernels::halves, 10, 70) - fabric_step_bytes(FabricKernels::halves, 10, 0),
      70 * 2 * 4.0);
  EXPECT_EQ(
      fabric_step_bytes(FabricKernels::stages, 10, 70) - fabric_step_bytes(FabricKernels::stages, 10, 0),
      70 * 4 * 28.0);
}

}  // namespace
}  // namespace drogue::perf
