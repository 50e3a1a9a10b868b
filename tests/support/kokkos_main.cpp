#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "kernels/device/runtime.hpp"

/// Main function of tests that use Kokkos, which is initialised as in the programs. Listing the cases starts
/// no backend, so it works without a device.
int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (::testing::FLAGS_gtest_list_tests) return RUN_ALL_TESTS();
  const drogue::device::Runtime runtime(std::vector<std::string>(argv + 1, argv + argc));
  return RUN_ALL_TESTS();
}
