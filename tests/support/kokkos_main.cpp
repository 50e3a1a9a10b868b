#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>

/// Main of the tests that use Kokkos. Listing the cases starts no backend, so it works without a device.
int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (testing::FLAGS_gtest_list_tests) return RUN_ALL_TESTS();
  const Kokkos::ScopeGuard kokkos(argc, argv);
  return RUN_ALL_TESTS();
}
