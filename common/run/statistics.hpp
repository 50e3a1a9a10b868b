#pragma once

#include <vector>

namespace drogue::run {

/// A median and an interval that holds the true one with at least the probability `coverage`, whatever the
/// distribution of the samples.
struct MedianInterval {
  double median = 0.0;
  double low = 0.0;
  double high = 0.0;
  double coverage = 0.0;  ///< reached; below what was asked if there are too few samples
};

/// Middle value, or the mean of the two middle ones. Throws std::invalid_argument if there are no samples.
double median(std::vector<double> samples);

/// Order-statistic interval (binomial, p = 1/2): the narrowest symmetric pair of samples that reaches
/// `coverage`, the extremes if none does. Throws std::invalid_argument if there are no samples.
MedianInterval median_interval(std::vector<double> samples, double coverage = 0.95);

}  // namespace drogue::run
