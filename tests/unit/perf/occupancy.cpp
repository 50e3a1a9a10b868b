#include "perf/models/occupancy.hpp"

#include <gtest/gtest.h>

#if __has_include(<cuda_occupancy.h>)
#include <cuda_occupancy.h>
#endif

#include <cmath>
#include <iterator>
#include <random>
#include <string>

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

// Blocks that cudaOccMaxActiveBlocksPerMultiprocessor in cuda_occupancy.h of CUDA 13.0 gives with all shared
// memory preferred.
TEST(Occupancy, EqualsTheOccupancyCalculatorOfCudaForAllArchitectures) {
  constexpr Block blocks[] = {{32, 32, 0},       {96, 63, 12'000}, {128, 40, 0},     {256, 60, 8'192},
                              {512, 63, 24'576}, {1024, 32, 0},    {416, 48, 1'000}, {128, 63, 49'152}};
  const struct {
    const char* name;
    int resident[std::size(blocks)];
  } cases[] = {{"sm_30", {16, 4, 12, 4, 2, 2, 3, 1}},   {"sm_32", {16, 4, 12, 4, 2, 2, 3, 1}},
               {"sm_35", {16, 4, 12, 4, 2, 2, 3, 1}},   {"sm_37", {16, 9, 16, 8, 4, 2, 4, 2}},
               {"sm_50", {32, 5, 12, 4, 2, 2, 3, 1}},   {"sm_52", {32, 8, 12, 4, 2, 2, 3, 2}},
               {"sm_53", {32, 5, 12, 4, 2, 2, 3, 1}},   {"sm_60", {32, 5, 12, 4, 2, 2, 3, 1}},
               {"sm_61", {32, 8, 12, 4, 2, 2, 3, 2}},   {"sm_62", {32, 5, 12, 4, 2, 2, 3, 1}},
               {"sm_70", {32, 8, 12, 4, 2, 2, 3, 2}},   {"sm_72", {32, 8, 12, 4, 2, 2, 3, 2}},
               {"sm_75", {16, 5, 8, 4, 2, 1, 2, 1}},    {"sm_80", {32, 10, 12, 4, 2, 2, 3, 3}},
               {"sm_86", {16, 7, 12, 4, 2, 1, 3, 2}},   {"sm_87", {16, 10, 12, 4, 2, 1, 3, 3}},
               {"sm_88", {16, 7, 12, 4, 2, 1, 3, 2}},   {"sm_89", {24, 7, 12, 4, 2, 1, 3, 2}},
               {"sm_90", {32, 10, 12, 4, 2, 2, 3, 4}},  {"sm_100", {32, 10, 12, 4, 2, 2, 3, 4}},
               {"sm_103", {32, 10, 12, 4, 2, 2, 3, 4}}, {"sm_110", {24, 10, 12, 4, 2, 1, 3, 4}},
               {"sm_120", {24, 7, 12, 4, 2, 1, 3, 2}},  {"sm_121", {24, 7, 12, 4, 2, 1, 3, 2}}};
  for (const auto& [name, resident] : cases) {
    ASSERT_NE(find_architecture(name), nullptr) << name;
    for (std::size_t i = 0; i < std::size(blocks); ++i)
      EXPECT_EQ(occupancy(*find_architecture(name), blocks[i]).blocks, resident[i])
          << name << ", block " << i;
  }
  EXPECT_EQ(std::size(cases) + 2, architectures().size()) << "the calculator of CUDA begins at 3.0";
}

#if __has_include(<cuda_occupancy.h>)
/// Resident blocks by CUDA's own calculator, with all shared memory preferred; -1 for an architecture that is
/// newer than the header.
int blocks_by_cuda(const Architecture& on, const Block& block) {
  const int capability = std::stoi(std::string(on.name.substr(3)));
  cudaOccDeviceProp device;
  device.computeMajor = capability / 10;
  device.computeMinor = capability % 10;
  device.maxThreadsPerBlock = largest_block;
  device.maxThreadsPerMultiprocessor = on.threads;
  device.regsPerBlock = on.block_registers;
  device.regsPerMultiprocessor = on.registers;
  device.warpSize = 32;
  device.sharedMemPerBlock = 48 * 1024;
  device.sharedMemPerMultiprocessor = static_cast<std::size_t>(on.shared_bytes);
  device.sharedMemPerBlockOptin = static_cast<std::size_t>(on.block_shared_bytes);
  device.reservedSharedMemPerBlock = static_cast<std::size_t>(on.reserved_bytes);
  device.numSms = 1;
  cudaOccFuncAttributes kernel;
  kernel.maxThreadsPerBlock = largest_block;
  kernel.numRegs = block.registers;
  kernel.shmemLimitConfig = FUNC_SHMEM_LIMIT_OPTIN;
  kernel.maxDynamicSharedSizeBytes = static_cast<std::size_t>(block.shared_bytes);
  cudaOccDeviceState state;
  state.cacheConfig = CACHE_PREFER_SHARED;
  state.carveoutConfig = SHAREDMEM_CARVEOUT_MAX_SHARED;
  cudaOccResult result{};
  const cudaOccError error = cudaOccMaxActiveBlocksPerMultiprocessor(
      &result, &device, &kernel, &state, block.threads, static_cast<std::size_t>(block.shared_bytes));
  return error == CUDA_OCC_SUCCESS ? result.activeBlocksPerMultiprocessor : -1;
}

TEST(Occupancy, EqualsTheHeaderOfCudaForRandomBlocks) {
  std::mt19937 random(1);
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  for (const Architecture& on : architectures().subspan(2))  // the header begins at 3.0
    for (int i = 0; i < 20'000; ++i) {
      const Block block{1 + below(largest_block), 1 + below(on.thread_registers),
                        i % 3 == 0 ? 0 : below(i % 3 == 1 ? 20'000 : 240'000)};
      const int expected = blocks_by_cuda(on, block);
      if (expected < 0) break;
      ASSERT_EQ(occupancy(on, block).blocks, expected)
          << on.name << ": " << block.threads << " threads, " << block.registers << " registers, "
          << block.shared_bytes << " bytes";
    }
}
#endif

// The tables "Technical Specifications per Compute Capability" of the CUDA C++ Programming Guide.
TEST(Occupancy, LimitsOfArchitecturesArePublishedOnes) {
  const struct {
    const char* name;
    int warps, blocks, registers, block_registers, shared_kib, block_shared_kib;
  } cases[] = {{"2.0", 48, 8, 32, 32, 48, 48},     {"2.1", 48, 8, 32, 32, 48, 48},
               {"3.0", 64, 16, 64, 64, 48, 48},    {"3.2", 64, 16, 64, 32, 48, 48},
               {"3.5", 64, 16, 64, 64, 48, 48},    {"3.7", 64, 16, 128, 64, 112, 48},
               {"5.0", 64, 32, 64, 64, 64, 48},    {"5.2", 64, 32, 64, 64, 96, 48},
               {"5.3", 64, 32, 64, 32, 64, 48},    {"6.0", 64, 32, 64, 64, 64, 48},
               {"6.1", 64, 32, 64, 64, 96, 48},    {"6.2", 64, 32, 64, 32, 64, 48},
               {"7.0", 64, 32, 64, 64, 96, 96},    {"7.2", 64, 32, 64, 64, 96, 96},
               {"7.5", 32, 16, 64, 64, 64, 64},    {"8.0", 64, 32, 64, 64, 164, 163},
               {"8.6", 48, 16, 64, 64, 100, 99},   {"8.7", 48, 16, 64, 64, 164, 163},
               {"8.8", 48, 16, 64, 64, 100, 99},   {"8.9", 48, 24, 64, 64, 100, 99},
               {"9.0", 64, 32, 64, 64, 228, 227},  {"10.0", 64, 32, 64, 64, 228, 227},
               {"10.3", 64, 32, 64, 64, 228, 227}, {"11.0", 48, 24, 64, 64, 228, 227},
               {"12.0", 48, 24, 64, 64, 100, 99},  {"12.1", 48, 24, 64, 64, 100, 99}};
  EXPECT_EQ(std::size(cases), architectures().size());
  for (const auto& [name, warps, blocks, registers, block_registers, shared, block_shared] : cases) {
    const Architecture* a = find_architecture(name);
    ASSERT_NE(a, nullptr) << name;
    EXPECT_EQ(a->threads, 32 * warps) << name;
    EXPECT_EQ(a->blocks, blocks) << name;
    EXPECT_EQ(a->registers, 1024 * registers) << name;
    EXPECT_EQ(a->block_registers, 1024 * block_registers) << name;
    EXPECT_EQ(a->shared_bytes, 1024 * shared) << name;
    EXPECT_EQ(a->block_shared_bytes, 1024 * block_shared) << name;
    EXPECT_EQ(a->reserved_bytes, std::stod(name) < 8.0 ? 0 : 1024) << name;
  }
  EXPECT_EQ(find_architecture("4.0"), nullptr);
  EXPECT_EQ(find_architecture("sm_90"), find_architecture("9.0"));
}

// Allocation units leave table 4.2 as it is: the printed numbers do not need them.
TEST(Occupancy, UnitsOfFermiLeaveTable42) {
  for (const dissertation::OccupancyRow& printed : dissertation::table_4_2)
    EXPECT_EQ(occupancy(*find_architecture("2.0"), {printed.block, dissertation::flux_registers,
                                                    dissertation::flux_shared_bytes(printed.block)})
                  .blocks,
              printed.blocks)
        << printed.block;
}

TEST(Occupancy, CarveOutLimitsSharedMemory) {
  const Block block{64, 32, 15 * 1024};
  EXPECT_EQ(occupancy(hopper(), block).by_shared_memory, 14);
  EXPECT_EQ(occupancy(hopper(), block, 132 * 1024).by_shared_memory, 8);
  EXPECT_EQ(limits_of(occupancy(hopper(), block, 132 * 1024)), "shared memory");
  EXPECT_EQ(limits_of(occupancy(hopper(), {128, 128, 0})), "registers");
  EXPECT_EQ(limits_of(occupancy(hopper(), {64, 32, 0})), "registers and threads and blocks");
}

}  // namespace
}  // namespace drogue::perf
