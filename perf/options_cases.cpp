#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "kernels/options/pricer.hpp"
#include "perf/measurement.hpp"

namespace drogue::perf {

namespace {

/// The dissertation's parameters, a year, r = 0.1, strike 1, and American puts at five spots: cosine series
/// with Romberg's extrapolation, to 1e-7.
constexpr options::Contract thesis{.rate = 0.1, .variance = 0.4, .jump = {1.0, 8.15, -2.5, 0.767}};
constexpr double known_spot[] = {0.8, 0.9, 1.0, 1.1, 1.2};
constexpr double known_price[] = {0.318658312, 0.275403193, 0.239004005, 0.208230166, 0.182096749};
/// What the dissertation's own scheme misses at mesh 128.
constexpr double bar = 4.4e-4;

/// Distinct American puts: the known ones first, then laws about the dissertation's.
std::vector<options::Contract> batch(std::size_t count) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  std::vector<options::Contract> contracts(count, thesis);
  for (std::size_t i = 0; i < count; ++i) {
    options::Contract& c = contracts[i];
    if (i < std::size(known_spot)) {
      c.spot = known_spot[i];
      continue;
    }
    c.spot = between(0.8, 1.2), c.rate = between(0.01, 0.1), c.maturity = between(0.25, 2.0);
    c.variance = between(0.0, 0.4);
    const double law[] = {between(-2.0, 2.0), between(6.0, 15.0), between(-4.0, 0.0), between(0.2, 1.0)};
    std::ranges::copy(law, c.jump);
  }
  return contracts;
}

Case batch_case(device::Backend backend, std::size_t count, int mesh, int steps) {
  struct Run {
    std::vector<options::Contract> contracts;
    std::vector<options::Price> prices;
    std::unique_ptr<options::Pricer> pricer;
    options::Timing timing;
  };
  const auto run = std::make_shared<Run>();
  const std::string name(device::name(backend)), grid = std::to_string(mesh) + "x" + std::to_string(steps);
  return {"options/" + name + "/" + std::to_string(count) + "/" + grid,
          "batch",
          "arithmetic of the convolution",
          [=] {
            run->contracts = batch(count);
            run->prices.resize(count);
            run->pricer = options::create_pricer(backend, {.mesh = mesh, .steps = steps});
            return Sample{[] {},
                          [=] {
                            run->timing = run->pricer->price(run->contracts, run->prices);
                            return 1L;
                          },
                          [=] {
                            return std::map<std::string, double>{{"h2d", run->timing.h2d},
                                                                 {"compute", run->timing.compute},
                                                                 {"d2h", run->timing.d2h}};
                          }};
          },
          [=] {
            double error = 0.0;
            for (std::size_t i = 0; i < std::min(count, std::size(known_price)); ++i)
              error = std::max(error, std::abs(run->prices[i].price - known_price[i]));
            return error;
          },
          bar,
          [=] {
            return Facts{name, static_cast<std::int64_t>(count), grid};
          }};
}

}  // namespace

std::vector<Case> options_cases(bool quick) {
  std::vector<Case> cases;
  for (const device::Backend backend : device::compiled_backends()) {
    if (!device::is_present(backend)) continue;
    const bool gpu = backend == device::Backend::cuda;
    const auto add = [&](std::size_t count, int mesh, int steps) {
      cases.push_back(batch_case(backend, count, mesh, steps));
    };
    if (quick) {
      add(16, 64, 16);
      continue;
    }
    add(1, 128, 32);
    add(gpu ? 4096 : 256, 128, 32);
    add(gpu ? 4096 : 256, 256, 64);
    if (gpu) add(1'000'000, 128, 32);
  }
  return cases;
}

}  // namespace drogue::perf
