#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <utility>

#include "common/program/signals.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/run/statistics.hpp"
#include "common/scene/nearest.hpp"
#include "kernels/device/gpu_hardware.hpp"
#include "perf/caches/host_caches.hpp"
#include "perf/cases/cases.hpp"
#include "perf/command/command.hpp"
#include "perf/compare/baseline.hpp"
#include "perf/measure/record.hpp"
#include "perf/measure/rounds.hpp"
#include "perf/memory/cache_sweep.hpp"
#include "perf/profile/kernel_profile.hpp"

namespace drogue::perf {
namespace {

struct RunOptions {
  std::string filter, out, baselines;
  bool quick = false, cold = false;
};

/// Facts of the record of a case; unknown ones are omitted.
nlohmann::json facts_of(const Record& record) {
  const Facts& facts = record.facts;
  nlohmann::json json = {{"backend", device::name(record.backend)}};
  if (facts.cells > 0) json.update({{"cells", facts.cells}, {"variant", facts.variant}});
  if (facts.flops > 0.0) json["flops"] = facts.flops;
  if (facts.bytes > 0.0) json["bytes"] = facts.bytes;
  if (facts.instructions > 0.0) json["instructions"] = facts.instructions;
  if (facts.launches > 0) json["launches"] = facts.launches;
  if (!facts.driver.empty()) json["driver"] = facts.driver;
  if (facts.device_seconds > 0.0) json["device_s"] = facts.device_seconds;
  if (facts.solution_error > 0.0) json["solution_error"] = facts.solution_error;
  return json;
}

std::vector<Case> matching_cases(const std::regex& filter, bool quick) {
  std::vector<Case> cases = all_cases(quick);
  std::erase_if(cases, [&](const Case& c) { return !std::regex_search(c.name, filter); });
  return cases;
}

/// The nearest kind of case if the kind that a filter begins with, a plain word up to a slash, is none.
std::optional<std::string> mistyped_kind(const std::string& filter) {
  const std::size_t begin = filter.starts_with('^') ? 1 : 0;
  const std::string kind = filter.substr(begin, filter.find_first_of("/$", begin) - begin);
  if (!std::ranges::all_of(kind, [](unsigned char c) { return std::isalpha(c) || c == '-'; })) return {};
  const std::vector<std::string> kinds = case_kinds();
  if (std::ranges::any_of(kinds, [&](const std::string& valid) { return valid.ends_with(kind); })) return {};
  return scene::nearest(kind, kinds);
}

Failure no_case(const RunOptions& options, const std::regex& filter) {
  const std::string list = options.quick ? "drogue-perf list --quick" : "drogue-perf list";
  const std::string what = "no case matches '" + options.filter + "'";
  if (const auto left_out = options.quick ? matching_cases(filter, false).size() : 0; left_out > 0)
    return {ExitCode::usage,
            what + " but " + std::to_string(left_out) + " that --quick leaves out; see " + list};
  if (const auto kind = mistyped_kind(options.filter))
    return {ExitCode::usage, what + "; did you mean the kind \"" + *kind + "\"?"};
  if (const auto reason = missing_backend(options.filter))
    return {ExitCode::no_backend, what + ": " + *reason};
  std::vector<std::string> names;
  for (const Case& c : all_cases(options.quick)) names.push_back(c.name);
  if (const auto nearest = scene::nearest(options.filter, names))
    return {ExitCode::usage, what + "; did you mean \"" + *nearest + "\"?"};
  return {ExitCode::usage, what + "; see " + list};
}

/// Sweeps of the caches that the cases use. Throws Failure(usage) if their size is unknown.
std::function<void(bool)> cache_sweeps(const std::vector<Case>& cases) {
  std::map<bool, std::function<std::int64_t()>> sweeps;  // by whether they are on a device
  for (const Case& c : cases) {
    if (sweeps.contains(c.on_device())) continue;
    const std::int64_t bytes =
        c.on_device() ? device::gpu_hardware().l2 : host_cache_bytes(2) + host_cache_bytes(3);
    if (bytes == 0)
      throw Failure(ExitCode::usage, std::string("the system does not state the caches of the ") +
                                         (c.on_device() ? "GPU" : "host") + ", which --cold has to empty");
    sweeps[c.on_device()] = create_cache_sweep(c.on_device(), 2 * bytes);
  }
  return [=](bool on_device) { sweeps.at(on_device)(); };
}

ExitCode run_cases(RunOptions options, const std::regex& filter) {
  const std::vector<Case> cases = matching_cases(filter, options.quick);
  if (cases.empty()) throw no_case(options, filter);
  const nlohmann::json here = provenance(device::device_facts());
  std::vector<nlohmann::json> lines;
  if (!options.baselines.empty()) {
    std::vector<std::string> names;
    for (const Case& c : cases) names.push_back(c.name);
    BaselineFile baseline = file_for_baseline(options.baselines, here, names, !options.filter.empty());
    options.out = baseline.file;
    lines = std::move(baseline.kept);
  }
  const double overhead = timer_overhead();
  if (options.cold)
    std::printf("timer: %.3f us per work; a sample is one work, with cold caches\n", 1e6 * overhead);
  else
    std::printf("timer: %.3f us per work; a sample repeats works of less than %.0f ms\n", 1e6 * overhead,
                1e3 * shortest_sample);
  std::fflush(stdout);
  bool passed = true;
  Instruments instruments{&device_clocks()};
  if (options.cold) instruments.empty_caches = cache_sweeps(cases);
  for (const Record& record : measure(cases, warm_up_rounds, run_rounds, instruments)) {
    lines.push_back(to_json(record, here, facts_of(record)));
    lines.back()["instrument"] = {{"overhead", overhead},
                                  {"works", record.repeats},
                                  {"units", record.units},
                                  {"clock", "host"},
                                  {"caches", options.cold ? "cold" : "warm"}};
    passed = passed && record.passed();
    const run::MedianInterval time = run::median_interval(record.samples);
    std::printf("%-32s %12.3f us per %s  [%.3f .. %.3f]  error %.3g  %s\n", record.name.c_str(),
                1e6 * time.median, record.unit_of_work.c_str(), 1e6 * time.low, 1e6 * time.high, record.error,
                verdict(record));
    if (!record.clocks.empty())
      for (const std::string& reason : summarize(record.clocks).throttled)
        std::printf("  throttled: %s\n", reason.c_str());
  }
  const ExitCode code = code_of(passed);
  if (options.baselines.empty() || code == ExitCode::ok) write_records(options.out, lines);
  if (!options.baselines.empty())
    std::printf(code == ExitCode::ok ? "baseline: %s\n" : "no baseline is written to %s\n",
                options.out.c_str());
  return code;
}

}  // namespace

Command list_command(CLI::App& program) {
  const auto quick = std::make_shared<bool>(false);
  CLI::App* app = program.add_subcommand("list", "Print the cases that this build and machine can run");
  app->add_flag("--quick", *quick, "Only the cases of run --quick");
  return {app, [quick](const std::vector<std::string>&) {
            for (const Case& c : all_cases(*quick)) std::printf("%s\n", c.name.c_str());
            return ExitCode::ok;
          }};
}

Command run_command(CLI::App& program) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* app = program.add_subcommand("run", "Measure, in interleaved rounds after a warm-up");
  app->add_option("--filter", options->filter, "Regular expression for the names of the cases");
  app->add_option("--out", options->out, "File for the records, one JSON line a case");
  app->add_flag("--quick", options->quick, "Small cases");
  app->add_flag("--cold", options->cold, "Empty the caches before each work");
  app->add_option(
         "--baseline", options->baselines,
         "Folder of baselines, in which the records replace those of this machine if all passed; with "
         "--filter, those of the measured cases alone")
      ->excludes("--out")
      ->excludes("--cold");
  return {app, [options](const std::vector<std::string>& kokkos) {
            const std::regex filter = filter_of(options->filter);
            run::require_writable(options->out);
            require(device::fastest_backend());
            const device::Runtime runtime(kokkos);
            install_signal_handlers();
            return run_cases(*options, filter);
          }};
}

}  // namespace drogue::perf
