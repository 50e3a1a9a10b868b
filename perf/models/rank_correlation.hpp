#pragma once

#include <vector>

namespace drogue::perf {

/// Agreement of two orders.
struct RankCorrelation {
  double rho;  ///< coefficient of Spearman (1904), with mean ranks for ties; NaN if one side is constant
  double probability;  ///< of a coefficient at least as large if all orders are equally likely; 1 for NaN
};

/// Rank correlation of paired values. The probability is exact: all orders of at most nine pairs are counted.
/// Throws std::invalid_argument for other numbers of pairs than two to nine, or sides of different length.
RankCorrelation rank_correlation(const std::vector<double>& first, const std::vector<double>& second);

}  // namespace drogue::perf
