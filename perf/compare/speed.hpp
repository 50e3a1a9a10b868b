#pragma once

#include <cstddef>
#include <vector>

namespace drogue::perf {

/// Samples of one case, s: one list per run of the program, in the order of measurement.
using Runs = std::vector<std::vector<double>>;

/// Smallest change of time that is called one, from as many runs a side: 7.5 % of one run, 5 % of two, 3 % of
/// `many_runs`. Addresses of memory, neighbours and clocks last for a run, so that its samples do not show
/// them: on a quiet machine two runs of a build differ by 5.6 % in one of 59 cases
/// (`docs/evidence/quick`), on a virtual one by 7 % in one of ten. Does not throw.
double smallest_effect(std::size_t runs);
inline constexpr std::size_t many_runs = 3;

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
  double least =
      smallest_effect(many_runs);  ///< change that counts as one, by the runs of the side with fewer
};

/// True if the samples are enough for an interval; fewer can show neither a change nor that there is none.
/// Does not throw.
bool has_interval(const SpeedChange& change);

/// Change from the samples of both sides, which are positive and not empty. Does not throw.
SpeedChange compare_speed(const Runs& before, const Runs& after);

/// Verdict on one case of two files of records; the first four are those on its times.
enum class Verdict { same, faster, slower, ambiguous, not_comparable, error_changed };

/// Change of time that "same" excludes: with noisier samples it is "ambiguous".
inline constexpr double largest_unseen = 0.1;
/// Probability of any wrong "faster" or "slower" among all cases.
inline constexpr double false_alarm = 0.05;

/// Verdicts of all cases of a comparison, whose probabilities are corrected for their number. "faster" and
/// "slower" also need the smallest effect of their runs and one of three: blocks that agree on it, since a
/// clock that drifts or jumps moves blocks of one side as far apart as those of both sides; samples without
/// dependence on their order; or a change of a quarter that moves the fastest sample too. Without an interval
/// all is "ambiguous". Does not throw.
std::vector<Verdict> speed_verdict(const std::vector<SpeedChange>& changes);

/// Largest ratio of the time of a kernel in Kokkos to that of the same algorithm in CUDA that is a goal.
inline constexpr double largest_version_cost = 1.05;

/// Verdict on a ratio of times against a goal.
enum class Goal {
  met,        ///< the whole interval is below it
  missed,     ///< the whole interval is above it
  undecided,  ///< the interval contains it: the samples are too few or too noisy
};

/// Goal of a time that is at most `largest` times the former one. Does not throw.
Goal goal(const SpeedChange& cost, double largest = largest_version_cost);

/// "met", "missed" or "undecided". Does not throw.
const char* name(Goal goal);

}  // namespace drogue::perf
