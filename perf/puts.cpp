#include "perf/puts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

namespace drogue::perf::puts {
namespace {

/// The dissertation's parameters, a year, r = 0.1, strike 1, and American puts at five spots: cosine series
/// with Romberg's extrapolation, to 1e-7.
constexpr options::Contract thesis{.rate = 0.1, .variance = 0.4, .jump = {1.0, 8.15, -2.5, 0.767}};
constexpr double known_spot[] = {1.0, 0.8, 0.9, 1.1, 1.2};
constexpr double known_price[] = {0.239004005, 0.318658312, 0.275403193, 0.208230166, 0.182096749};

struct Run {
  std::vector<options::Contract> contracts;
  std::vector<options::Price> prices;
  std::unique_ptr<options::Pricer> pricer;
  options::Timing timing;
};

std::vector<options::Contract> distinct(std::size_t count) {
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

/// The known ones first: V(c spot, c strike) = c V, so they are strikes of the spot 1.
std::vector<options::Contract> surfaces(const SurfaceSize& size) {
  std::vector<options::Contract> contracts;
  std::vector<options::Contract> sets = distinct(std::size(known_spot) + size.sets);
  sets.erase(sets.begin(), sets.begin() + std::size(known_spot));
  sets.front() = thesis;
  for (options::Contract c : sets) {
    c.spot = 1.0;
    for (std::size_t m = 0; m < size.maturities; ++m) {
      // From a year on, round to the shorter ones.
      c.maturity = 0.25 * static_cast<double>((m + 3) % 8 + 1);
      for (std::size_t k = 0; k < size.strikes; ++k) {
        c.strike = k < std::size(known_spot)
                       ? 1.0 / known_spot[k]
                       : 0.5 * std::exp2(2.0 * static_cast<double>(k) / static_cast<double>(size.strikes));
        contracts.push_back(c);
      }
    }
  }
  return contracts;
}

double error(const Run& run) {
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(run.prices.size(), std::size(known_price)); ++i)
    largest = std::max(largest, std::abs(run.prices[i].price / run.contracts[i].strike - known_price[i]));
  return largest;
}

Case timed(const std::string& name, device::Backend backend,
           const std::function<std::vector<options::Contract>()>& contracts,
           const options::Settings& settings, double limit) {
  const auto run = std::make_shared<Run>();
  return {name,
          "batch",
          "arithmetic of the convolution",
          [=] {
            run->contracts = contracts();
            run->prices.resize(run->contracts.size());
            run->pricer = options::create_pricer(backend, settings);
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
          [=] { return error(*run); },
          limit};
}

}  // namespace

Case batch(const std::string& name, device::Backend backend, std::size_t count,
           const options::Settings& settings, double limit) {
  return timed(
      name, backend, [=] { return distinct(count); }, settings, limit);
}

Case surface(const std::string& name, device::Backend backend, const SurfaceSize& size,
             const options::Settings& settings, double limit) {
  return timed(
      name, backend, [=] { return surfaces(size); }, settings, limit);
}

}  // namespace drogue::perf::puts
