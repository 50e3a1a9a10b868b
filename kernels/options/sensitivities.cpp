#include "kernels/options/sensitivities.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/options/cos/characteristic_exponent.hpp"
#include "kernels/options/normalized_put.hpp"

namespace drogue::options {
namespace {

/// Finite difference of second order of a function f at 0: (f(step) - f(-step))/(2 step), or (4 f(step) - 3
/// f(0)
/// - f(2 step))/(2 step) if it is one-sided.
struct Difference {
  double step;
  bool one_sided;

  [[nodiscard]] double second_step() const { return one_sided ? 2.0 * step : -step; }
  [[nodiscard]] double operator()(double at_zero, double at_step, double at_second) const {
    return one_sided ? (4.0 * at_step - 3.0 * at_zero - at_second) / (2.0 * step)
                     : (at_step - at_second) / (2.0 * step);
  }
};

/// Change of the volatility, and of the drift until maturity in deviations. With a twentieth the exercise
/// boundary passes spots beside it, and their sensitivities are off by a third; prices on one mesh allow a
/// hundredth.
constexpr double relative_step = 0.01;

/// Differences in the rate and in the variance of a contract with early exercise.
struct Differences {
  Difference rate, variance;
};

/// Change of the rate, which moves the drift until maturity by `relative_step` deviations. In the money,
/// exercise begins to pay where the rate passes q S/K, and there rho falls from about K T to 0 within
/// q S/K deviations, which near expiry are far fewer than this change. So it is at most a quarter of the
/// distance or a fifth of that width, but at least a hundredth of itself, since differences of prices on one
/// mesh have errors of their own.
double rate_step(const Contract& c, double deviation) {
  const double step = relative_step * std::min(deviation, 1.0) / c.maturity;
  const bool in_the_money = c.type == Type::put ? c.spot < c.strike : c.spot > c.strike;
  if (!in_the_money || c.dividend == 0.0) return step;
  const double passed = c.dividend * c.spot / c.strike;
  return std::min(
      step, std::max({0.25 * std::abs(c.rate - passed), 0.2 * std::abs(passed) * deviation, 0.01 * step}));
}

/// The rate keeps its distance from values at which other rules of exercise hold. A small rate is changed by
/// a quarter, since the exercise boundary depends on their ratio.
Difference rate_difference(const Contract& c, double step) {
  const bool is_put = c.type == Type::put;
  constexpr double least_part = 0.125;
  if (is_put && c.rate >= 0.0)
    return c.rate < 4.0 * least_part * step ? Difference{least_part * step, true}
                                            : Difference{std::min(step, 0.25 * c.rate), false};
  if (!is_put && c.dividend > 0.0) return {step, false};
  // Exercise pays for q < r < 0 (put) or r < q <= 0 (call).
  const double room = std::abs(c.rate - c.dividend);
  return {std::min(step, 0.25 * (is_put ? std::min(room, -c.rate) : room)), false};
}

Differences differences_of(const Contract& c) {
  const double variance = std::max(CharacteristicExponent(c).cumulants().second, 1e-100);
  const double deviation = std::sqrt(variance * c.maturity);
  const double variance_step = 2.0 * relative_step * variance;
  return {rate_difference(c, rate_step(c, deviation)), {variance_step, c.variance < 2.0 * variance_step}};
}

bool is_exercised(const Contract& c, const Price& price) {
  return c.style == Style::american && std::abs(price.delta) == 1.0 && price.gamma == 0.0 &&
         price.theta == 0.0;
}

/// Sensitivities of the price of a European option.
Sensitivities of_european(const Contract& c, const Price& price) {
  return {std::sqrt(c.variance) * c.maturity * c.spot * c.spot * price.gamma,
          c.maturity * (c.spot * price.delta - price.price)};
}

/// Bounds which errors of differences may miss: all prices are convex, and a rate raises only calls.
Sensitivities bounded(Sensitivities s, Type type) {
  s.vega = s.vega < 0.0 ? 0.0 : s.vega;
  s.rho = type == Type::put ? (s.rho > 0.0 ? 0.0 : s.rho) : (s.rho < 0.0 ? 0.0 : s.rho);
  return s;
}

constexpr std::size_t nodes = 4;  ///< prices per contract: at two rates and at two variances

Contract moved(Contract c, const Differences& d, std::size_t node) {
  if (node < 2) {
    c.rate += node == 0 ? d.rate.step : d.rate.second_step();
  } else {
    c.variance += node == 2 ? d.variance.step : d.variance.second_step();
  }
  return c;
}

}  // namespace

SensitivityPricer::SensitivityPricer(device::Backend backend, const Settings& settings)
    : _backend(backend), _settings(settings) {
  _settings.greeks = false;
}

Pricer& SensitivityPricer::pricer_of(const Resolution& resolution) {
  std::unique_ptr<Pricer>& pricer = _pricers[resolution];
  if (pricer == nullptr) {
    Settings settings = _settings;
    settings.mesh = settings.method == Method::cos ? 0 : resolution.first;
    settings.steps = resolution.second;
    pricer = create_pricer(_backend, settings);
  }
  return *pricer;
}

WallTimes SensitivityPricer::compute(std::span<const Contract> contracts, std::span<const Price> prices,
                                     std::span<Sensitivities> sensitivities) {
  std::map<Resolution, std::vector<std::size_t>> rows;
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    const Contract& c = contracts[k];
    const NormalizedPut put = normalize(c);
    sensitivities[k] = {};
    if (prices[k].status == PriceStatus::failed) {
      sensitivities[k].vega = sensitivities[k].rho = std::numeric_limits<double>::quiet_NaN();
    } else if (!put.early) {
      sensitivities[k] = bounded(of_european(c, prices[k]), c.type);
    } else if (!is_exercised(c, prices[k])) {
      const int mesh = _settings.method == Method::cos ? 0 : prices[k].mesh;
      rows[{mesh, prices[k].steps}].push_back(k);
    }
  }
  WallTimes times;
  for (const auto& [resolution, own] : rows) {
    std::vector<Differences> differences;
    for (const std::size_t k : own) differences.push_back(differences_of(contracts[k]));
    // Neighbours that differ in their strikes alone stay so, and share solves of a surface.
    std::vector<Contract> bumped;
    for (std::size_t node = 0; node < nodes; ++node)
      for (std::size_t i = 0; i < own.size(); ++i)
        bumped.push_back(moved(contracts[own[i]], differences[i], node));
    std::vector<Price> values(bumped.size());
    times.add(pricer_of(resolution).price(bumped, values));
    for (std::size_t i = 0; i < own.size(); ++i) {
      const Contract& c = contracts[own[i]];
      const auto value = [&](std::size_t node) { return values[node * own.size() + i].price; };
      const double now = prices[own[i]].price;
      const double by_variance = differences[i].variance(now, value(2), value(3));
      sensitivities[own[i]] = bounded(
          {2.0 * std::sqrt(c.variance) * by_variance, differences[i].rate(now, value(0), value(1))}, c.type);
    }
  }
  return times;
}

}  // namespace drogue::options
