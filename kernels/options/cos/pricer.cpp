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
#include "kernels/options/greek_bounds.hpp"

namespace drogue::options {
namespace {

/// Calls `work(i)` for i in [0, count) on `threads` threads.
template <class Work>
void parallel_for_host(std::size_t threads, std::size_t count, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others;
  for (std::size_t k = 1; k < std::min(threads, count); ++k) others.emplace_back(run);
  run();
}

/// Number of host threads: one on the serial backend.
std::size_t host_threads(device::Backend backend, const Settings& settings) {
  if (backend == device::Backend::serial) return 1;
  return settings.host_threads > 0 ? static_cast<std::size_t>(settings.host_threads)
                                   : std::thread::hardware_concurrency();
}

/// Puts of many contracts, sorted by their number of cosines, for one call of the solver.
struct SortedPuts {
  std::vector<BermudanPut> puts;
  std::vector<std::size_t> order;  ///< index of each put in the order of the contracts
  std::vector<double> psi_re, psi_im;
};

SortedPuts sort_puts(const std::vector<AmericanPut>& contracts) {
  SortedPuts all;
  for (const AmericanPut& contract : contracts) {
    const int table = static_cast<int>(all.psi_re.size());
    for (BermudanPut put : contract.puts) {
      put.table = table;
      all.puts.push_back(put);
    }
    all.psi_re.insert(all.psi_re.end(), contract.psi_re.begin(), contract.psi_re.end());
    all.psi_im.insert(all.psi_im.end(), contract.psi_im.begin(), contract.psi_im.end());
  }
  all.order.resize(all.puts.size());
  std::iota(all.order.begin(), all.order.end(), std::size_t{0});
  std::stable_sort(all.order.begin(), all.order.end(), [&](std::size_t a, std::size_t b) {
    return all.puts[a].log_terms < all.puts[b].log_terms;
  });
  std::vector<BermudanPut> sorted;
  for (const std::size_t index : all.order) sorted.push_back(all.puts[index]);
  all.puts = std::move(sorted);
  return all;
}

/// Pricer for the method `cos`.
class CosPricer final : public Pricer {
 public:
  CosPricer(device::Backend backend, const Settings& settings)
      : _threads(host_threads(backend, settings)),
        _settings(settings),
        _solver(create_bermudan_solver(backend, settings.block)) {}

  WallTimes price(std::span<const Contract> contracts, std::span<Price> prices) override {
    if (contracts.size() != prices.size())
      throw std::invalid_argument("cos: as many prices as contracts are needed");
    const device::Stopwatch pricing;
    std::vector<std::size_t> american;
    for (std::size_t i = 0; i < contracts.size(); ++i)
      if (contracts[i].style == Style::american && !AmericanPut(contracts[i]).never_exercised())
        american.push_back(i);
    parallel_for_host(_threads, contracts.size(), [&](std::size_t i) {
      if (!std::binary_search(american.begin(), american.end(), i))
        prices[i] = european_price(contracts[i], CharacteristicExponent(contracts[i]));
    });
    for (std::size_t first = 0; first < american.size(); first += max_contracts) {
      const std::size_t count = std::min(max_contracts, american.size() - first);
      price_american(contracts, std::span(american).subspan(first, count), prices);
    }
    for (std::size_t i = 0; i < contracts.size(); ++i) set_status(contracts[i], prices[i]);
    WallTimes times;
    times.compute = pricing.seconds();
    return times;
  }

  std::vector<BoundaryPoint> boundary(const Contract& /*contract*/, int /*mesh*/, int /*steps*/) override {
    throw std::invalid_argument("cos: no exercise boundary; take the method pide");
  }

  std::vector<ProfilePoint> profile(const Contract& /*contract*/) override {
    throw std::invalid_argument("cos: each spot is a solve of its own; take the method pide");
  }

 private:
  static constexpr std::size_t max_contracts = 1024;   ///< per call of the solver; bounds the tables to 60 MB
  static constexpr int min_dates = 4, max_dates = 32;  ///< of the coarsest level

  /// Prices American contracts, doubling the number of dates of those that exceed the tolerance.
  void price_american(std::span<const Contract> contracts, std::span<const std::size_t> american,
                      std::span<Price> prices) {
    std::vector<std::size_t> unconverged(american.begin(), american.end());
    const int given = _settings.steps >> (AmericanPut::levels - 1);
    const int last = given > 0 ? given : max_dates;
    for (int dates = given > 0 ? given : min_dates; !unconverged.empty() && dates <= last; dates *= 2) {
      std::vector<AmericanPut> puts;
      for (const std::size_t i : unconverged) puts.emplace_back(contracts[i]);
      parallel_for_host(_threads, unconverged.size(), [&](std::size_t k) {
        const Contract& c = contracts[unconverged[k]];
        puts[k].prepare(c.maturity, dates, tolerance_of_put(c));
      });
      const SortedPuts all = sort_puts(puts);
      std::vector<BermudanValue> sorted(all.puts.size()), values(all.puts.size());
      _solver->solve(all.puts, all.psi_re, all.psi_im, sorted);
      for (std::size_t k = 0; k < sorted.size(); ++k) values[all.order[k]] = sorted[k];
      std::vector<std::size_t> remaining;
      const BermudanValue* own_values = values.data();
      for (std::size_t k = 0; k < unconverged.size(); ++k) {
        const std::size_t i = unconverged[k];
        prices[i] = american_price(contracts[i], puts[k], own_values, tolerance_of_put(contracts[i]));
        own_values += puts[k].puts.size();
        const bool is_reachable = puts[k].aliasing_error < _settings.tolerance;
        if (is_reachable && !(prices[i].error <= _settings.tolerance * contracts[i].strike))
          remaining.push_back(i);
      }
      unconverged = std::move(remaining);
    }
  }

  /// Tolerance in strikes of the put: those of a call are its spots.
  [[nodiscard]] double tolerance_of_put(const Contract& c) const {
    return _settings.tolerance * c.strike / (c.type == Type::put ? c.strike : c.spot);
  }

  /// Sets the status, and removes the Greeks unless requested.
  void set_status(const Contract& contract, Price& price) const {
    if (!std::isfinite(price.price) || !std::isfinite(price.error)) {
      price.status = PriceStatus::failed;
      price.failure = PricingFailure::fourier_not_finite;
    } else if (price.error > _settings.tolerance * contract.strike) {
      price.status = PriceStatus::coarse;
    }
    bound_greeks(contract, price);
    if (_settings.greeks) return;
    price.delta = price.gamma = price.theta = std::numeric_limits<double>::quiet_NaN();
  }

  std::size_t _threads;
  Settings _settings;
  std::unique_ptr<BermudanSolver> _solver;
};

}  // namespace

std::unique_ptr<Pricer> create_cos_pricer(device::Backend backend, const Settings& settings) {
  if (settings.mesh != 0)
    throw std::invalid_argument("cos: the tolerance chooses the cosines; there is no mesh");
  if (settings.steps % (1 << (AmericanPut::levels - 1)) != 0)
    throw std::invalid_argument("cos: the steps, dates of the finest level, must be a multiple of 8");
  if (!(settings.tolerance > 0.0)) throw std::invalid_argument("cos: the tolerance must be positive");
  return std::make_unique<CosPricer>(backend, settings);
}

}  // namespace drogue::options
