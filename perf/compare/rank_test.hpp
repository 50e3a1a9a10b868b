#pragma once

#include <vector>

namespace drogue::perf {

/// Two-sided probability that a rank sum at least as extreme arises from two samples of one distribution
/// (Mann and Whitney 1947): exact for at most 100 values without ties between the samples, with ties an upper
/// bound; beyond, by the normal limit with correction for continuity. 1 if a sample is empty. Does not throw.
double rank_test(const std::vector<double>& first, const std::vector<double>& second);

/// Shift of the second sample against the first one.
struct Shift {
  double estimate = 0.0;  ///< median of all differences (Hodges and Lehmann 1963)
  double low = 0.0;       ///< interval that holds the true shift with a probability of at least 95 %
  double high = 0.0;
};

/// Shift by the distribution of the rank test. The interval is infinite where the samples are too few for 95
/// %. Throws std::invalid_argument if a sample is empty.
Shift rank_shift(const std::vector<double>& first, const std::vector<double>& second);

/// Probabilities corrected for their number (Holm 1979), in the order of the argument: rejecting those below
/// alpha errs at all with a probability of at most alpha. Does not throw.
std::vector<double> correct_for_count(const std::vector<double>& probabilities);

}  // namespace drogue::perf
