#pragma once

#include <map>
#include <memory>
#include <span>
#include <utility>

#include "kernels/options/pricer.hpp"

namespace drogue::options {

/// Derivatives of a price by parameters of its contract. NaN without a price.
struct Sensitivities {
  double vega =
      0.0;  ///< by the volatility sigma = sqrt(variance) of the Brownian part, with the same jumps; money
  double rho = 0.0;  ///< by the rate, with the same dividend yield; money times years
};

/// Computes the sensitivities of priced contracts.
///
/// European prices: rho = T (S delta - V), and vega = sigma T S^2 gamma, which holds with any independent
/// jumps. An option that is exercised now has none. The others: differences of second order of prices at two
/// rates and at two variances, on the mesh and with the steps of the price itself, so that most of their
/// errors cancel; on 256 x 64 or more at rates that differ by less than a hundredth of the usual step.
/// Without a Brownian part vega is 0, since a price is an even function of sigma.
class SensitivityPricer {
 public:
  /// Throws as `create_pricer`.
  SensitivityPricer(device::Backend backend, const Settings& settings);

  /// Computes `sensitivities` from `prices`, which a pricer with these settings and Greeks gave for
  /// `contracts`; all of the same length. Their bits do not depend on the other contracts. Returns wall
  /// times, s. Blocking. Throws as `Pricer::price`.
  WallTimes compute(std::span<const Contract> contracts, std::span<const Price> prices,
                    std::span<Sensitivities> sensitivities);

 private:
  using Resolution = std::pair<int, int>;  ///< mesh and steps

  /// Mesh and steps of the prices that are compared with `price`; `narrow` as in `Differences`.
  [[nodiscard]] Resolution resolution_of(const Price& price, bool narrow) const;
  Pricer& pricer_of(const Resolution& resolution);

  device::Backend _backend;
  Settings _settings;
  std::map<Resolution, std::unique_ptr<Pricer>> _pricers;
};

}  // namespace drogue::options
