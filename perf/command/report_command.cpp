#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "common/program/plot_program.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/run/files/temporary_folder.hpp"
#include "perf/command/command.hpp"
#include "perf/compare/annotation.hpp"
#include "perf/compare/baseline.hpp"
#include "perf/report/exports.hpp"

namespace drogue::perf {
namespace {

namespace fs = std::filesystem;
constexpr auto replace_invalid = nlohmann::json::error_handler_t::replace;

/// Records of all files *.jsonl of a folder, in the order of the names of the files.
std::vector<MeasuredCase> read_folder(const fs::path& folder) {
  if (!fs::is_directory(folder))
    throw Failure(ExitCode::usage, "there is no folder '" + folder.string() + "'");
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".jsonl") files.push_back(entry.path());
  if (files.empty()) throw Failure(ExitCode::usage, "'" + folder.string() + "' holds no records (*.jsonl)");
  std::ranges::sort(files);
  std::vector<MeasuredCase> all;
  for (const fs::path& file : files) std::ranges::move(read_records(file.string()), std::back_inserter(all));
  return all;
}

void write(const fs::path& file, const std::string& text) {
  run::write_file_atomically(file, text);
  std::printf("%s\n", file.c_str());
}

/// Time of the last change of a file; of none, the least one.
fs::file_time_type changed(const fs::path& file) {
  std::error_code none;
  return fs::last_write_time(file, none);
}

/// Verdicts on the records of a folder against a baseline, a file or a folder of files.
nlohmann::json verdicts_against(const std::string& baseline, const std::vector<MeasuredCase>& after) {
  const std::vector<MeasuredCase> before = read_records(find_baseline(baseline, after.front()).file);
  return verdicts_json(describe_origin(before), describe_origin(after) + describe_age(before, after.back()),
                       compare_records(before, after));
}

ExitCode write_report(const std::string& folder, const std::string& out, const std::string& baseline) {
  const std::vector<MeasuredCase> records = read_folder(folder);
  const std::string verdicts =
      baseline.empty() ? "" : verdicts_against(baseline, records).dump(1, ' ', false, replace_invalid) + "\n";
  std::error_code error;
  if (fs::create_directories(out, error); error)
    throw Failure(ExitCode::io_error, "the folder '" + out + "' cannot be made: " + error.message());
  const fs::path page = fs::path(out) / "report.html";
  const fs::file_time_type former = changed(page);
  std::vector<std::string> words = {folder, "--report", "--out", out};
  const run::TemporaryFolder temporary("drogue-report");
  if (!verdicts.empty()) {
    const fs::path file = temporary.path() / "verdicts.json";
    run::write_file_atomically(file, verdicts);
    words.insert(words.end(), {"--verdicts", file.string()});
  }
  const auto code = static_cast<ExitCode>(run_drogue_plot(words));
  // It also checks the facts of each kind of record, and states the reasons of these codes itself.
  if (code == ExitCode::invalid_scene || code == ExitCode::interrupted) return code;
  write(fs::path(out) / "records.csv", to_csv(records));
  write(fs::path(out) / "reframe.json", to_reframe(records));
  const fs::path verdicts_file = fs::path(out) / "verdicts.json";
  if (!verdicts.empty())
    write(verdicts_file, verdicts);
  else if (fs::remove(verdicts_file, error); error)  // of a former report, on other records
    throw Failure(ExitCode::io_error,
                  "'" + verdicts_file.string() + "' cannot be removed: " + error.message());
  if (code == ExitCode::ok && changed(page) != former) return code;
  if (code == ExitCode::usage || code == ExitCode::io_error) return ExitCode::io_error;
  throw Failure(ExitCode::io_error,
                "report.html was not made: drogue-plot is not beside this program, or failed");
}

}  // namespace

Command report_command(CLI::App& program) {
  const auto folder = std::make_shared<std::string>(), out = std::make_shared<std::string>(),
             baseline = std::make_shared<std::string>();
  CLI::App* app = program.add_subcommand(
      "report",
      "Write all records of a folder as a page (by drogue-plot), a CSV file and a report of ReFrame");
  app->add_option("DIR", *folder, "Folder of records, *.jsonl")->required();
  app->add_option("--out", *out, "Folder for report.html, records.csv and reframe.json (default: DIR)");
  app->add_option(
      "--baseline", *baseline,
      "Records before a change, or a folder of baselines: the page and verdicts.json have the verdicts of "
      "compare too");
  return {app, [folder, out, baseline](const std::vector<std::string>&) {
            return write_report(*folder, out->empty() ? *folder : *out, *baseline);
          }};
}

}  // namespace drogue::perf
