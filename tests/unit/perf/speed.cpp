#include "perf/compare/speed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>

// Generators with fixed seeds stand for machines: no test here reads a clock.
namespace drogue::perf {
namespace {

using Random = std::mt19937_64;

/// Samples of one run of `count` samples. Standard distributions differ among libraries; these do not.
using Machine = std::function<std::vector<double>(Random&, int count)>;

double uniform(Random& random) { return (static_cast<double>(random() >> 11) + 0.5) / 9007199254740992.0; }

double normal(Random& random) {
  return std::sqrt(-2.0 * std::log(uniform(random))) * std::cos(6.283185307179586 * uniform(random));
}

std::vector<double> quiet(Random& random, int count) {
  std::vector<double> samples;
  for (int i = 0; i < count; ++i) samples.push_back(1e-3 * (1.0 + 0.03 * normal(random)));
  return samples;
}

/// A fifth of the samples is longer, by a Pareto distribution without a mean.
std::vector<double> heavy_tails(Random& random, int count) {
  std::vector<double> samples = quiet(random, count);
  for (double& sample : samples)
    if (uniform(random) < 0.2) sample *= std::pow(uniform(random), -1.0);
  return samples;
}

/// Trend of up to a tenth in either direction over the run.
std::vector<double> drift(Random& random, int count) {
  std::vector<double> samples = quiet(random, count);
  const double slope = 0.2 * (uniform(random) - 0.5) / count;
  for (int i = 0; i < count; ++i) samples[static_cast<std::size_t>(i)] *= 1.0 + slope * i;
  return samples;
}

/// Clock of two states a fifth apart, which last `dwell` samples on average.
std::vector<double> two_states(Random& random, int count, double dwell) {
  std::vector<double> samples = quiet(random, count);
  bool is_slow = uniform(random) < 0.5;
  for (double& sample : samples) {
    if (uniform(random) < 1.0 / dwell) is_slow = !is_slow;
    if (is_slow) sample *= 1.2;
  }
  return samples;
}

const std::map<std::string, Machine> machines = {
    {"quiet", quiet},
    {"heavy tails", heavy_tails},
    {"drift", drift},
    {"two states", [](Random& random, int count) { return two_states(random, count, 2.0); }},
    {"two states that last", [](Random& random, int count) { return two_states(random, count, 8.0); }},
    {"all of it", [](Random& random, int count) {
       std::vector<double> samples = heavy_tails(random, count);
       const std::vector<double> trend = drift(random, count), clock = two_states(random, count, 4.0);
       for (std::size_t i = 0; i < samples.size(); ++i) samples[i] *= 1e6 * trend[i] * clock[i];
       return samples;
     }}};

constexpr int pairs = 200;

/// Verdicts on pairs of runs, each a comparison of its own, the second of them `factor` times as long.
std::map<Verdict, int> verdicts(const Machine& machine, int count, double factor) {
  Random random(2026);
  std::map<Verdict, int> found;
  for (int pair = 0; pair < pairs; ++pair) {
    const std::vector<double> before = machine(random, count);
    std::vector<double> after = machine(random, count);
    for (double& sample : after) sample *= factor;
    ++found[speed_verdict({compare_speed({before}, {after})}).front()];
  }
  return found;
}

TEST(Verdict, IsWrongForAtMostATwentiethOfEqualRuns) {
  for (const auto& [name, machine] : machines) {
    std::map<Verdict, int> found = verdicts(machine, 30, 1.0);
    EXPECT_LE(found[Verdict::slower] + found[Verdict::faster], pairs / 20) << name;
    // Doubt is no error, but on a quiet machine it would be no help.
    const bool is_clear = name == "quiet" || name == "heavy tails";
    EXPECT_GE(found[Verdict::same], is_clear ? 9 * pairs / 10 : 0) << name;
  }
}

TEST(Verdict, FindsATenthAtThreePercentNoise) {
  EXPECT_GE(verdicts(quiet, 30, 1.10)[Verdict::slower], 19 * pairs / 20);
  EXPECT_GE(verdicts(quiet, 30, 1.0 / 1.10)[Verdict::faster], 19 * pairs / 20);
}

TEST(Verdict, NeverCallsATenthTheSameAtThreePercentNoise) {
  for (const int count : {7, 15, 30}) EXPECT_EQ(verdicts(quiet, count, 1.10)[Verdict::same], 0) << count;
}

TEST(Verdict, FindsOneSlowCaseAmongManyAndNoOther) {
  Random random(7);
  std::vector<SpeedChange> changes;
  for (int i = 0; i < 60; ++i) {
    std::vector<double> after = heavy_tails(random, 30);
    if (i == 41)
      for (double& sample : after) sample *= 1.3;
    changes.push_back(compare_speed({heavy_tails(random, 30)}, {after}));
  }
  const std::vector<Verdict> found = speed_verdict(changes);
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_EQ(found[i] == Verdict::slower || found[i] == Verdict::faster, i == 41) << i;
}

TEST(Verdict, TrendThatGoesOnIsNoChange) {
  std::vector<double> before, after;
  Random random(5);
  for (int i = 0; i < 30; ++i) before.push_back(1.0 + 0.004 * i + 0.005 * normal(random));
  for (int i = 30; i < 60; ++i) after.push_back(1.0 + 0.004 * i + 0.005 * normal(random));
  const SpeedChange change = compare_speed({before}, {after});
  EXPECT_LT(change.probability, 1e-6);
  EXPECT_EQ(speed_verdict({change}).front(), Verdict::ambiguous);
}

TEST(Verdict, OtherWorkBesideARunIsNoChange) {
  Random random(17);
  const std::vector<double> before = quiet(random, 30);
  std::vector<double> after = quiet(random, 30);
  // All but two samples share their core with another process.
  for (std::size_t i = 0; i < after.size(); ++i)
    if (i != 7 && i != 19) after[i] *= 1.8;
  const SpeedChange change = compare_speed({before}, {after});
  EXPECT_LT(change.probability, 1e-6);
  EXPECT_EQ(speed_verdict({change}).front(), Verdict::ambiguous);
}

TEST(Verdict, RunsOfOneBuildTeachTheNoiseBetweenRuns) {
  Random random(3);
  const auto run = [&](double level) {
    std::vector<double> samples = quiet(random, 15);
    for (double& sample : samples) sample *= level;
    return samples;
  };
  // Runs of one build that differ by 15 %: to be as fast as one of them is no change, 30 % beyond both is
  // one.
  const Runs before = {run(1.0), run(1.15)};
  EXPECT_EQ(speed_verdict({compare_speed({before[1]}, {run(1.0)})}).front(), Verdict::faster);
  EXPECT_NE(speed_verdict({compare_speed(before, {run(1.0)})}).front(), Verdict::faster);
  EXPECT_EQ(speed_verdict({compare_speed(before, {run(1.5), run(1.5)})}).front(), Verdict::slower);
}

TEST(Verdict, MoreRunsFindSmallerChanges) {
  const auto found = [](int runs) {
    Random random(29);
    int slower = 0;
    for (int pair = 0; pair < 50; ++pair) {
      Runs before, after;
      for (int run = 0; run < runs; ++run) {
        before.push_back(quiet(random, 30));
        after.push_back(quiet(random, 30));
        for (double& sample : after.back()) sample *= 1.06;
      }
      if (speed_verdict({compare_speed(before, after)}).front() == Verdict::slower) ++slower;
    }
    return slower;
  };
  const int of_one = found(1), of_three = found(3);
  EXPECT_LT(of_one, of_three);
  EXPECT_GE(of_three, 45);
}

/// Counts of verdicts on pairs of equal builds, `runs` runs a side, whose levels differ by 1.5 % from run to
/// run, as addresses and neighbours make them; the second side `factor` times as long.
std::map<Verdict, int> verdicts_of_runs(int runs, double factor) {
  Random random(31);
  std::map<Verdict, int> found;
  for (int pair = 0; pair < pairs; ++pair) {
    const auto side = [&](double scale) {
      Runs made;
      for (int run = 0; run < runs; ++run) {
        const double level = scale * std::exp(0.015 * normal(random));
        made.push_back(quiet(random, 30));
        for (double& sample : made.back()) sample *= level;
      }
      return made;
    };
    const Runs before = side(1.0), after = side(factor);
    ++found[speed_verdict({compare_speed(before, after)}).front()];
  }
  return found;
}

TEST(Verdict, NoiseBetweenRunsIsNoChange) {
  for (const int runs : {1, 2, 3, 5}) {
    std::map<Verdict, int> found = verdicts_of_runs(runs, 1.0);
    EXPECT_LE(found[Verdict::slower] + found[Verdict::faster], pairs / 50) << runs;
  }
  EXPECT_GE(verdicts_of_runs(1, 1.12)[Verdict::slower], 9 * pairs / 10);
  EXPECT_GE(verdicts_of_runs(3, 1.10)[Verdict::slower], 9 * pairs / 10);
  EXPECT_GE(verdicts_of_runs(5, 1.08)[Verdict::slower], 9 * pairs / 10);
  EXPECT_GE(verdicts_of_runs(5, 1.05)[Verdict::slower], pairs / 2);
}

TEST(Verdict, FewerRunsNeedALargerChange) {
  Random random(37);
  for (const auto& [runs, factor] : {std::pair{1, 1.06}, {2, 1.045}, {3, 1.025}})
    for (const double beyond : {0.0, 0.03}) {
      Runs before, after;
      for (int run = 0; run < runs; ++run) {
        before.emplace_back(), after.emplace_back();
        for (int i = 0; i < 30; ++i) {
          before.back().push_back(1.0 + 0.001 * normal(random));
          after.back().push_back((factor + beyond) * (1.0 + 0.001 * normal(random)));
        }
      }
      EXPECT_EQ(speed_verdict({compare_speed(before, after)}).front() == Verdict::slower, beyond > 0.0)
          << runs << " " << factor + beyond;
    }
}

TEST(Verdict, SmallChangesAreNone) {
  Random random(11);
  std::vector<double> before, after;
  for (int i = 0; i < 30; ++i)
    before.push_back(1.0 + 0.001 * normal(random)), after.push_back(1.02 + 0.001 * normal(random));
  const SpeedChange change = compare_speed({before}, {after});
  EXPECT_LT(change.probability, 1e-9);
  EXPECT_EQ(speed_verdict({change}).front(), Verdict::same);
}

TEST(Verdict, NeedsSamples) {
  EXPECT_EQ(speed_verdict({compare_speed({{1.0}}, {{2.0}})}).front(), Verdict::ambiguous);
  // Not even equal samples show that nothing changed, if they are too few.
  EXPECT_EQ(speed_verdict({compare_speed({{1.0}}, {{1.0}})}).front(), Verdict::ambiguous);
  EXPECT_EQ(speed_verdict({compare_speed({{1.0, 1.0, 1.0}}, {{1.0, 1.0, 1.0}})}).front(), Verdict::ambiguous);
  const std::vector<double> four = {1.0, 1.1, 1.2, 1.3};
  EXPECT_EQ(speed_verdict({compare_speed({four}, {four})}).front(), Verdict::same);
}

}  // namespace
}  // namespace drogue::perf
