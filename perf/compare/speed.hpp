#pragma once

#include <vector>

namespace drogue::perf {

/// Samples of one case, s: one list per run of the program, in the order of measurement.
using Runs = std::vector<std::vector<double>>;

/// Time of a case against its former time.
struct SpeedChange {
  double ratio = 1.0;  ///< new over old time, estimated from all pairs of samples
  double low = 1.0;    ///< interval that holds the ratio with a probability of at least 95 %
  double high = 1.0;
  double probability = 1.0;  ///< of such ranks without any change, for this case alone
  /// Change that is no drift and no jump of a clock: the logarithm of a ratio. Blocks of the samples agree on
  /// it, or the samples are independent, or it is large; zero otherwise.
  double agreed = 0.0;
  bool identical = false;  ///< both sides hold the same samples
};

/// Change from the samples of both sides, which are positive and not empty. Does not throw.
SpeedChange compare_speed(const Runs& before, const Runs& after);

enum class SpeedVerdict { same, faster, slower, ambiguous };

/// Smallest change of time that is called one.
inline constexpr double smallest_effect = 0.03;
/// Change of time that "same" excludes: with noisier samples it is "ambiguous".
inline constexpr double largest_unseen = 0.1;
/// Probability of any wrong "faster" or "slower" among all cases.
inline constexpr double false_alarm = 0.05;

/// Verdicts of all cases of a comparison, whose probabilities are corrected for their number. "faster" and
/// "slower" also need the smallest effect and one of three: blocks that agree on it, since a clock that
/// drifts or jumps moves blocks of one side as far apart as those of both sides; samples without dependence
/// on their order; or a change of a quarter that moves the fastest sample too. Does not throw.
std::vector<SpeedVerdict> speed_verdict(const std::vector<SpeedChange>& changes);

}  // namespace drogue::perf
