#include "perf/clocks/gpu_clocks.hpp"

#include <gtest/gtest.h>

namespace drogue::perf {
namespace {

TEST(GpuClocks, ReadsClocksAndReasonsOfThrottling) {
  const GpuClocks clocks("0000:19:00.0", DROGUE_FAKE_NVML);
  const auto first = clocks.read(), second = clocks.read();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->sm_mhz, 1980U);
  EXPECT_EQ(first->memory_mhz, 2619U);
  EXPECT_TRUE(first->throttled.empty());
  EXPECT_EQ(second->sm_mhz, 1500U);
  EXPECT_EQ(second->throttled, std::vector<std::string>{"power cap"});
  const ClockReading all = summarize({*first, *second, *second});
  EXPECT_EQ(all.sm_mhz, 1500U);
  EXPECT_EQ(all.throttled, std::vector<std::string>{"power cap"});
  EXPECT_FALSE(GpuClocks("0000:1a:00.0", DROGUE_FAKE_NVML).read());
}

TEST(GpuClocks, HaveNoReadingsWithoutLibraryOrGpu) {
  EXPECT_FALSE(GpuClocks("0000:19:00.0", "libdrogue-missing.so").read());
  EXPECT_FALSE(GpuClocks("0000:ff:00.0", DROGUE_FAKE_NVML).read());
  EXPECT_FALSE(GpuClocks("", DROGUE_FAKE_NVML).read());
}

}  // namespace
}  // namespace drogue::perf
