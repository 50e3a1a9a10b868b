#include "kernels/device/profiling_counters.hpp"

#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>

// Counters of launches, fences, allocations and copies.

namespace drogue::device {
namespace {

using Space = DROGUE_TEST_SPACE;

struct NothingFunctor {
  KOKKOS_FUNCTION void operator()(int) const {}
};

TEST(ProfilingCounters, CountEachLaunchOnceAfterASecondStart) {
  start_profiling();
  start_profiling();
  const ProfilingCounters before = profiling_counters();
  Kokkos::parallel_for("nothing", Kokkos::RangePolicy<Space>(0, 1), NothingFunctor{});
  const Kokkos::View<double*, Space::memory_space> values(
      Kokkos::view_alloc(Kokkos::WithoutInitializing, "values"), 8);
  const ProfilingCounters after = profiling_counters();
  EXPECT_EQ(after.kernel_launches - before.kernel_launches, 1);
  EXPECT_EQ(after.allocations - before.allocations, 1);
}

}  // namespace
}  // namespace drogue::device
