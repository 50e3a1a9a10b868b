#include "perf/compare/comparison.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "common/program/failure.hpp"
#include "common/run/statistics.hpp"
#include "common/scene/nearest.hpp"
#include "perf/compare/comparability.hpp"

namespace drogue::perf {

namespace {

/// Records of one case in one file.
struct CaseRuns {
  std::string name;
  MeasuredCase last;  ///< the latest record; failed if one of all failed
  Runs runs;
};

std::vector<CaseRuns> group_by_case(const std::vector<MeasuredCase>& records) {
  std::vector<CaseRuns> groups;
  std::map<std::string, std::size_t> index;
  for (const MeasuredCase& record : records) {
    const auto [place, is_new] = index.try_emplace(record.name, groups.size());
    if (is_new) groups.push_back({record.name, record, {}});
    CaseRuns& group = groups[place->second];
    if (const auto reason = why_not_comparable(group.last, record))
      throw Failure(ExitCode::invalid_scene, record.place + ": " + record.name + " stands in " +
                                                 group.last.place + " too, but differs: " + *reason);
    const bool passed = group.last.passed && record.passed;
    group.last = record;
    group.last.passed = passed;
    if (!record.samples.empty()) group.runs.push_back(record.samples);
  }
  return groups;
}

const CaseRuns* find(const std::vector<CaseRuns>& groups, const std::string& name) {
  const auto found = std::ranges::find(groups, name, &CaseRuns::name);
  return found == groups.end() ? nullptr : &*found;
}

std::string describe_missing(const std::string& where, const std::string& elsewhere, const std::string& name,
                             const std::vector<CaseRuns>& others) {
  std::vector<std::string> names;
  for (const CaseRuns& other : others) names.push_back(other.name);
  const auto nearest = scene::nearest(name, names);
  return "only in the " + where + " records" +
         (nearest ? "; the nearest case of the " + elsewhere + " ones is " + *nearest : "");
}

double median_of(const Runs& runs) {
  std::vector<double> all;
  for (const std::vector<double>& run : runs) all.insert(all.end(), run.begin(), run.end());
  return run::median(std::move(all));
}

/// Row of a case that one file lacks.
ComparedCase one_sided(const CaseRuns& group, Presence presence, const std::vector<CaseRuns>& others) {
  const bool is_old = presence == Presence::old_alone;
  ComparedCase row{group.name,
                   Verdict::not_comparable,
                   describe_missing(is_old ? "old" : "new", is_old ? "new" : "old", group.name, others),
                   {}};
  row.presence = presence;
  return row;
}

ComparedCase compare_case(const CaseRuns& before, const CaseRuns& after) {
  if (auto reason = why_not_comparable(before.last, after.last))
    return {after.name, Verdict::not_comparable, *reason, {}};
  if (auto reason = error_change(before.last, after.last))
    return {after.name, Verdict::error_changed, *reason, {}};
  if (!after.last.passed)
    return {after.name, Verdict::not_comparable, "the check of both records failed", {}};
  if (before.runs.empty() || after.runs.empty()) {
    ComparedCase row{after.name, Verdict::not_comparable, "a record without samples", {}};
    row.untimed = before.runs.empty();
    return row;
  }
  return {.name = after.name,
          .verdict = Verdict::ambiguous,
          .reason = "",
          .speed = compare_speed(before.runs, after.runs),
          .old_time = median_of(before.runs),
          .new_time = median_of(after.runs),
          .unit = after.last.unit};
}

Verdict verdict_of(SpeedVerdict speed) {
  switch (speed) {
    case SpeedVerdict::same:
      return Verdict::same;
    case SpeedVerdict::faster:
      return Verdict::faster;
    case SpeedVerdict::slower:
      return Verdict::slower;
    case SpeedVerdict::ambiguous:
      break;
  }
  return Verdict::ambiguous;
}

}  // namespace

const char* word(Verdict verdict) {
  switch (verdict) {
    case Verdict::same:
      return "SAME";
    case Verdict::faster:
      return "FASTER";
    case Verdict::slower:
      return "SLOWER";
    case Verdict::ambiguous:
      return "AMBIGUOUS";
    case Verdict::not_comparable:
      return "NOT-COMPARABLE";
    case Verdict::error_changed:
      break;
  }
  return "ERROR-CHANGED";
}

bool is_lost(const ComparedCase& row) {
  return row.verdict == Verdict::not_comparable && row.presence != Presence::new_alone && !row.untimed;
}

std::vector<ComparedCase> compare_records(const std::vector<MeasuredCase>& before,
                                          const std::vector<MeasuredCase>& after) {
  const std::vector<CaseRuns> old_cases = group_by_case(before), new_cases = group_by_case(after);
  std::vector<ComparedCase> rows;
  for (const CaseRuns& group : new_cases) {
    const CaseRuns* old_case = find(old_cases, group.name);
    rows.push_back(old_case ? compare_case(*old_case, group)
                            : one_sided(group, Presence::new_alone, old_cases));
  }
  for (const CaseRuns& group : old_cases)
    if (!find(new_cases, group.name)) rows.push_back(one_sided(group, Presence::old_alone, new_cases));
  std::vector<SpeedChange> changes;
  for (const ComparedCase& row : rows)
    if (row.speed) changes.push_back(*row.speed);
  const std::vector<SpeedVerdict> verdicts = speed_verdict(changes);
  auto next = verdicts.begin();
  for (ComparedCase& row : rows)
    if (row.speed) row.verdict = verdict_of(*next++);
  return rows;
}

}  // namespace drogue::perf
