#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/options/contract.hpp"

/// Which strikes share a solve.
namespace drogue::options {

/// Strikes of |ln(spot/strike)| up to three standard deviations of the law until maturity share a solve,
/// those up to four times as far another, and so on: near strikes get a fine grid, and the solve of a strike
/// does not depend on what other strikes there are.
class StrikeRanges {
 public:
  static constexpr int count = 20;

  explicit StrikeRanges(double deviation);

  /// The least reach that spot/strike = `ratio` is within; the last one for what none reaches.
  [[nodiscard]] std::uint8_t index_of(double ratio);

  /// Of ln(spot/strike).
  [[nodiscard]] double half_width(int k) const;

 private:
  double _first;
  int _known = 0;
  double _ratio[count];  ///< of spot and strike at the reaches; as far as strikes were
};

/// Whether a solve for one contract holds the price of the other.
[[nodiscard]] bool differ_only_in_strike(const Contract& a, const Contract& b);

/// Whether the logarithm of the asset has the same variance in the measures that both are priced in.
[[nodiscard]] bool have_same_process(const Contract& a, const Contract& b);

/// The variance of the asset's logarithm, a year, in the measure that the contract is priced in; with the
/// series of `HankelPanels`.
[[nodiscard]] double annual_variance(const Contract& contract, const double* panels, const int* panel_slot);

}  // namespace drogue::options
