#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/options/contract.hpp"

/// Partition of strikes into ranges that share a solve.
namespace drogue::options {

/// Ranges of |ln(spot/strike)|. The first one ends at min(3 s, max(s, 1)), s the standard deviation at
/// maturity; each other one ends at four times the previous end. Near strikes thus have a fine grid, and the
/// solve of a strike does not depend on the other strikes.
class StrikeRanges {
 public:
  static constexpr int count = 20;

  explicit StrikeRanges(double deviation);

  /// Index of the smallest range that contains the ratio spot/strike; the last one for ratios beyond all
  /// ranges. Does not throw.
  [[nodiscard]] std::uint8_t index_of(double ratio);

  /// End of range k in |ln(spot/strike)|, dimensionless. Does not throw.
  [[nodiscard]] double half_width(int k) const;

 private:
  double _first;
  int _known = 0;
  double _ratio[count];  ///< ratios spot/strike at the ends; computed on demand
};

/// Whether two contracts differ at most in their strike, so that one solve prices both. Does not throw.
[[nodiscard]] bool differ_only_in_strike(const Contract& a, const Contract& b);

/// Whether the logarithm of the asset has the same annual variance under the pricing measures of both
/// contracts, because all parameters of the process agree. Does not throw.
[[nodiscard]] bool have_same_process(const Contract& a, const Contract& b);

/// Annual variance of the asset's logarithm under the pricing measure of a contract, per year. `panels` and
/// `panel_slot` are the series of `HankelPanels`. Does not throw except `std::bad_alloc`.
[[nodiscard]] double annual_variance(const Contract& contract, const double* panels, const int* panel_slot);

}  // namespace drogue::options
