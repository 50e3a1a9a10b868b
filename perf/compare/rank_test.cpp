#include "perf/compare/rank_test.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "common/run/statistics.hpp"

namespace drogue::perf {

namespace {

constexpr std::size_t largest_exact = 100;  ///< values of both samples

/// P(U <= u) of the number U of pairs in which the second value is the smaller one, if all orders of the
/// values are equally likely.
class PairCount {
 public:
  PairCount(std::size_t first, std::size_t second)
      : _pairs(static_cast<double>(first * second)),
        _deviation(std::sqrt(_pairs * static_cast<double>(first + second + 1) / 12.0)) {
    if (first + second <= largest_exact) fill(first, second);
  }

  [[nodiscard]] double at_most(double u) const {
    if (u < 0.0) return 0.0;
    if (_cumulative.empty()) return 0.5 * std::erfc((0.5 * _pairs - u - 0.5) / (_deviation * std::sqrt(2.0)));
    return _cumulative[std::min(static_cast<std::size_t>(u), _cumulative.size() - 1)];
  }

 private:
  /// The generating function of U is the Gaussian binomial coefficient: the product of (1 - q^(second + i))
  /// over that of (1 - q^i), i = 1 .. first.
  void fill(std::size_t first, std::size_t second) {
    std::vector<double> count(first * second + 1, 0.0);
    count[0] = 1.0;
    for (std::size_t i = 1; i <= first; ++i) {
      for (std::size_t u = count.size(); u-- > second + i;) count[u] -= count[u - second - i];
      for (std::size_t u = i; u < count.size(); ++u) count[u] += count[u - i];
    }
    const double all = std::accumulate(count.begin(), count.end(), 0.0);
    double sum = 0.0;
    for (const double c : count) _cumulative.push_back((sum += c) / all);
  }

  double _pairs, _deviation;
  std::vector<double> _cumulative;
};

}  // namespace

double rank_test(const std::vector<double>& first, const std::vector<double>& second) {
  if (first.empty() || second.empty()) return 1.0;
  double smaller = 0.0;
  for (const double a : first)
    for (const double b : second) smaller += b < a ? 1.0 : b == a ? 0.5 : 0.0;
  const double pairs = static_cast<double>(first.size() * second.size());
  const double extreme = std::ceil(std::min(smaller, pairs - smaller));
  return std::min(1.0, 2.0 * PairCount(first.size(), second.size()).at_most(extreme));
}

Shift rank_shift(const std::vector<double>& first, const std::vector<double>& second) {
  std::vector<double> differences;
  differences.reserve(first.size() * second.size());
  for (const double a : first)
    for (const double b : second) differences.push_back(b - a);
  if (differences.empty()) throw std::invalid_argument("a shift needs at least one sample on each side");
  std::sort(differences.begin(), differences.end());
  const PairCount count(first.size(), second.size());
  const double outside = 0.025;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::size_t cut = 0;  // differences outside the interval on either side, plus one
  while (2 * cut < differences.size() && count.at_most(static_cast<double>(cut)) <= outside) ++cut;
  Shift shift{run::median(differences), -infinity, infinity};
  if (cut > 0) shift.low = differences[cut - 1], shift.high = differences[differences.size() - cut];
  return shift;
}

std::vector<double> correct_for_count(const std::vector<double>& probabilities) {
  std::vector<std::size_t> order(probabilities.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return probabilities[a] < probabilities[b]; });
  std::vector<double> corrected(probabilities.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto left = static_cast<double>(order.size() - i);
    largest = std::max(largest, std::min(1.0, left * probabilities[order[i]]));
    corrected[order[i]] = largest;
  }
  return corrected;
}

}  // namespace drogue::perf
