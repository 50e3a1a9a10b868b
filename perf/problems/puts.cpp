#include "perf/problems/puts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <memory_resource>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "perf/problems/known_puts.hpp"

namespace drogue::perf::puts {
namespace {

struct Run {
  std::unique_ptr<options::Pricer> pricer;
  std::shared_ptr<std::pmr::memory_resource> memory;
  std::pmr::vector<options::Contract> contracts;
  std::pmr::vector<options::Price> prices;
  options::WallTimes timing;
};

/// Known puts first. V(c spot, c strike) = c V turns their spots into strikes at spot 1.
std::vector<options::Contract> surfaces(const SurfaceSize& size) {
  const KnownPuts& known = thesis_puts();
  const auto known_count = static_cast<std::ptrdiff_t>(known.spots.size());
  std::vector<options::Contract> contracts, sets = distinct(known.spots.size() + size.sets);
  sets.erase(sets.begin(), sets.begin() + known_count);
  sets.front() = known.contract;
  for (options::Contract c : sets) {
    c.spot = 1.0;
    for (std::size_t m = 0; m < size.maturities; ++m) {
      // One year first, because the known prices have that maturity; then cyclically.
      c.maturity = 0.25 * static_cast<double>((m + 3) % 8 + 1);
      for (std::size_t k = 0; k < size.strikes; ++k) {
        c.strike = k < known.spots.size()
                       ? 1.0 / known.spots[k]
                       : 0.5 * std::exp2(2.0 * static_cast<double>(k) / static_cast<double>(size.strikes));
        contracts.push_back(c);
      }
    }
  }
  return contracts;
}

double error(const Run& run) {
  const std::vector<double>& known = thesis_puts().prices;
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(run.prices.size(), known.size()); ++i)
    largest = std::max(largest, std::abs(run.prices[i].price / run.contracts[i].strike - known[i]));
  return largest;
}

/// Memory of the contracts and prices of a pricer. Finite differences recognise their own pinned memory
/// alone, from which they copy without a buffer in between.
std::shared_ptr<std::pmr::memory_resource> memory_for(options::Pricer& pricer, device::Backend backend,
                                                      const options::Settings& settings, HostMemory memory) {
  if (memory == HostMemory::pinned && settings.method == options::Method::pide)
    return {std::shared_ptr<void>(), &pricer.memory()};
  return host_memory(backend, memory);
}

Case priced(const std::string& name, device::Backend backend, HostMemory kind,
            const std::function<std::vector<options::Contract>()>& contracts,
            const options::Settings& settings, double limit) {
  return {.name = name,
          .backend = backend,
          .unit_of_work = "batch",
          .bound = "arithmetic of the convolution",
          .tolerance = limit,
          .prepare = [=] {
            std::unique_ptr<options::Pricer> pricer = options::create_pricer(backend, settings);
            const std::shared_ptr<std::pmr::memory_resource> memory =
                memory_for(*pricer, backend, settings, kind);
            const std::vector<options::Contract> asked = contracts();
            const auto run = std::make_shared<Run>(
                Run{.pricer = std::move(pricer),
                    .memory = memory,
                    .contracts = {asked.begin(), asked.end(), memory.get()},
                    .prices = std::pmr::vector<options::Price>(asked.size(), memory.get()),
                    .timing = {}});
            Sample sample{[] {},
                          [=] {
                            run->timing = run->pricer->price(run->contracts, run->prices);
                            return 1L;
                          },
                          [=] { return error(*run); }};
            if (settings.time_copies)
              sample.parts = [=] {
                const options::WallTimes& timing = run->timing;
                return std::map<std::string, double>{
                    {"h2d", timing.h2d}, {"compute", timing.compute}, {"d2h", timing.d2h}};
              };
            return sample;
          }};
}

}  // namespace

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
    const double levy[] = {between(-2.0, 2.0), between(6.0, 15.0), between(-4.0, 0.0), between(0.2, 1.0)};
    std::ranges::copy(levy, c.jump);
  }
  return contracts;
}

Case batch(const std::string& name, device::Backend backend, HostMemory memory, std::size_t count,
           const options::Settings& settings, double limit) {
  return priced(
      name, backend, memory, [=] { return distinct(count); }, settings, limit);
}

Case surface(const std::string& name, device::Backend backend, const SurfaceSize& size,
             const options::Settings& settings, double limit) {
  return priced(
      name, backend, HostMemory::pinned, [=] { return surfaces(size); }, settings, limit);
}

}  // namespace drogue::perf::puts
