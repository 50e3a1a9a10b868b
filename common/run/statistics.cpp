#include "common/run/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace drogue::run {
namespace {

double sorted_median(const std::vector<double>& sorted) {
  const std::size_t n = sorted.size();
  return n % 2 == 1 ? sorted[n / 2] : 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]);
}

std::vector<double> sorted_copy(std::vector<double> samples) {
  if (samples.empty()) throw std::invalid_argument("a median needs at least one sample");
  std::sort(samples.begin(), samples.end());
  return samples;
}

/// Probability of exactly k heads in n throws of a fair coin.
double binomial_half(std::size_t n, std::size_t k) {
  const auto real = [](std::size_t i) { return static_cast<double>(i); };
  const double choose =
      std::lgamma(real(n) + 1.0) - std::lgamma(real(k) + 1.0) - std::lgamma(real(n - k) + 1.0);
  return std::exp(choose - real(n) * std::log(2.0));
}

}  // namespace

double median(std::vector<double> samples) { return sorted_median(sorted_copy(std::move(samples))); }

MedianInterval median_interval(std::vector<double> samples, double coverage) {
  samples = sorted_copy(std::move(samples));
  const std::size_t n = samples.size();
  // The true median lies outside [x_(k), x_(n-1-k)] with probability 2 P(at most k of n below it).
  std::size_t cut = 0;
  double outside = 2.0 * binomial_half(n, 0);
  for (double next = outside; cut + 1 < n - 1 - cut; ++cut, outside = next) {
    next += 2.0 * binomial_half(n, cut + 1);
    if (1.0 - next < coverage) break;
  }
  return {sorted_median(samples), samples[cut], samples[n - 1 - cut], std::max(0.0, 1.0 - outside)};
}

}  // namespace drogue::run
