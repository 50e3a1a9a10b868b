#include "perf/models/rank_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace drogue::perf {
namespace {

constexpr std::size_t most_pairs = 9;

/// Twice the ranks of the values, counted from the mean of all ranks: whole numbers, equal for ties.
std::vector<int> centred_ranks(const std::vector<double>& values) {
  std::vector<int> ranks;
  for (const double value : values) {
    int rank = 0;
    for (const double other : values) rank += (other < value ? 1 : 0) - (other > value ? 1 : 0);
    ranks.push_back(rank);
  }
  return ranks;
}

int product(const std::vector<int>& a, const std::vector<int>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0);
}

}  // namespace

RankCorrelation rank_correlation(const std::vector<double>& first, const std::vector<double>& second) {
  if (first.size() != second.size() || first.size() < 2 || first.size() > most_pairs)
    throw std::invalid_argument("a rank correlation needs two to nine pairs");
  const std::vector<int> a = centred_ranks(first);
  std::vector<int> b = centred_ranks(second);
  const double scale = std::sqrt(static_cast<double>(product(a, a)) * product(b, b));
  if (scale == 0.0) return {std::nan(""), 1.0};
  const int observed = product(a, b);
  // Orders that differ by equal values alone are one, and each stands for as many permutations.
  long orders = 0, extreme = 0;
  std::ranges::sort(b);
  do {
    ++orders;
    extreme += product(a, b) >= observed ? 1 : 0;
  } while (std::ranges::next_permutation(b).found);
  return {observed / scale, static_cast<double>(extreme) / static_cast<double>(orders)};
}

}  // namespace drogue::perf
