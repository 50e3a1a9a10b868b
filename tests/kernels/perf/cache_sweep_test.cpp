// ctest-label: no-sanitizer
#include "perf/memory/cache_sweep.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/backend.hpp"

namespace drogue::perf {
namespace {

TEST(CacheSweep, ReadsEachSectorOfItsBuffer) {
  constexpr std::int64_t bytes = std::int64_t{3} << 20;
  const auto sweep = create_cache_sweep(device::needs_device(testing::tested_backend), bytes);
  for (int time = 0; time < 2; ++time) EXPECT_EQ(sweep(), bytes / 32);
}

TEST(CacheSweep, NeedsCompiledBackendOfADevice) {
  if (!device::needs_device(testing::tested_backend)) {
    EXPECT_THROW(static_cast<void>(create_cache_sweep(true, 1024)), std::invalid_argument);
  }
}

}  // namespace
}  // namespace drogue::perf
