#include "perf/compare/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "common/program/failure.hpp"
#include "common/run/statistics.hpp"
#include "common/scene/nearest.hpp"
#include "perf/rows/printed.hpp"

namespace drogue::perf {

namespace {

/// Facts that describe the work; others are results.
constexpr const char* size_facts[] = {"backend", "cells",    "variant", "block",     "form",
                                      "grid",    "sides",    "solver",  "mesh",      "method",
                                      "memory",  "substeps", "problem", "precision", "tolerance"};
constexpr double largest_clock_change = 0.02;

std::string text_of(const nlohmann::json& value) {
  if (value.is_null()) return "unknown";
  return value.is_string() ? "'" + value.get<std::string>() + "'"
                           : value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Entry of an object, null if it is absent or there is no object.
nlohmann::json entry(const nlohmann::json& object, const char* key) {
  return object.is_object() ? object.value(key, nlohmann::json()) : nlohmann::json();
}

/// Difference of an entry of two objects.
std::optional<std::string> difference(const char* words, const char* key, const nlohmann::json& before,
                                      const nlohmann::json& after) {
  const nlohmann::json a = entry(before, key), b = entry(after, key);
  if (a == b) return std::nullopt;
  return "other " + std::string(words) + ": " + text_of(a) + ", now " + text_of(b);
}

bool is_on_gpu(const MeasuredCase& record) { return entry(record.facts, "backend") == "cuda"; }

std::optional<std::string> clock_difference(const MeasuredCase& before, const MeasuredCase& after) {
  for (const auto& [key, words] : {std::pair("sm_mhz", "clock of the GPU (MHz)"),
                                   std::pair("memory_mhz", "clock of the memory of the GPU (MHz)")}) {
    const nlohmann::json a = entry(before.clocks, key), b = entry(after.clocks, key);
    if (!a.is_number() || !b.is_number()) continue;
    const double old_clock = a.get<double>(), new_clock = b.get<double>();
    if (std::abs(new_clock - old_clock) > largest_clock_change * std::max(old_clock, new_clock))
      return difference(words, key, before.clocks, after.clocks);
  }
  return std::nullopt;
}

bool agree(double a, double b) {
  constexpr double relative = 1e-6, rounding = 1e-9, least = 1e-15, factor = 10.0;
  const double low = std::min(std::abs(a), std::abs(b)), high = std::max(std::abs(a), std::abs(b));
  return std::abs(a - b) <= relative * high || (high < rounding && high <= factor * std::max(low, least));
}

std::optional<std::string> value_change(const char* words, const std::optional<double>& before,
                                        const std::optional<double>& after) {
  if (!before && !after) return std::nullopt;
  if (before && after && agree(*before, *after)) return std::nullopt;
  const auto text = [](const std::optional<double>& value) {
    return value ? printed("%.4g", *value) : "not finite";
  };
  return std::string(words) + " " + text(before) + ", now " + text(after);
}

std::optional<double> number(const nlohmann::json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

}  // namespace

std::optional<std::string> why_not_comparable(const MeasuredCase& before, const MeasuredCase& after) {
  const auto& [old_origin, new_origin] = std::tie(before.provenance, after.provenance);
  if (auto found = difference("processor", "cpu", old_origin, new_origin)) return found;
  if (auto found = difference("GPU", "gpu", old_origin, new_origin)) return found;
  if (auto found = difference("number of threads", "threads", old_origin, new_origin)) return found;
  if (auto found = difference("compiler flags", "flags", old_origin, new_origin)) return found;
  if (before.cold_caches != after.cold_caches)
    return printed("other caches: %s", before.cold_caches ? "cold, now warm" : "warm, now cold");
  if (before.unit != after.unit) return "other unit: '" + before.unit + "', now '" + after.unit + "'";
  for (const char* fact : size_facts)
    if (auto found = difference(fact, fact, before.facts, after.facts)) return found;
  return is_on_gpu(after) ? clock_difference(before, after) : std::nullopt;
}

std::optional<std::string> error_change(const MeasuredCase& before, const MeasuredCase& after) {
  if (before.passed != after.passed) {
    const std::optional<std::string> change = value_change("error", before.error, after.error);
    return printed("check %s%s%s", after.passed ? "failed, now passed" : "passed, now failed",
                   change ? ": " : "", change ? change->c_str() : "");
  }
  if (auto found = value_change("error", before.error, after.error)) return found;
  const std::optional<double> old_error = number(entry(before.facts, "solution_error"));
  const std::optional<double> new_error = number(entry(after.facts, "solution_error"));
  return old_error && new_error ? value_change("error of the solution", old_error, new_error) : std::nullopt;
}

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

}  // namespace

const char* word(Verdict verdict) {
  constexpr const char* words[] = {"SAME",      "FASTER",         "SLOWER",
                                   "AMBIGUOUS", "NOT-COMPARABLE", "ERROR-CHANGED"};
  return words[static_cast<int>(verdict)];
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
  const std::vector<Verdict> verdicts = speed_verdict(changes);
  auto next = verdicts.begin();
  for (ComparedCase& row : rows)
    if (row.speed) row.verdict = *next++;
  return rows;
}

}  // namespace drogue::perf
