#include "perf/puts.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <memory_resource>
#include <optional>
#include <random>
#include <span>
#include <vector>

namespace drogue::perf::puts {
namespace {

/// The dissertation's parameters, a year, r = 0.1, strike 1, and American puts at five spots: cosine series
/// with Romberg's extrapolation, to 1e-7.
constexpr options::Contract thesis{.rate = 0.1, .variance = 0.4, .jump = {1.0, 8.15, -2.5, 0.767}};
constexpr double known_spot[] = {1.0, 0.8, 0.9, 1.1, 1.2};
constexpr double known_price[] = {0.239004005, 0.318658312, 0.275403193, 0.208230166, 0.182096749};

struct Run {
  std::unique_ptr<options::Pricer> pricer;
  std::pmr::vector<options::Contract> contracts;
  std::pmr::vector<options::Price> prices;
  options::Timing timing;
};

std::pmr::vector<options::Contract> distinct(std::size_t count, std::pmr::memory_resource& memory) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  std::pmr::vector<options::Contract> contracts(count, thesis, &memory);
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

double error(std::span<const options::Price> prices) {
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(prices.size(), std::size(known_price)); ++i)
    largest = std::max(largest, std::abs(prices[i].price - known_price[i]));
  return largest;
}

}  // namespace

Case batch(const std::string& name, device::Backend backend, std::size_t count,
           const options::Settings& settings, double limit) {
  const auto run = std::make_shared<std::optional<Run>>();
  return {name,
          "batch",
          "arithmetic of the convolution",
          [=] {
            std::unique_ptr<options::Pricer> pricer = options::create_pricer(backend, settings);
            std::pmr::memory_resource& memory = pricer->memory();
            run->emplace(Run{std::move(pricer),
                             distinct(count, memory),
                             std::pmr::vector<options::Price>(count, &memory),
                             {}});
            return Sample{[] {},
                          [=] {
                            Run& now = **run;
                            now.timing = now.pricer->price(now.contracts, now.prices);
                            return 1L;
                          },
                          [=] {
                            return std::map<std::string, double>{{"h2d", (*run)->timing.h2d},
                                                                 {"compute", (*run)->timing.compute},
                                                                 {"d2h", (*run)->timing.d2h}};
                          }};
          },
          [=] { return error((*run)->prices); },
          limit};
}

}  // namespace drogue::perf::puts
