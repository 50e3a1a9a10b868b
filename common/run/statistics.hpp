#pragma once

#include <cmath>
#include <vector>

namespace drogue::run {

/// Maximum of two numbers; NaN if either is NaN, so that no check passes on an invalid state. Does not throw.
[[nodiscard]] inline double maximum_or_nan(double a, double b) { return a > b || std::isnan(a) ? a : b; }

/// Median and an interval that covers the true median with at least probability `coverage`, for any
/// distribution of the samples.
struct MedianInterval {
  double median = 0.0;
  double low = 0.0;
  double high = 0.0;
  double coverage = 0.0;  ///< of the interval; lower than requested for too few samples
};

/// Middle value, or the mean of the two middle ones. Throws std::invalid_argument if there are no samples.
double median(std::vector<double> samples);

/// Order-statistic interval (binomial, p = 1/2): the narrowest symmetric pair of samples that reaches
/// `coverage`, the extremes if none does. Throws std::invalid_argument if there are no samples.
MedianInterval median_interval(std::vector<double> samples, double coverage = 0.95);

}  // namespace drogue::run
