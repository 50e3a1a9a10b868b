#include "perf/compare/speed.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "perf/compare/rank_test.hpp"

namespace drogue::perf {

namespace {

/// Blocks of a run: short ones, which few disturbances cover, and long ones, whose quartiles follow a drift.
struct Blocks {
  std::size_t least_length, most;
};
constexpr Blocks short_blocks = {5, 6}, long_blocks = {5, 3};
/// Gap between the long blocks of two sides over the spread of those of one side: a drift that goes on from
/// one side to the other gives at most a half.
constexpr double least_gap = 0.8;

/// Quantile by linear interpolation between order statistics.
double quantile(std::vector<double> values, double level) {
  std::sort(values.begin(), values.end());
  const double place = level * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], place - static_cast<double>(below));
}

/// Lower quartiles of blocks of successive samples of a run. A single run of four samples or more has two
/// blocks at least. Several runs share the blocks, so that more samples make them longer. Disturbances
/// prolong a time, so the lower quartile outlasts bursts that a median does not.
std::vector<double> quartiles_of(const Blocks& kind, const Runs& runs) {
  std::vector<double> quartiles;
  const std::size_t most = std::max<std::size_t>(kind.most / runs.size(), 1);
  for (const std::vector<double>& run : runs) {
    const std::size_t n = run.size(), least = n >= 4 ? 2 : 1;
    const std::size_t count = std::clamp<std::size_t>(n / kind.least_length, std::min(least, most), most);
    const auto start = [&](std::size_t k) {
      return run.begin() + static_cast<std::ptrdiff_t>(k * n / count);
    };
    for (std::size_t k = 0; k < count; ++k) quartiles.push_back(quantile({start(k), start(k + 1)}, 0.25));
  }
  return quartiles;
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

}  // namespace

SpeedChange compare_speed(const Runs& before, const Runs& after) {
  const Runs old_runs = logarithms_of(before), new_runs = logarithms_of(after);
  const std::vector<double> old_all = joined(old_runs), new_all = joined(new_runs);
  const Shift shift = rank_shift(old_all, new_all);
  std::vector<double> changes = {shift.estimate};
  for (const double level : {0.25, 0.5})
    changes.push_back(quantile(new_all, level) - quantile(old_all, level));
  // Other work on the machine prolongs most samples of a run, but seldom all: a change moves the fastest one
  // too.
  const double fastest = std::ranges::min(new_all) - std::ranges::min(old_all);
  if (3.0 * fastest * shift.estimate <= shift.estimate * shift.estimate) changes.push_back(0.0);
  // Quartiles of blocks are uncertain: of their gap a third of a change suffices.
  changes.push_back(3.0 * gap(quartiles_of(short_blocks, old_runs), quartiles_of(short_blocks, new_runs)));
  const std::vector<double> old_parts = quartiles_of(long_blocks, old_runs);
  const std::vector<double> new_parts = quartiles_of(long_blocks, new_runs);
  const double within = least_gap * std::max(spread(old_parts), spread(new_parts));
  if (std::abs(gap(old_parts, new_parts)) <= within) changes.push_back(0.0);
  return {std::exp(shift.estimate),    std::exp(shift.low), std::exp(shift.high),
          rank_test(old_all, new_all), agreement(changes),  before == after};
}

std::vector<SpeedVerdict> speed_verdict(const std::vector<SpeedChange>& changes) {
  std::vector<double> probabilities;
  for (const SpeedChange& change : changes) probabilities.push_back(change.probability);
  probabilities = correct_for_count(probabilities);
  std::vector<SpeedVerdict> verdicts;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const SpeedChange& change = changes[i];
    const double smallest = std::log1p(smallest_effect), unseen = std::log1p(largest_unseen);
    if (probabilities[i] < false_alarm && std::abs(change.agreed) >= smallest)
      verdicts.push_back(change.agreed > 0.0 ? SpeedVerdict::slower : SpeedVerdict::faster);
    else if (change.identical || (std::abs(std::log(change.ratio)) < smallest &&
                                  std::log(change.high) <= unseen && std::log(change.low) >= -unseen))
      verdicts.push_back(SpeedVerdict::same);
    else
      verdicts.push_back(SpeedVerdict::ambiguous);
  }
  return verdicts;
}

}  // namespace drogue::perf
