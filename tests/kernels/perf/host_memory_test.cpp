// ctest-label: no-sanitizer
#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <memory_resource>
#include <numeric>
#include <vector>

#include "perf/memory/memory.hpp"
#include "tests/support/backend.hpp"

// Memory of arrays that tables of transfers copy.

namespace drogue::perf {
namespace {

TEST(HostMemory, HoldsArraysOfEitherKind) {
  for (const HostMemory kind : {HostMemory::pageable, HostMemory::pinned}) {
    const auto memory = host_memory(testing::tested_backend, kind);
    std::pmr::vector<double> values(1000, 1.0, memory.get());
    std::partial_sum(values.begin(), values.end(), values.begin());
    EXPECT_EQ(values.back(), 1000.0) << name(kind);
    EXPECT_EQ(values.get_allocator().resource(), memory.get());
#if defined(KOKKOS_ENABLE_CUDA)
    if (device::needs_device(testing::tested_backend)) {
      cudaPointerAttributes attributes{};
      ASSERT_EQ(cudaPointerGetAttributes(&attributes, values.data()), cudaSuccess);
      EXPECT_EQ(attributes.type == cudaMemoryTypeHost, kind == HostMemory::pinned) << name(kind);
    }
#endif
  }
}

}  // namespace
}  // namespace drogue::perf
