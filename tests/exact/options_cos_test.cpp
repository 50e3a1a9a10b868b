#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "kernels/device/runtime.hpp"
#include "kernels/options/cos/pricer.hpp"
#include "tests/support/cuda_device.hpp"
#include "tests/support/in_child.hpp"
#include "tests/support/option_sets.hpp"

// Every backend and every number of threads prices options by Fourier's series to the same bits.

namespace drogue::options {
namespace {

std::string cos_bytes(device::Backend backend, int threads) {
  const device::Runtime runtime({"--kokkos-num-threads=" + std::to_string(threads)});
  std::vector<Contract> contracts;
  for (const auto& set : testing::option_sets())
    for (const Type type : {Type::put, Type::call}) {
      contracts.push_back(testing::contract_of(set, 3, Style::american));
      contracts.back().type = type;
      contracts.back().dividend = 0.02;
    }
  Settings settings;
  settings.method = Method::cos;
  settings.tolerance = 1e-3;
  settings.greeks = true;
  std::vector<Price> prices(contracts.size());
  create_cos_pricer(backend, settings)->price(contracts, prices);
  std::string bytes;
  for (const Price& p : prices)
    for (const double value : {p.price, p.error, p.delta, p.gamma, p.theta})
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);  // NOLINT: bits are what is compared
  return bytes;
}

TEST(ExactOptionsCos, BackendsAndThreadsAgree) {
  const std::string serial = testing::in_child([] { return cos_bytes(device::Backend::serial, 1); });
  ASSERT_EQ(serial.size(), 16 * 5 * sizeof(double));
  for (const device::Backend backend : device::compiled_backends()) {
    if (backend == device::Backend::serial || !testing::runs_in_child(backend)) continue;
    for (const int threads : {1, 3})
      EXPECT_TRUE(testing::in_child([&] { return cos_bytes(backend, threads); }) == serial)
          << name(backend) << ", " << threads << " threads";
  }
}

}  // namespace
}  // namespace drogue::options
