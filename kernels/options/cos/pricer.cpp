#include "kernels/options/cos/pricer.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "kernels/device/stopwatch.hpp"
#include "kernels/options/cos/american.hpp"
#include "kernels/options/cos/european.hpp"

namespace drogue::options {
namespace {

/// Calls `work(i)` for i in [0, count) by so many threads.
template <class Work>
void for_each(std::size_t threads, std::size_t count, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto take = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others;
  for (std::size_t k = 1; k < std::min(threads, count); ++k) others.emplace_back(take);
  take();
}

/// One on the serial backend.
std::size_t host_threads(device::Backend backend, const Settings& settings) {
  if (backend == device::Backend::serial) return 1;
  return settings.host_threads > 0 ? static_cast<std::size_t>(settings.host_threads)
                                   : std::thread::hardware_concurrency();
}

/// Puts of many contracts, those with the same number of cosines side by side, as one call takes them.
struct Bundle {
  std::vector<BermudanPut> puts;
  std::vector<std::size_t> places;  ///< of each put's value, in the order of the contracts
  std::vector<double> psi_re, psi_im;
};

Bundle bundle(const std::vector<AmericanPut>& contracts) {
  Bundle all;
  for (const AmericanPut& contract : contracts) {
    const int table = static_cast<int>(all.psi_re.size());
    for (BermudanPut put : contract.puts) {
      put.table = table;
      all.puts.push_back(put);
    }
    all.psi_re.insert(all.psi_re.end(), contract.psi_re.begin(), contract.psi_re.end());
    all.psi_im.insert(all.psi_im.end(), contract.psi_im.begin(), contract.psi_im.end());
  }
  all.places.resize(all.puts.size());
  std::iota(all.places.begin(), all.places.end(), std::size_t{0});
  std::stable_sort(all.places.begin(), all.places.end(), [&](std::size_t a, std::size_t b) {
    return all.puts[a].log_terms < all.puts[b].log_terms;
  });
  std::vector<BermudanPut> sorted;
  for (const std::size_t place : all.places) sorted.push_back(all.puts[place]);
  all.puts = std::move(sorted);
  return all;
}

class CosPricer final : public Pricer {
 public:
  CosPricer(device::Backend backend, const Settings& settings)
      : _threads(host_threads(backend, settings)),
        _settings(settings),
        _solver(create_bermudan_solver(backend)) {}

  WallTimes price(std::span<const Contract> contracts, std::span<Price> prices) override {
    if (contracts.size() != prices.size())
      throw std::invalid_argument("cos: as many prices as contracts are needed");
    const device::Stopwatch pricing;
    std::vector<std::size_t> american;
    for (std::size_t i = 0; i < contracts.size(); ++i)
      if (contracts[i].style == Style::american && !AmericanPut(contracts[i]).never_exercised())
        american.push_back(i);
    for_each(_threads, contracts.size(), [&](std::size_t i) {
      if (!std::binary_search(american.begin(), american.end(), i))
        prices[i] = european_price(contracts[i], Exponent(contracts[i]));
    });
    for (std::size_t first = 0; first < american.size(); first += most_together) {
      const std::size_t count = std::min(most_together, american.size() - first);
      price_american(contracts, std::span(american).subspan(first, count), prices);
    }
    for (std::size_t i = 0; i < contracts.size(); ++i) finish(contracts[i], prices[i]);
    WallTimes timing;
    timing.compute = pricing.seconds();
    return timing;
  }

  std::vector<BoundaryPoint> boundary_on(const Contract& /*contract*/, int /*mesh*/, int /*steps*/) override {
    throw std::invalid_argument("cos: no exercise boundary; take the method pide");
  }

  std::vector<ProfilePoint> profile(const Contract& /*contract*/) override {
    throw std::invalid_argument("cos: each spot is a solve of its own; take the method pide");
  }

 private:
  static constexpr std::size_t most_together = 1024;       ///< so that their tables take some 60 MB at most
  static constexpr int fewest_dates = 4, most_dates = 32;  ///< of the coarsest level

  /// Doubles the dates of those that have not reached the tolerance.
  void price_american(std::span<const Contract> contracts, std::span<const std::size_t> american,
                      std::span<Price> prices) {
    std::vector<std::size_t> open(american.begin(), american.end());
    for (int dates = fewest_dates; !open.empty() && dates <= most_dates; dates *= 2) {
      std::vector<AmericanPut> puts;
      for (const std::size_t i : open) puts.emplace_back(contracts[i]);
      for_each(_threads, open.size(), [&](std::size_t k) {
        const Contract& c = contracts[open[k]];
        const double unit = c.type == Type::put ? c.strike : c.spot;
        puts[k].prepare(c.maturity, dates, _settings.tolerance * c.strike / unit);
      });
      const Bundle all = bundle(puts);
      std::vector<BermudanValue> sorted(all.puts.size()), values(all.puts.size());
      _solver->solve(all.puts, all.psi_re, all.psi_im, sorted);
      for (std::size_t k = 0; k < sorted.size(); ++k) values[all.places[k]] = sorted[k];
      std::vector<std::size_t> still_open;
      const BermudanValue* mine = values.data();
      for (std::size_t k = 0; k < open.size(); ++k) {
        const std::size_t i = open[k];
        prices[i] = american_price(contracts[i], puts[k], mine);
        mine += puts[k].puts.size();
        const bool can_be_reached = puts[k].folded < _settings.tolerance;
        if (can_be_reached && !(prices[i].error <= _settings.tolerance * contracts[i].strike))
          still_open.push_back(i);
      }
      open = std::move(still_open);
    }
  }

  void finish(const Contract& contract, Price& price) const {
    if (!std::isfinite(price.price) || !std::isfinite(price.error)) {
      price.outcome = Outcome::failed;
      price.failure = Failure::series;
    } else if (price.error > _settings.tolerance * contract.strike) {
      price.outcome = Outcome::coarse;
    }
    if (_settings.greeks) return;
    price.delta = price.gamma = price.theta = std::numeric_limits<double>::quiet_NaN();
  }

  std::size_t _threads;
  Settings _settings;
  std::unique_ptr<BermudanSolver> _solver;
};

}  // namespace

std::unique_ptr<Pricer> create_cos_pricer(device::Backend backend, const Settings& settings) {
  if (settings.mesh != 0 || settings.steps != 0)
    throw std::invalid_argument("cos: the tolerance chooses the cosines; there is no mesh");
  if (!(settings.tolerance > 0.0)) throw std::invalid_argument("cos: the tolerance must be positive");
  return std::make_unique<CosPricer>(backend, settings);
}

}  // namespace drogue::options
