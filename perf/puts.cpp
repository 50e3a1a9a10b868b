#include "perf/puts.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <memory_resource>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "perf/known_puts.hpp"

namespace drogue::perf::puts {
namespace {

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
  const KnownPuts& known = thesis_puts();
  std::pmr::vector<options::Contract> contracts(count, known.contract, &memory);
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

double error(std::span<const options::Price> prices) {
  const std::vector<double>& known = thesis_puts().prices;
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(prices.size(), known.size()); ++i)
    largest = std::max(largest, std::abs(prices[i].price - known[i]));
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
