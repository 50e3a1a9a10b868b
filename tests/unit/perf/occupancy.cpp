#include "perf/models/occupancy.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "perf/tables/dissertation.hpp"

namespace drogue::perf {
namespace {

Occupancy flux_kernel(int block) {
  return occupancy(fermi(), {block, dissertation::flux_registers, dissertation::flux_shared_bytes(block)});
}

TEST(Occupancy, EqualsTable42OfTheDissertation) {
  for (const dissertation::OccupancyRow& printed : dissertation::table_4_2) {
    const Occupancy got = flux_kernel(printed.block);
    EXPECT_EQ(dissertation::flux_shared_bytes(printed.block), printed.shared_bytes);
    EXPECT_EQ(got.by_registers, printed.by_registers) << printed.block;
    EXPECT_EQ(got.by_shared_memory, printed.by_shared_memory) << printed.block;
    EXPECT_EQ(got.by_limit, printed.by_limit) << printed.block;
    EXPECT_EQ(got.blocks, printed.blocks) << printed.block;
    EXPECT_EQ(got.threads, printed.threads) << printed.block;
    EXPECT_EQ(got.device_threads, printed.device_threads) << printed.block;
    EXPECT_EQ(std::round(1000.0 * got.occupancy), std::round(10.0 * printed.percent)) << printed.block;
  }
}

// A block of 544 threads fits into shared memory and the thread limit, but not into the registers.
TEST(Occupancy, IsZeroForABlockThatDoesNotFit) {
  const Occupancy got = flux_kernel(544);
  EXPECT_EQ(got.by_registers, 0);
  EXPECT_EQ(got.by_shared_memory, 1);
  EXPECT_EQ(got.by_threads, 2);
  EXPECT_EQ(got.blocks, 0);
  EXPECT_EQ(got.occupancy, 0.0);
}

// Results of cudaOccMaxActiveBlocksPerMultiprocessor in cuda_occupancy.h of CUDA 13.0 for an sm_90.
TEST(Occupancy, EqualsTheOccupancyCalculatorOfCudaForHopper) {
  const struct {
    Block block;
    int blocks;
  } cases[] = {
      {{128, 168, 16'464}, 3},  // registers
      {{128, 128, 47'184}, 4},  // both
      {{128, 128, 57'344}, 4},  // shared memory with the reserved kilobyte, exactly full
      {{128, 128, 57'345}, 3}, {{96, 168, 12'000}, 4},  // three warps: partitions are filled unevenly
      {{512, 128, 49'000}, 1},                          // registers, exactly full
      {{512, 129, 49'000}, 0},                          // registers are allocated in units of 256 per warp
      {{416, 152, 1'000}, 0},                           // 13 warps are rounded up to 16
      {{384, 168, 60'000}, 1}, {{32, 32, 64}, 32},      // the limit
      {{1024, 32, 64}, 2},                              // threads
      {{128, 16, 232'448}, 1}, {{128, 16, 232'449}, 0}};
  for (const auto& [block, blocks] : cases)
    EXPECT_EQ(occupancy(hopper(), block).blocks, blocks) << block.threads << " threads, " << block.registers
                                                         << " registers, " << block.shared_bytes << " bytes";
}

}  // namespace
}  // namespace drogue::perf
