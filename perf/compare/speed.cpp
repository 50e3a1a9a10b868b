#include "perf/compare/speed.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "perf/compare/rank_test.hpp"

namespace drogue::perf {

namespace {

/// Blocks of a run: short ones, which few disturbances cover, and long ones, whose quartiles follow a drift.
struct Blocks {
  std::size_t least_length, most;
};
constexpr Blocks short_blocks = {5, 6}, long_blocks = {5, 3};
/// Quantile of blocks, with the gap between the long blocks of two sides over the spread of those of one side
/// that it needs: a drift that goes on from one side to the other gives at most a half. Disturbances prolong
/// a time, so the lower quartile outlasts bursts that a median does not; where a minority of the samples is
/// fast, the median is the steadier one, but it follows a clock of two states.
struct BlockRule {
  double level, least_gap;
};
constexpr BlockRule block_rules[] = {{0.25, 0.8}, {0.5, 1.1}};
/// Correlation of the ranks of a run with their order or with their predecessors, below which the samples
/// count as independent; and the number of samples that show it.
constexpr double most_dependence = 0.3;
constexpr std::size_t least_independent = 15;
/// Logarithm of a change that needs no agreement of blocks, if the fastest sample moves by half of it at
/// least.
const double large_change = std::log(1.25);
/// Runs a side whose medians are tested, and standard errors of their difference that a change exceeds: 5
/// have a probability of 0.25 % for four runs a side, of 0.1 % for five.
constexpr std::size_t runs_of_a_test = 4;
constexpr double least_errors = 5.0;
/// Part of a change by which the fastest sample must move: of a single run a side more, since other work may
/// last for all of a run.
constexpr double fastest_of_one_run = 0.6, fastest_of_several = 1.0 / 3.0;

/// Quantile by linear interpolation between order statistics.
double quantile(std::vector<double> values, double level) {
  std::sort(values.begin(), values.end());
  const double place = level * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - static_cast<double>(below));
}

/// Quantiles of blocks of successive samples of a run. A single run of four samples or more has two blocks at
/// least. Several runs share the blocks, so that more samples make them longer.
std::vector<double> quantiles_of(const Blocks& kind, const Runs& runs, double level) {
  std::vector<double> quantiles;
  const std::size_t most = std::max<std::size_t>(kind.most / runs.size(), 1);
  for (const std::vector<double>& run : runs) {
    const std::size_t n = run.size(), least = n >= 4 ? 2 : 1;
    const std::size_t count = std::clamp<std::size_t>(n / kind.least_length, std::min(least, most), most);
    const auto start = [&](std::size_t k) {
      return run.begin() + static_cast<std::ptrdiff_t>(k * n / count);
    };
    for (std::size_t k = 0; k < count; ++k) quantiles.push_back(quantile({start(k), start(k + 1)}, level));
  }
  return quantiles;
}

Runs logarithms_of(Runs runs) {
  for (std::vector<double>& run : runs)
    for (double& value : run) value = std::log(value);
  return runs;
}

std::vector<double> joined(const Runs& runs) {
  std::vector<double> all;
  for (const std::vector<double>& run : runs) all.insert(all.end(), run.begin(), run.end());
  return all;
}

/// Value of the smallest magnitude if all have one sign, else zero.
double agreement(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *low > 0.0 ? *low : *high < 0.0 ? *high : 0.0;
}

/// Signed distance from the values of one side to those of the other; zero if the two ranges overlap.
double gap(const std::vector<double>& first, const std::vector<double>& second) {
  const auto [first_low, first_high] = std::minmax_element(first.begin(), first.end());
  const auto [second_low, second_high] = std::minmax_element(second.begin(), second.end());
  return agreement({*second_low - *first_high, *second_high - *first_low});
}

double spread(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

/// Change of the blocks of two sides by a rule; zero if they do not agree on its sign, or are no further
/// apart than those of one side.
double change_of_blocks(const BlockRule& rule, const Runs& before, const Runs& after) {
  const std::vector<double> old_parts = quantiles_of(long_blocks, before, rule.level);
  const std::vector<double> new_parts = quantiles_of(long_blocks, after, rule.level);
  if (std::abs(gap(old_parts, new_parts)) <= rule.least_gap * std::max(spread(old_parts), spread(new_parts)))
    return 0.0;
  // Quantiles of short blocks are uncertain: of their gap a third of a change suffices.
  return agreement({quantile(joined(after), rule.level) - quantile(joined(before), rule.level),
                    3.0 * gap(quantiles_of(short_blocks, before, rule.level),
                              quantiles_of(short_blocks, after, rule.level))});
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double squared_deviations(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += (value - mean(values)) * (value - mean(values));
  return sum;
}

/// Change of the medians of the runs of two sides, of `runs_of_a_test` at least; zero if it is no multiple of
/// its standard error (Student), in which the noise between runs counts.
double change_of_runs(const Runs& before, const Runs& after) {
  if (std::min(before.size(), after.size()) < runs_of_a_test) return 0.0;
  std::vector<double> sides[2];
  for (const std::vector<double>& run : before) sides[0].push_back(quantile(run, 0.5));
  for (const std::vector<double>& run : after) sides[1].push_back(quantile(run, 0.5));
  const auto first = static_cast<double>(before.size()), second = static_cast<double>(after.size());
  const double variance =
      (squared_deviations(sides[0]) + squared_deviations(sides[1])) / (first + second - 2.0);
  const double change = mean(sides[1]) - mean(sides[0]);
  return std::abs(change) > least_errors * std::sqrt(variance * (1.0 / first + 1.0 / second)) ? change : 0.0;
}

/// Ranks of values less their mean; equal values share a rank.
std::vector<double> centred_ranks(const std::vector<double>& values) {
  std::vector<double> ranks;
  for (const double value : values) {
    double rank = -0.5 * static_cast<double>(values.size());
    for (const double other : values) rank += other < value ? 1.0 : other == value ? 0.5 : 0.0;
    ranks.push_back(rank);
  }
  return ranks;
}

/// True if the samples of each run neither follow their order nor their predecessors, so that a test by ranks
/// is valid. False for short runs.
bool are_independent(const Runs& runs) {
  for (const std::vector<double>& run : runs) {
    if (run.size() < least_independent) return false;
    const std::vector<double> ranks = centred_ranks(run);
    const double middle = 0.5 * static_cast<double>(run.size() - 1);
    double squares = 0.0, trend = 0.0, order_squares = 0.0;
    for (std::size_t i = 0; i < ranks.size(); ++i) {
      const double order = static_cast<double>(i) - middle;
      squares += ranks[i] * ranks[i], trend += ranks[i] * order, order_squares += order * order;
    }
    if (std::abs(trend) >= most_dependence * std::sqrt(squares * order_squares) && squares > 0.0)
      return false;
    for (std::size_t lag = 1; lag <= 2; ++lag) {
      double products = 0.0;
      for (std::size_t i = lag; i < ranks.size(); ++i) products += ranks[i] * ranks[i - lag];
      if (products >= most_dependence * squares && squares > 0.0) return false;
    }
  }
  return true;
}

double larger(double a, double b) { return std::abs(a) > std::abs(b) ? a : b; }

}  // namespace

SpeedChange compare_speed(const Runs& before, const Runs& after) {
  const Runs old_runs = logarithms_of(before), new_runs = logarithms_of(after);
  const std::vector<double> old_all = joined(old_runs), new_all = joined(new_runs);
  const Shift shift = rank_shift(old_all, new_all);
  double agreed = change_of_runs(old_runs, new_runs);
  for (const BlockRule& rule : block_rules)
    agreed = larger(agreed, change_of_blocks(rule, old_runs, new_runs));
  // Other work on the machine prolongs most samples of a run, but seldom all: a change moves the fastest one
  // too.
  const double fastest = std::ranges::min(new_all) - std::ranges::min(old_all);
  const double near_end = shift.low > 0.0 ? shift.low : shift.high < 0.0 ? shift.high : 0.0;
  const bool is_large = std::abs(near_end) >= large_change && 2.0 * fastest * near_end >= near_end * near_end;
  if (is_large || (are_independent(old_runs) && are_independent(new_runs))) agreed = larger(agreed, near_end);
  const std::size_t runs = std::min(before.size(), after.size());
  const double part = runs == 1 ? fastest_of_one_run : fastest_of_several;
  if (fastest * shift.estimate <= part * shift.estimate * shift.estimate) agreed = 0.0;
  return {.ratio = std::exp(shift.estimate),
          .low = std::exp(shift.low),
          .high = std::exp(shift.high),
          .probability = rank_test(old_all, new_all),
          .agreed = agreement({shift.estimate, agreed}),
          .identical = before == after,
          .least = smallest_effect(runs)};
}

double smallest_effect(std::size_t runs) { return runs <= 1 ? 0.075 : runs == 2 ? 0.05 : 0.03; }

bool has_interval(const SpeedChange& change) { return std::isfinite(change.high); }

std::vector<Verdict> speed_verdict(const std::vector<SpeedChange>& changes) {
  std::vector<double> probabilities;
  for (const SpeedChange& change : changes) probabilities.push_back(change.probability);
  probabilities = correct_for_count(probabilities);
  std::vector<Verdict> verdicts;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const SpeedChange& change = changes[i];
    const double agreed = std::abs(change.agreed), shift = std::abs(std::log(change.ratio));
    const double smallest = std::log1p(smallest_effect(many_runs)), unseen = std::log1p(largest_unseen);
    if (probabilities[i] < false_alarm && agreed >= smallest && shift >= std::log1p(change.least))
      verdicts.push_back(change.agreed > 0.0 ? Verdict::slower : Verdict::faster);
    else if (has_interval(change) &&
             (change.identical ||
              (shift < smallest && std::log(change.high) <= unseen && std::log(change.low) >= -unseen)))
      verdicts.push_back(Verdict::same);
    else
      verdicts.push_back(Verdict::ambiguous);
  }
  return verdicts;
}

Goal goal(const SpeedChange& cost, double largest) {
  if (cost.high <= largest) return Goal::met;
  return cost.low > largest ? Goal::missed : Goal::undecided;
}

const char* name(Goal goal) {
  return goal == Goal::met ? "met" : goal == Goal::missed ? "missed" : "undecided";
}

}  // namespace drogue::perf
