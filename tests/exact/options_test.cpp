#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "kernels/device/runtime.hpp"
#include "kernels/options/pricer.hpp"
#include "tests/support/cuda_device.hpp"
#include "tests/support/option_sets.hpp"

// All backends and numbers of threads yield the same bits. Kokkos starts once per process, so each run is a
// child process that returns its bytes in a file.

namespace drogue {
namespace {

using testing::in_child;

/// Bytes of all prices without padding.
std::string price_bytes(device::Backend backend, const options::Settings& settings,
                        const std::vector<options::Contract>& contracts) {
  std::vector<options::Price> prices(contracts.size());
  options::create_pricer(backend, settings)->price(contracts, prices);
  std::string bytes;
  for (const options::Price& p : prices) {
    for (const double value : {p.price, p.error, p.delta, p.gamma, p.theta, p.exercise_boundary})
      bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));  // NOLINT: bits are compared
    bytes += std::to_string(p.mesh) + "," + std::to_string(static_cast<int>(p.status)) + ";";
  }
  return bytes;
}

void expect_same_prices(const options::Settings& settings, const std::vector<options::Contract>& contracts) {
  std::string serial;
  for (const device::Backend backend : device::compiled_backends()) {
    if (!testing::runs_in_child(backend)) continue;
    for (const int threads : {1, 2, 4}) {
      if (threads > 1 && backend != device::Backend::openmp) continue;
      const std::string bytes = in_child([&] {
        const device::Runtime runtime({"--kokkos-num-threads=" + std::to_string(threads)});
        return price_bytes(backend, settings, contracts);
      });
      EXPECT_GT(bytes.size(), 48 * contracts.size());
      if (serial.empty()) serial = bytes;
      EXPECT_TRUE(bytes == serial) << device::name(backend) << " with " << threads << " threads";
    }
  }
}

std::vector<options::Contract> of_all_models() {
  auto contracts = testing::random_contracts(25, 8);
  for (std::size_t k = 0; k < 6; ++k) {
    options::Contract& c = contracts[4 * k];
    c.model = k < 2   ? options::JumpModel::kou
              : k < 4 ? options::JumpModel::merton
                      : options::JumpModel::black_scholes;
    const double jump[4] = {0.4, 0.3, k < 2 ? 6.0 : 0.2, 4.0};
    for (int m = 0; m < 4; ++m) c.jump[m] = jump[m];
  }
  contracts[1].rate = -0.04;  // exercise between two boundaries
  contracts[1].dividend = -0.08;
  contracts[1].type = options::Type::put;
  contracts[1].style = options::Style::american;
  return contracts;
}

TEST(OptionsExact, BackendsAgreeOnAFixedMesh) {
  options::Settings settings;
  settings.mesh = 96;
  settings.steps = 24;
  expect_same_prices(settings, of_all_models());
}

// Spots in the last cells of the grids, beyond them, and below the grids.
TEST(OptionsExact, BackendsAgreeAtTheEndsOfTheGrid) {
  std::vector<options::Contract> contracts;
  for (int k = -20; k < 60; ++k) {
    options::Contract c = testing::random_contracts(1, 8)[0];
    c.style = k % 2 == 0 ? options::Style::american : options::Style::european;
    c.type = options::Type::put;
    c.maturity = 0.05;
    c.spot = c.strike * std::exp(0.05 * k);
    contracts.push_back(c);
  }
  options::Settings settings;
  settings.steps = 16;
  for (const int mesh : {64, 128, 256}) {
    settings.mesh = mesh;
    expect_same_prices(settings, contracts);
  }
}

// More contracts per class of models than a GPU prices with two warps each; the other tests have fewer.
TEST(OptionsExact, BackendsAgreeOnLargeBatches) {
  std::vector<options::Contract> contracts;
  for (int k = 0; k < 600; ++k)
    for (options::Contract c : of_all_models()) {
      if (c.model == options::JumpModel::generalized_hyperbolic && k % 10 != 0) continue;
      c.spot *= 1.0 + 0.0001 * k;
      contracts.push_back(c);
    }
  options::Settings settings;
  settings.mesh = 128;
  settings.steps = 32;
  expect_same_prices(settings, contracts);
}

// Sums over jumps by transforms, on CUDA in registers and in memory.
TEST(OptionsExact, BackendsAgreeOnTransformedMeshes) {
  options::Settings settings;
  settings.steps = 16;
  for (const int mesh : {256, 1024}) {
    settings.mesh = mesh;
    expect_same_prices(settings, of_all_models());
  }
}

TEST(OptionsExact, BackendsAgreeOnAMeshChosenByTolerance) {
  options::Settings settings;
  settings.tolerance = 3e-5;
  expect_same_prices(settings, of_all_models());
}

/// Near and far strikes of every contract.
std::vector<options::Contract> strikes_of_all_models() {
  std::vector<options::Contract> contracts;
  for (options::Contract c : of_all_models())
    for (const double ratio : {0.3, 0.8, 1.0, 1.1, 2.5}) {
      c.strike = ratio * c.spot;
      contracts.push_back(c);
    }
  return contracts;
}

TEST(OptionsExact, BackendsAgreeOnSurfacesOnAFixedMesh) {
  options::Settings settings;
  settings.mesh = 96;
  settings.steps = 24;
  settings.surface = true;
  expect_same_prices(settings, strikes_of_all_models());
}

TEST(OptionsExact, BackendsAgreeOnSurfacesChosenByTolerance) {
  options::Settings settings;
  settings.tolerance = 3e-5;
  settings.surface = true;
  expect_same_prices(settings, strikes_of_all_models());
}

}  // namespace
}  // namespace drogue
