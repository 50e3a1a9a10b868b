#include "perf/occupancy.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "perf/dissertation.hpp"

namespace drogue::perf {
namespace {

Occupancy flux_kernel(int block) {
  return occupancy(fermi(), {block, dissertation::flux_registers, dissertation::flux_shared_bytes(block)});
}

TEST(Occupancy, IsTheDissertationsTable) {
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

// Shared memory has room for a block of 544 threads, and so have the threads; its registers do not fit.
TEST(Occupancy, OfABlockThatDoesNotFitIsZero) {
  const Occupancy got = flux_kernel(544);
  EXPECT_EQ(got.by_registers, 0);
  EXPECT_EQ(got.by_shared_memory, 1);
  EXPECT_EQ(got.by_threads, 2);
  EXPECT_EQ(got.blocks, 0);
  EXPECT_EQ(got.occupancy, 0.0);
}

// Blocks that cudaOccMaxActiveBlocksPerMultiprocessor of CUDA 13.0's cuda_occupancy.h gives for an sm_90.
TEST(Occupancy, OnHopperIsWhatCudasOwnHeaderGives) {
  const struct {
    Block block;
    int blocks;
  } cases[] = {
      {{128, 168, 16'464}, 3},  // registers
      {{128, 128, 47'184}, 4},  // both
      {{128, 128, 57'344}, 4},  // shared memory and the kilobyte kept, to the last byte
      {{128, 128, 57'345}, 3}, {{96, 168, 12'000}, 4},  // three warps: partitions are filled unevenly
      {{512, 128, 49'000}, 1},                          // registers, to the last
      {{512, 129, 49'000}, 0},                          // a warp gets 256 at a time
      {{416, 152, 1'000}, 0},                           // 13 warps count as 16
      {{384, 168, 60'000}, 1}, {{32, 32, 64}, 32},      // the limit
      {{1024, 32, 64}, 2},                              // threads
      {{128, 16, 232'448}, 1}, {{128, 16, 232'449}, 0}};
  for (const auto& [block, blocks] : cases)
    EXPECT_EQ(occupancy(hopper(), block).blocks, blocks) << block.threads << " threads, " << block.registers
                                                         << " registers, " << block.shared_bytes << " bytes";
}

}  // namespace
}  // namespace drogue::perf
