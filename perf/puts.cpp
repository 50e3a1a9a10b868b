#include "perf/puts.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "perf/known_puts.hpp"

namespace drogue::perf::puts {
namespace {

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
  const KnownPuts& known = thesis_puts();
  std::vector<options::Contract> contracts(count, known.contract);
  for (std::size_t i = 0; i < count; ++i) {
    options::Contract& c = contracts[i];
    if (i < known.spots.size()) {
      c.spot = known.spots[i];
      continue;
    }
    c.spot = between(0.8, 1.2), c.rate = between(0.01, 0.1), c.maturity = between(0.25, 2.0);
    c.variance = between(0.0, 0.4);
    const double law[] = {between(-2.0, 2.0), between(6.0, 15.0), between(-4.0, 0.0), between(0.2, 1.0)};
    std::ranges::copy(law, c.jump);
  }
  return contracts;
}

double error(const std::vector<options::Price>& prices) {
  const std::vector<double>& known = thesis_puts().prices;
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(prices.size(), known.size()); ++i)
    largest = std::max(largest, std::abs(prices[i].price - known[i]));
  return largest;
}

}  // namespace

Case batch(const std::string& name, device::Backend backend, std::size_t count,
           const options::Settings& settings, double limit) {
  const auto run = std::make_shared<Run>();
  return {name,
          "batch",
          "arithmetic of the convolution",
          [=] {
            run->contracts = distinct(count);
            run->prices.resize(count);
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
          [=] { return error(run->prices); },
          limit};
}

}  // namespace drogue::perf::puts
