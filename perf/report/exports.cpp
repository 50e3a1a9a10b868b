#include "perf/report/exports.hpp"

#include <algorithm>
#include <set>

#include "common/csv/fields.hpp"
#include "common/csv/numbers.hpp"
#include "common/run/statistics.hpp"

namespace drogue::perf {

namespace {

std::string text_of(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return "";
  return found->is_string() ? found->get<std::string>()
                            : found->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Row of a CSV file, a field at a time.
class Row {
 public:
  void add(const std::string& text) {
    separate();
    csv::append_field(_text, text);
  }
  void add(double value) {
    separate();
    csv::append_number(_text, value);
  }
  void skip(int count) {
    for (int i = 0; i < count; ++i) separate();
  }
  [[nodiscard]] const std::string& text() const { return _text; }

 private:
  void separate() {
    if (_begun) _text += ',';
    _begun = true;
  }

  std::string _text;
  bool _begun = false;
};

nlohmann::json test_case(const MeasuredCase& record) {
  nlohmann::json made = {
      {"name", record.name},
      {"display_name", record.name + (record.cold_caches ? " with cold caches" : "")},
      {"system", record.origin("cpu") + (record.origin("gpu").empty() ? "" : ", " + record.origin("gpu"))},
      {"partition", text_of(record.facts, "backend")},
      {"environ", record.origin("compiler")},
      {"result", record.passed ? "pass" : "fail"},
      {"perfvars", nlohmann::json::array()},
      {"tags", nlohmann::json::array({"drogue-perf"})}};
  if (record.error) made["error"] = *record.error;
  // A wrong result has no time.
  if (record.samples.empty() || !record.passed) return made;
  made["perfvars"].push_back({{"name", "time"},
                              {"value", run::median(record.samples)},
                              {"reference", nullptr},
                              {"thres_lower", nullptr},
                              {"thres_upper", nullptr},
                              {"unit", record.unit},
                              {"result", "pass"}});
  return made;
}

}  // namespace

std::string to_csv(const std::vector<MeasuredCase>& records) {
  std::string text =
      "case,unit,median,low,high,samples,least,largest,error,check,backend,cells,variant,cpu,gpu,threads,"
      "flags,git,date,caches\n";
  for (const MeasuredCase& record : records) {
    Row row;
    row.add(record.name), row.add(record.unit);
    if (record.samples.empty() || !record.passed) {
      row.skip(3), row.add(static_cast<double>(record.samples.size())), row.skip(2);
    } else {
      const run::MedianInterval time = run::median_interval(record.samples);
      const auto [least, largest] = std::ranges::minmax(record.samples);
      row.add(time.median), row.add(time.low), row.add(time.high);
      row.add(static_cast<double>(record.samples.size())), row.add(least), row.add(largest);
    }
    if (record.error)
      row.add(*record.error);
    else
      row.skip(1);
    row.add(record.passed ? "passed" : "failed");
    for (const char* fact : {"backend", "cells", "variant"}) row.add(text_of(record.facts, fact));
    for (const char* key : {"cpu", "gpu", "threads", "flags", "git", "date"}) row.add(record.origin(key));
    row.add(record.cold_caches ? "cold" : "warm");
    text += row.text() + "\n";
  }
  return text;
}

std::string to_reframe(const std::vector<MeasuredCase>& records) {
  nlohmann::json cases = nlohmann::json::array();
  std::set<std::string> dates;
  for (const MeasuredCase& record : records) {
    cases.push_back(test_case(record));
    if (const std::string date = record.origin("date"); !date.empty()) dates.insert(date);
  }
  const auto failures = std::ranges::count(records, false, &MeasuredCase::passed);
  const nlohmann::json report = {
      {"session_info",
       {{"data_version", "2.1"},
        {"cmdline", "drogue-perf run"},
        {"num_cases", records.size()},
        {"num_failures", failures},
        {"time_start", dates.empty() ? "" : *dates.begin()},
        {"time_end", dates.empty() ? "" : *dates.rbegin()}}},
      {"runs",
       {{{"run_index", 0}, {"num_cases", records.size()}, {"num_failures", failures}, {"testcases", cases}}}},
      {"restored_cases", nlohmann::json::array()}};
  return report.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace drogue::perf
