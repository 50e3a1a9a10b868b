#include "perf/models/step_bytes.hpp"

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

/// Bytes per cell.
double bytes(flow::Parameters p, const std::array<int, 3>& cells) {
  p.cells = cells;
  return flow_step_bytes(p) / (static_cast<double>(cells[0]) * cells[1] * cells[2]);
}

TEST(FlowStepBytes, CountEachArrayOfEachKernelOnce) {
  flow::Parameters p;
  p.time_scheme = flow::TimeScheme::ab2;
  // Momentum 96, divergence 32, transforms and scaling 7 x 16, correction 56 and the pressure.
  EXPECT_EQ(bytes(p, {64, 32, 16}), 304.0);
  // In two dimensions five passes of transforms and scaling.
  EXPECT_EQ(bytes(p, {64, 64, 1}), 272.0);
  p.time_scheme = flow::TimeScheme::rk3;
  // Momentum 48 + 2 x 72.
  EXPECT_EQ(bytes(p, {64, 32, 16}), 192.0 + 3 * 200.0 + 8.0);
  p.time_scheme = flow::TimeScheme::ab2;
  p.diffusion = flow::Diffusion::crank_nicolson;
  EXPECT_EQ(bytes(p, {64, 32, 16}), 296.0 + 3 * (32.0 + 112.0 + 24.0) + 24.0);
  p.diffusion = flow::Diffusion::explicit_;
  p.turbulence = flow::Turbulence::vreman;
  EXPECT_EQ(bytes(p, {64, 32, 16}), 304.0 + 112.0);
}

}  // namespace
}  // namespace drogue::perf
