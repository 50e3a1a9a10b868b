#include "perf/compare/comparison.hpp"

#include <gtest/gtest.h>

#include <map>

#include "common/program/failure.hpp"
#include "perf/compare/annotation.hpp"

namespace drogue::perf {
namespace {

/// Record with 30 samples around `scale` seconds, two per cent apart.
MeasuredCase record_of(const std::string& name, double scale = 1.0) {
  MeasuredCase made;
  made.name = name, made.unit = "s per step", made.error = 1e-3, made.passed = true, made.place = "x.jsonl:1";
  for (int i = 0; i < 30; ++i) made.samples.push_back(scale * (1.0 + 0.01 * ((7 * i) % 3)));
  made.facts = {{"backend", "serial"}, {"cells", 1024}};
  made.provenance = {{"cpu", "a"}, {"gpu", ""}, {"threads", 2}, {"flags", "-O3"}, {"git", "1"}};
  return made;
}

Verdict verdict_on(const MeasuredCase& before, const MeasuredCase& after) {
  return compare_records({before}, {after}).front().verdict;
}

TEST(Comparison, OtherDevicesFlagsAndSizesAreNotComparable) {
  const MeasuredCase before = record_of("a");
  for (const auto& [key, value] :
       {std::pair<const char*, nlohmann::json>{"cpu", "b"}, {"gpu", "c"}, {"threads", 4}, {"flags", "-O2"}}) {
    MeasuredCase after = record_of("a");
    after.provenance[key] = value;
    EXPECT_EQ(verdict_on(before, after), Verdict::not_comparable) << key;
  }
  MeasuredCase larger = record_of("a");
  larger.facts["cells"] = 2048;
  EXPECT_EQ(compare_records({before}, {larger}).front().reason, "other cells: 1024, now 2048");
  MeasuredCase cold = record_of("a");
  cold.cold_caches = true;
  EXPECT_EQ(compare_records({before}, {cold}).front().reason, "other caches: warm, now cold");
  EXPECT_EQ(verdict_on(cold, before), Verdict::not_comparable);
  EXPECT_EQ(verdict_on(cold, cold), Verdict::same);
  MeasuredCase other_commit = record_of("a");
  other_commit.provenance["git"] = "2";
  EXPECT_EQ(verdict_on(before, other_commit), Verdict::same);
}

TEST(Comparison, ClocksMatterOnGpusAlone) {
  MeasuredCase before = record_of("a"), after = record_of("a");
  before.clocks = {{"sm_mhz", 1980}, {"throttled", ""}};
  after.clocks = {{"sm_mhz", 1500}, {"throttled", ""}};
  EXPECT_EQ(verdict_on(before, after), Verdict::same);
  before.facts["backend"] = after.facts["backend"] = "cuda";
  EXPECT_EQ(verdict_on(before, after), Verdict::not_comparable);
  after.clocks["sm_mhz"] = 1970;
  EXPECT_EQ(verdict_on(before, after), Verdict::same);
  after.clocks = nullptr, before.clocks = nullptr;
  EXPECT_EQ(verdict_on(before, after), Verdict::same);
}

TEST(Comparison, ErrorsMayDifferByRoundOff) {
  const auto verdict = [](std::optional<double> old_error, std::optional<double> new_error) {
    MeasuredCase before = record_of("a"), after = record_of("a");
    before.error = old_error, after.error = new_error;
    return verdict_on(before, after);
  };
  EXPECT_EQ(verdict(1e-3, 1e-3 * (1.0 + 1e-9)), Verdict::same);
  EXPECT_EQ(verdict(1e-3, 1.001e-3), Verdict::error_changed);
  EXPECT_EQ(verdict(1e-3, 0.5e-3), Verdict::error_changed);
  EXPECT_EQ(verdict(2e-16, 9e-16), Verdict::same);
  EXPECT_EQ(verdict(0.0, 3e-16), Verdict::same);
  EXPECT_EQ(verdict(2e-15, 1e-12), Verdict::error_changed);
  EXPECT_EQ(verdict(1e-3, std::nullopt), Verdict::error_changed);
  EXPECT_EQ(verdict(std::nullopt, std::nullopt), Verdict::same);
}

TEST(Comparison, ErrorsOfSolutionsCountToo) {
  MeasuredCase before = record_of("a"), after = record_of("a");
  before.facts["solution_error"] = 0.01, after.facts["solution_error"] = 0.02;
  EXPECT_EQ(verdict_on(before, after), Verdict::error_changed);
}

TEST(Comparison, TimesOfFailedChecksAreNone) {
  MeasuredCase before = record_of("a"), after = record_of("a", 2.0);
  after.passed = false;
  EXPECT_EQ(compare_records({before}, {after}).front().reason, "check passed, now failed");
  before.passed = false;
  EXPECT_EQ(verdict_on(before, after), Verdict::not_comparable);
}

TEST(Comparison, ListsCasesOfEitherFile) {
  const std::vector<ComparedCase> rows =
      compare_records({record_of("gas-step/serial/1024"), record_of("b")},
                      {record_of("gas-step/serial/1025"), record_of("b", 1.3)});
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].name, "gas-step/serial/1025");
  EXPECT_EQ(rows[0].verdict, Verdict::not_comparable);
  EXPECT_EQ(rows[0].reason,
            "only in the new records; the nearest case of the old ones is gas-step/serial/1024");
  EXPECT_EQ(rows[1].verdict, Verdict::slower);
  EXPECT_EQ(rows[2].name, "gas-step/serial/1024");
  EXPECT_EQ(rows[0].presence, Presence::new_alone);
  EXPECT_EQ(rows[1].presence, Presence::both);
  EXPECT_EQ(rows[2].presence, Presence::old_alone);
  EXPECT_EQ(rows[1].old_time, 1.01);
  EXPECT_EQ(rows[1].new_time, 1.3 * 1.01);
}

TEST(Comparison, RecordsWithoutSamplesHaveNoSpeed) {
  MeasuredCase before = record_of("a"), after = record_of("a");
  before.samples.clear(), after.samples.clear();
  EXPECT_EQ(verdict_on(before, after), Verdict::not_comparable);
}

TEST(Comparison, RefusesOneCaseOfTwoMachinesInAFile) {
  MeasuredCase other = record_of("a");
  other.provenance["cpu"] = "b", other.place = "x.jsonl:2";
  try {
    compare_records({record_of("a"), other}, {record_of("a")});
    FAIL() << "not refused";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::invalid_scene);
    EXPECT_STREQ(failure.what(),
                 "x.jsonl:2: a stands in x.jsonl:1 too, but differs: other processor: 'a', now 'b'");
  }
}

TEST(Comparison, FindsAPlantedSlowdownInMeasuredRecordsAlone) {
  const std::string folder = std::string(DROGUE_SOURCE_DIR) + "/docs/evidence/planted/";
  const std::vector<MeasuredCase> before = read_records(folder + "old.jsonl"),
                                  after = read_records(folder + "new.jsonl");
  for (const ComparedCase& row : compare_records(before, after))
    EXPECT_EQ(row.verdict == Verdict::slower || row.verdict == Verdict::faster,
              row.name == "tridiagonal/serial/64/scan/64")
        << row.name << " " << word(row.verdict);
  for (const ComparedCase& row : compare_records(before, before))
    EXPECT_EQ(row.verdict, Verdict::same) << row.name;
}

const std::string evidence = std::string(DROGUE_SOURCE_DIR) + "/docs/evidence/";

/// Records of the cases of a file, a table of all cases for each run.
std::vector<std::vector<MeasuredCase>> runs_of(const std::string& file) {
  std::vector<std::vector<MeasuredCase>> runs;
  std::map<std::string, std::size_t> next;
  for (const MeasuredCase& record : read_records(evidence + file)) {
    const std::size_t run = next[record.name]++;
    if (run == runs.size()) runs.emplace_back();
    runs[run].push_back(record);
  }
  return runs;
}

/// Number of "slower" and "faster" among the verdicts; with `factor`, the times of `after` are so much
/// longer.
int changes(const std::vector<MeasuredCase>& before, std::vector<MeasuredCase> after, double factor = 1.0) {
  for (MeasuredCase& record : after)
    for (double& sample : record.samples) sample *= factor;
  int count = 0;
  for (const ComparedCase& row : compare_records(before, after))
    count += row.verdict == Verdict::slower || row.verdict == Verdict::faster ? 1 : 0;
  return count;
}

TEST(Comparison, EqualBuildsDoNotDiffer) {
  const std::vector<MeasuredCase> first = read_records(evidence + "quick/first.jsonl"),
                                  second = read_records(evidence + "quick/second.jsonl");
  EXPECT_EQ(changes(first, second), 0);
  EXPECT_EQ(changes(second, first), 0);
  // A tenth is found nevertheless.
  EXPECT_GE(changes(first, second, 1.1), 9 * static_cast<int>(first.size()) / 10);
  EXPECT_GE(changes(first, second, 1.0 / 1.1), 9 * static_cast<int>(first.size()) / 10);
}

TEST(Comparison, IsWrongForAtMostATwentiethOfRecordedPairsOfEqualBuilds) {
  int compared = 0, wrong = 0;
  for (const std::string folder : {"before-coupling/cuda", "before-coupling", "restructured"})
    for (const std::string side : {"old", "new"}) {
      const auto runs = runs_of(folder + "/" + side + ".jsonl");
      for (std::size_t i = 0; i < runs.size(); ++i)
        for (std::size_t k = i + 1; k < runs.size(); ++k) {
          compared += static_cast<int>(runs[i].size());
          wrong += changes(runs[i], runs[k]);
        }
    }
  EXPECT_EQ(compared, 580);
  EXPECT_LE(wrong, compared / 20);
}

TEST(Comparison, ThreeRunsOfAGpuFindATwentieth) {
  const auto runs = runs_of("before-coupling/cuda/old.jsonl"),
             others = runs_of("before-coupling/cuda/new.jsonl");
  for (const auto& all : {runs, others}) {
    std::vector<MeasuredCase> before, after;
    for (std::size_t run = 0; run < 3; ++run) {
      before.insert(before.end(), all[run].begin(), all[run].end());
      after.insert(after.end(), all[run + 1].begin(), all[run + 1].end());
    }
    EXPECT_EQ(changes(before, after), 0);
    EXPECT_EQ(changes(before, after, 1.05), static_cast<int>(all[0].size()));
  }
}

TEST(Annotation, EscapesWhatEndsItAndHoldsNoVerdict) {
  ComparedCase row{"a:b,c", Verdict::error_changed, "error 1 %\nnow 2", {}};
  EXPECT_EQ(annotation(row, true), "::error title=a%3Ab%2Cc::error 1 %25%0Anow 2\n");
  EXPECT_EQ(annotation(row, false).substr(0, 10), "::warning ");
  row.verdict = Verdict::same;
  EXPECT_EQ(annotation(row, false), "");
  EXPECT_EQ(annotation({"a", Verdict::not_comparable, "gone", {}}, true), "::error title=a::gone\n");
  const ComparedCase slow{"a", Verdict::slower, "", SpeedChange{1.3, 1.2, 1.4}};
  EXPECT_EQ(annotation(slow, false),
            "::warning title=a::takes 1.300 times as long (1.200 to 1.400 with 95 %25 confidence)\n");
}

}  // namespace
}  // namespace drogue::perf
