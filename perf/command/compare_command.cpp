#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <regex>

#include "perf/command/command.hpp"
#include "perf/compare/annotation.hpp"
#include "perf/compare/baseline.hpp"
#include "perf/compare/comparison.hpp"
#include "perf/rows/printed.hpp"

namespace drogue::perf {
namespace {

struct CompareOptions {
  std::string before, after, filter;
  std::vector<std::string> fail_on;
  bool allow_missing = false, github = false;

  [[nodiscard]] bool named(const char* name) const {
    return std::ranges::find(fail_on, name) != fail_on.end();
  }
  /// True if a gate does not pass this case. One that vanished or that cannot be compared, or whose samples
  /// could not have shown a change, has not been looked at.
  [[nodiscard]] bool fails(const ComparedCase& row) const {
    if (is_lost(row)) return !fail_on.empty() && !allow_missing;
    if (row.speed && !has_interval(*row.speed)) return named("slower");
    return (row.verdict == Verdict::slower && named("slower")) ||
           (row.verdict == Verdict::error_changed && named("error"));
  }
};

/// Measured change in words, or the reason of a verdict without one.
std::string details(const ComparedCase& row) {
  if (!row.speed) return row.reason;
  const SpeedChange& speed = *row.speed;
  const std::string interval = has_interval(speed) ? printed("[%.3f .. %.3f]", speed.low, speed.high)
                                                   : "(too few samples for an interval)";
  return printed("%.3f times as long  %s  %.4g -> %.4g %s", speed.ratio, interval.c_str(), row.old_time,
                 row.new_time, row.unit.c_str());
}

void print(const std::vector<ComparedCase>& rows) {
  std::size_t width = 0;
  for (const ComparedCase& row : rows) width = std::max(width, row.name.size());
  for (const ComparedCase& row : rows)
    std::printf("%-*s  %-14s  %s\n", static_cast<int>(width), row.name.c_str(), word(row.verdict),
                details(row).c_str());
}

/// Sentences on the cases that a gate does not pass.
Failure failure(const std::vector<ComparedCase>& failed) {
  std::string sentence;
  for (const ComparedCase& row : failed) {
    sentence += (sentence.empty() ? "" : "; ") + row.name + ": " + describe(row);
    if (row.verdict == Verdict::slower)
      sentence += ", where " + percent(row.speed->least) + " count as a change";
    if (is_lost(row)) sentence += "; --allow-missing lets it pass";
  }
  return {ExitCode::verification_failed, sentence};
}

bool is_not_comparable(const ComparedCase& row) { return row.verdict == Verdict::not_comparable; }

Failure nothing_compared(const ComparedCase& first) {
  return {ExitCode::usage, "no case could be compared, so that --fail-on has nothing to pass; the first, " +
                               first.name + ": " + first.reason};
}

void keep_matching(std::vector<MeasuredCase>& records, const std::regex& filter,
                   const CompareOptions& options) {
  std::erase_if(records, [&](const MeasuredCase& record) { return !std::regex_search(record.name, filter); });
  if (records.empty())
    throw Failure(ExitCode::usage, "no case of the records matches '" + options.filter + "'");
}

ExitCode compare_files(const CompareOptions& options, const std::regex& filter) {
  if (options.allow_missing && options.named("missing"))
    throw Failure(ExitCode::usage, "--allow-missing contradicts --fail-on missing");
  std::vector<MeasuredCase> after = read_records(options.after);
  const Baseline baseline = find_baseline(options.before, after.front());
  std::vector<MeasuredCase> before = read_records(baseline.file);
  keep_matching(after, filter, options);
  keep_matching(before, filter, options);
  for (const std::string& sentence : baseline.broken) std::printf("left out: %s\n", sentence.c_str());
  std::printf("old: %s\nnew: %s%s\n", describe_origin(before).c_str(), describe_origin(after).c_str(),
              describe_age(before, after.back()).c_str());
  if (is_of_one_commit(before, after))
    std::printf("both are of one commit: what differs is the machine, its load or the flags\n");
  const std::vector<ComparedCase> rows = compare_records(before, after);
  print(rows);
  std::printf("%s\n", summary(rows).c_str());
  std::vector<ComparedCase> failed;
  std::ranges::copy_if(rows, std::back_inserter(failed),
                       [&](const ComparedCase& row) { return options.fails(row); });
  if (options.github)
    for (const ComparedCase& row : rows) std::fputs(annotation(row, options.fails(row)).c_str(), stdout);
  if (std::ranges::all_of(rows, &is_not_comparable)) {
    // A gate that compared nothing has shown nothing.
    if (!options.fail_on.empty()) throw nothing_compared(rows.front());
    std::printf("no case could be compared\n");
  }
  if (!failed.empty()) throw failure(failed);
  if (!baseline.broken.empty()) throw Failure(ExitCode::invalid_scene, baseline.broken.front());
  return ExitCode::ok;
}

}  // namespace

Command compare_command(CLI::App& program) {
  const auto options = std::make_shared<CompareOptions>();
  CLI::App* app = program.add_subcommand("compare", "Print a verdict per case of two files of records");
  app->add_option("OLD", options->before,
                  "Records before a change, or a folder of baselines, one file a machine")
      ->required();
  app->add_option("NEW", options->after, "Records after the change")->required();
  app->add_option("--filter", options->filter, "Regular expression for the names of the cases");
  app->add_option("--fail-on", options->fail_on,
                  "Verdicts that give exit code 5: slower, error, or missing, several by commas; any of them "
                  "fails where a case of OLD is missing in NEW or cannot be compared")
      ->delimiter(',')
      ->check(CLI::IsMember({"slower", "error", "missing"}));
  app->add_flag("--allow-missing", options->allow_missing,
                "With --fail-on, cases of OLD may be missing in NEW or not comparable");
  app->add_flag("--github", options->github, "Print annotations for GitHub workflows too");
  return {app, [options](const std::vector<std::string>&) {
            return compare_files(*options, filter_of(options->filter));
          }};
}

}  // namespace drogue::perf
