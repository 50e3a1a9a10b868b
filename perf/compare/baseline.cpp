#include "perf/compare/baseline.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>
#include <vector>

#include "common/program/failure.hpp"

namespace drogue::perf {

namespace {

namespace fs = std::filesystem;

/// Seconds since 1970 of a date such as 2026-11-22T14:07:15Z.
std::optional<std::time_t> seconds_of(const std::string& date) {
  std::tm parts{};
  const char* end = strptime(date.c_str(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  if (end == nullptr || *end != '\0') return std::nullopt;
  return timegm(&parts);
}

bool same_machine(const MeasuredCase& a, const MeasuredCase& b) {
  return std::ranges::all_of(std::vector<std::string>{"cpu", "gpu", "threads"},
                             [&](const std::string& key) { return a.origin(key) == b.origin(key); });
}

std::string machine_of(const MeasuredCase& record) {
  const std::string gpu = record.origin("gpu");
  return "'" + record.origin("cpu") + (gpu.empty() ? "" : ", " + gpu) + "' with " + record.origin("threads") +
         " threads";
}

}  // namespace

std::string find_baseline(const std::string& path, const MeasuredCase& after) {
  if (!fs::is_directory(path)) return path;
  std::vector<std::string> files, found;
  for (const fs::directory_entry& entry : fs::directory_iterator(path))
    if (entry.path().extension() == ".jsonl") files.push_back(entry.path().string());
  std::ranges::sort(files);
  std::ranges::copy_if(files, std::back_inserter(found), [&](const std::string& file) {
    return same_machine(read_records(file).front(), after);
  });
  if (found.size() == 1) return found.front();
  if (found.empty())
    throw Failure(ExitCode::usage, "'" + path + "' has no baseline of the machine " + machine_of(after) +
                                       "; copy records of drogue-perf run there as a file *.jsonl");
  throw Failure(ExitCode::usage, "'" + path + "' has several baselines of one machine, " + found[0] +
                                     " and " + found[1] + "; remove all but one");
}

std::string describe_origin(const MeasuredCase& record) {
  const auto known = [&](const char* key) {
    const std::string text = record.origin(key);
    return text.empty() ? std::string("unknown") : text;
  };
  return "commit " + known("git") + ", date " + known("date");
}

std::string describe_age(const MeasuredCase& before, const MeasuredCase& after) {
  const auto old_date = seconds_of(before.origin("date")), new_date = seconds_of(after.origin("date"));
  if (!old_date || !new_date) return "";
  const double hours = std::difftime(*new_date, *old_date) / 3600.0;
  if (std::abs(hours) < 1.0) return "";
  const bool in_days = std::abs(hours) >= 48.0;
  char text[64];
  std::snprintf(text, sizeof text, "; %.1f %s %s", std::abs(in_days ? hours / 24.0 : hours),
                in_days ? "days" : "hours", hours < 0.0 ? "before the old one" : "later");
  return text;
}

}  // namespace drogue::perf
