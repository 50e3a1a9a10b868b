#include <gtest/gtest.h>

#include "kernels/device/launch.hpp"
#include "kernels/options/batch/pide_pricer.hpp"
#include "tests/support/backend.hpp"

// Coupling of a pricer to other kernels on the device.

namespace drogue::options {
namespace {

using Space = DROGUE_TEST_SPACE;

/// Copies prices to a View of another kernel.
struct ReadPrices {
  Kokkos::View<Price*, Space::memory_space> from;
  Kokkos::View<double*, Space::memory_space> to;

  KOKKOS_FUNCTION void operator()(const int i) const { to(i) = from(i).price; }
};

TEST(OptionsCoupling, PricesOfABatchStayOnTheDeviceInTheOrderOfTheContracts) {
  std::vector<Contract> contracts;
  for (int i = 0; i < 9; ++i)
    contracts.push_back({.style = i % 2 == 0 ? Style::american : Style::european,
                         .spot = 80.0 + 5.0 * i,
                         .strike = 100.0,
                         .rate = 0.05,
                         .maturity = 1.0,
                         .variance = 0.04,
                         .jump = {0.8, 10.0, -2.0, 0.2}});
  const Settings settings{.mesh = 128, .steps = 32};
  std::vector<Price> expected(contracts.size()), prices(contracts.size());
  create_pricer(testing::tested_backend, settings)->price(contracts, expected);

  const device::Instance<Space> instance(1);
  PidePricer<Space> pricer(instance, settings);
  pricer.price(contracts, prices);
  const ReadPrices read{pricer.prices(), decltype(ReadPrices::to)("prices", contracts.size())};
  device::launch_each(instance.space(), "read_prices", static_cast<int>(contracts.size()), read);
  instance.space().fence("test");
  const auto values = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), read.to);
  for (std::size_t i = 0; i < contracts.size(); ++i) {
    EXPECT_EQ(prices[i].price, expected[i].price);
    EXPECT_EQ(values(i), expected[i].price);
  }
}

}  // namespace
}  // namespace drogue::options
