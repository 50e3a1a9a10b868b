#include "perf/compare/baseline.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "common/program/failure.hpp"
#include "perf/rows/printed.hpp"

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

/// Baselines of a machine in a folder.
struct Found {
  std::vector<std::string> files, broken;
};

Found baselines_of(const std::string& folder, const MeasuredCase& machine) {
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".jsonl") files.push_back(entry.path().string());
  std::ranges::sort(files);
  Found found;
  for (const std::string& file : files) try {
      if (same_machine(read_records(file).front(), machine)) found.files.push_back(file);
    } catch (const Failure& failure) {
      found.broken.emplace_back(failure.what());
    }
  return found;
}

Failure several(const std::string& folder, const std::vector<std::string>& files) {
  return {ExitCode::usage, "'" + folder + "' has several baselines of one machine, " + files[0] + " and " +
                               files[1] + "; remove all but one"};
}

std::string all_of(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += "; " + sentence;
  return text;
}

/// Lower-case letters, digits and single hyphens.
std::string file_name(const std::string& text) {
  std::string name;
  for (const unsigned char c : text) {
    if (std::isalnum(c) != 0)
      name += static_cast<char>(std::tolower(c));
    else if (!name.empty() && name.back() != '-')
      name += '-';
  }
  while (!name.empty() && name.back() == '-') name.pop_back();
  return name.empty() ? "machine" : name;
}

/// The oldest record of known date, else the first one.
const MeasuredCase& oldest_of(const std::vector<MeasuredCase>& records) {
  return *std::ranges::min_element(records, {}, [](const MeasuredCase& record) {
    return seconds_of(record.origin("date")).value_or(std::numeric_limits<std::time_t>::max());
  });
}

/// The latest record of known date, else the first one.
const MeasuredCase& latest_of(const std::vector<MeasuredCase>& records) {
  return *std::ranges::max_element(records, {}, [](const MeasuredCase& record) {
    return seconds_of(record.origin("date")).value_or(std::numeric_limits<std::time_t>::min());
  });
}

std::string origin_of(const MeasuredCase& record) {
  const auto known = [&](const char* key) {
    const std::string text = record.origin(key);
    return text.empty() ? std::string("unknown") : text;
  };
  return "commit " + known("git") + ", date " + known("date");
}

std::string counted(std::size_t records) {
  return std::to_string(records) + (records == 1 ? " record" : " records");
}

/// Present baseline of a machine, without the records of the measured cases and, unless `keep_others`,
/// without all others. Prints what goes and what stays.
BaselineFile renewed(const std::string& file, const MeasuredCase& here,
                     const std::vector<std::string>& measured, bool keep_others) {
  std::vector<MeasuredCase> replaced, kept;
  for (MeasuredCase& record : read_records(file)) {
    const bool is_measured = std::ranges::find(measured, record.name) != measured.end();
    (keep_others && !is_measured ? kept : replaced).push_back(std::move(record));
  }
  BaselineFile renewed{file, {}};
  for (const MeasuredCase& record : kept) renewed.kept.push_back(record.document);
  const auto words = [&](const std::vector<MeasuredCase>& records) {
    return describe_origin(records) + describe_age(records, here);
  };
  if (kept.empty()) {
    std::printf("%s replaces that of %s\n", file.c_str(), words(replaced).c_str());
    return renewed;
  }
  if (!replaced.empty())
    std::printf("%s: replaces %s of %s\n", file.c_str(), counted(replaced.size()).c_str(),
                words(replaced).c_str());
  std::printf("%s: keeps %s of other cases, of %s\n", file.c_str(), counted(kept.size()).c_str(),
              words(kept).c_str());
  return renewed;
}

}  // namespace

Baseline find_baseline(const std::string& path, const MeasuredCase& after) {
  if (!fs::is_directory(path)) return {path, {}};
  Found found = baselines_of(path, after);
  if (found.files.size() == 1) return {found.files.front(), found.broken};
  if (found.files.empty())
    throw Failure(ExitCode::usage, "'" + path + "' has no baseline of the machine " + machine_of(after) +
                                       "; make one by drogue-perf run --quick --baseline " + path +
                                       all_of(found.broken));
  throw several(path, found.files);
}

BaselineFile file_for_baseline(const std::string& folder, const nlohmann::json& provenance,
                               const std::vector<std::string>& measured, bool keep_others) {
  if (!fs::is_directory(folder)) throw Failure(ExitCode::usage, "there is no folder '" + folder + "'");
  MeasuredCase here;
  here.provenance = provenance;
  const Found found = baselines_of(folder, here);
  for (const std::string& sentence : found.broken) std::printf("left out: %s\n", sentence.c_str());
  if (found.files.size() > 1) throw several(folder, found.files);
  if (found.files.size() == 1) return renewed(found.files.front(), here, measured, keep_others);
  const std::string gpu = here.origin("gpu");
  const std::string name = file_name(gpu.empty() ? here.origin("cpu") : gpu) + "-" + here.origin("threads");
  fs::path file = fs::path(folder) / (name + ".jsonl");
  for (int number = 2; fs::exists(file); ++number)
    file = fs::path(folder) / (name + "-" + std::to_string(number) + ".jsonl");
  return {file.string(), {}};
}

std::string describe_origin(const std::vector<MeasuredCase>& records) {
  const std::string oldest = origin_of(oldest_of(records)), latest = origin_of(latest_of(records));
  return oldest == latest ? oldest : oldest + ", to " + latest;
}

bool is_of_one_commit(const std::vector<MeasuredCase>& before, const std::vector<MeasuredCase>& after) {
  const std::string commit = before.front().origin("git");
  const auto is_same = [&](const MeasuredCase& record) { return record.origin("git") == commit; };
  const bool is_known = !commit.empty() && commit != "unknown" && !commit.ends_with("-dirty");
  return is_known && std::ranges::all_of(before, is_same) && std::ranges::all_of(after, is_same);
}

std::string describe_age(const std::vector<MeasuredCase>& before, const MeasuredCase& after) {
  const auto old_date = seconds_of(oldest_of(before).origin("date")),
             new_date = seconds_of(after.origin("date"));
  if (!old_date || !new_date) return "";
  const double hours = std::difftime(*new_date, *old_date) / 3600.0;
  if (std::abs(hours) < 1.0) return "";
  const bool in_days = std::abs(hours) >= 48.0;
  // The system changes too.
  return printed("; %.1f %s %s%s", std::abs(in_days ? hours / 24.0 : hours), in_days ? "days" : "hours",
                 hours < 0.0 ? "before the old one" : "later",
                 hours > 24.0 * largest_age ? "; measure the old commit again before a verdict matters" : "");
}

}  // namespace drogue::perf
