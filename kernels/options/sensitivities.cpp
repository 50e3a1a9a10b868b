#include "kernels/options/sensitivities.hpp"

#include <algorithm>
#include <array>
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
  bool narrow;  ///< the rate changes so little that its prices need a finer mesh than the price itself
};

/// Change of the rate, which moves the drift until maturity by `relative_step` deviations. In the money,
/// exercise begins to pay where the rate passes q S/K, and there rho falls from about K T to 0 within
/// q S/K deviations, which near expiry are far fewer than this change. So it is at most a quarter of the
/// distance or a fifth of that width, but at least `least_part` of itself, since differences of prices on one
/// mesh have errors of their own.
double rate_step(const Contract& c, double deviation, double step) {
  constexpr double least_part = 1e-4;
  const bool in_the_money = c.type == Type::put ? c.spot < c.strike : c.spot > c.strike;
  if (!in_the_money || c.dividend == 0.0) return step;
  const double passed = c.dividend * c.spot / c.strike;
  return std::min(step, std::max({0.25 * std::abs(c.rate - passed), 0.2 * std::abs(passed) * deviation,
                                  least_part * step}));
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
  const double widest = relative_step * std::min(deviation, 1.0) / c.maturity;
  const Difference rate = rate_difference(c, rate_step(c, deviation, widest));
  return {
      rate, {variance_step, c.variance < 2.0 * variance_step}, !rate.one_sided && rate.step < 0.01 * widest};
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

SensitivityPricer::Resolution SensitivityPricer::resolution_of(const Price& price, bool narrow) const {
  if (_settings.method == Method::cos) return {0, price.steps};
  return narrow ? Resolution{std::max(price.mesh, 256), std::max(price.steps, 64)}
                : Resolution{price.mesh, price.steps};
}

Pricer& SensitivityPricer::pricer_of(const Resolution& resolution) {
  std::unique_ptr<Pricer>& pricer = _pricers[resolution];
  if (pricer == nullptr) {
    Settings settings = _settings;
    settings.mesh = resolution.first;
    settings.steps = resolution.second;
    pricer = create_pricer(_backend, settings);
  }
  return *pricer;
}

WallTimes SensitivityPricer::compute(std::span<const Contract> contracts, std::span<const Price> prices,
                                     std::span<Sensitivities> sensitivities) {
  struct Row {
    std::size_t index;
    Differences differences;
    std::array<double, nodes> values;
  };
  std::vector<Row> rows;
  for (std::size_t k = 0; k < contracts.size(); ++k) {
    const Contract& c = contracts[k];
    sensitivities[k] = {};
    if (prices[k].status == PriceStatus::failed) {
      sensitivities[k].vega = sensitivities[k].rho = std::numeric_limits<double>::quiet_NaN();
    } else if (!normalize(c).early) {
      sensitivities[k] = bounded(of_european(c, prices[k]), c.type);
    } else if (!is_exercised(c, prices[k])) {
      rows.push_back({k, differences_of(c), {}});
    }
  }
  // Neighbours that differ in their strikes alone stay so, and share solves of a surface.
  std::map<Resolution, std::vector<std::pair<Row*, std::size_t>>> moves;
  for (std::size_t node = 0; node < nodes; ++node)
    for (Row& row : rows)
      moves[resolution_of(prices[row.index], node < 2 && row.differences.narrow)].emplace_back(&row, node);
  WallTimes times;
  for (const auto& [resolution, own] : moves) {
    std::vector<Contract> bumped;
    for (const auto& [row, node] : own)
      bumped.push_back(moved(contracts[row->index], row->differences, node));
    std::vector<Price> values(bumped.size());
    times.add(pricer_of(resolution).price(bumped, values));
    for (std::size_t i = 0; i < own.size(); ++i) own[i].first->values[own[i].second] = values[i].price;
  }
  for (const auto& [k, differences, values] : rows) {
    const double now = prices[k].price;
    sensitivities[k] =
        bounded({2.0 * std::sqrt(contracts[k].variance) * differences.variance(now, values[2], values[3]),
                 differences.rate(now, values[0], values[1])},
                contracts[k].type);
  }
  return times;
}

}  // namespace drogue::options
