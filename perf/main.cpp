#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <regex>

#include "common/program/command_line.hpp"
#include "common/program/program.hpp"
#include "common/program/provenance.hpp"
#include "common/run/atomic_file.hpp"
#include "common/run/result_document.hpp"
#include "common/run/statistics.hpp"
#include "kernels/device/backend.hpp"
#include "kernels/device/runtime.hpp"
#include "perf/measurement.hpp"

namespace {

using namespace drogue;

nlohmann::json to_json(const perf::Record& record, const run::ResultDocument& facts,
                       const device::DeviceFacts& device) {
  const run::MedianInterval time = run::median_interval(record.samples);
  return {{"schema", "drogue.perf/1"},
          {"case", record.name},
          {"unit", "s per " + record.unit_of_work},
          {"bound", record.bound},
          {"samples", record.samples},
          {"median", time.median},
          {"interval", {time.low, time.high}},
          {"error", record.error},
          {"check", record.error <= record.bar ? "passed" : "failed"},
          {"provenance",
           {{"version", facts.version},
            {"git", facts.git},
            {"compiler", facts.provenance.compiler},
            {"flags", facts.provenance.flags},
            {"kokkos", device.kokkos_version},
            {"cpu", facts.provenance.cpu},
            {"gpu", device.gpu},
            {"driver", device.driver},
            {"threads", device.threads},
            {"date", facts.provenance.date}}}};
}

ExitCode run_cases(const std::vector<perf::Case>& all, const std::string& filter, bool quick,
                   const std::string& out, const device::DeviceFacts& device) {
  std::vector<perf::Case> cases;
  for (const perf::Case& c : all)
    if (std::regex_search(c.name, std::regex(filter))) cases.push_back(c);
  if (cases.empty()) throw Failure(ExitCode::usage, "no case matches '" + filter + "'; see drogue-perf list");
  const run::ResultDocument facts = run::new_result("drogue-perf", "");
  std::string lines;
  bool passed = true;
  for (const perf::Record& record : perf::measure(cases, 3, quick ? 7 : 25)) {
    const nlohmann::json json = to_json(record, facts, device);
    lines += json.dump() + "\n";
    passed = passed && record.error <= record.bar;
    const run::MedianInterval time = run::median_interval(record.samples);
    std::printf("%-32s %12.3f us a %s  [%.3f .. %.3f]  L1 error %.3g  %s\n", record.name.c_str(),
                1e6 * time.median, record.unit_of_work.c_str(), 1e6 * time.low, 1e6 * time.high, record.error,
                record.error <= record.bar ? "passed" : "FAILED");
  }
  if (!out.empty()) run::write_file_atomically(out, lines);
  return passed ? ExitCode::ok : ExitCode::verification_failed;
}

ExitCode run_program_body(int argc, char** argv) {
  std::string filter, out;
  bool quick = false, version = false;
  CLI::App app("Measures the kernels: median of the samples with its 95 % interval, beside the error.",
               "drogue-perf");
  app.add_flag("--version", version, "Print the version and what it was built with");
  CLI::App* list = app.add_subcommand("list", "Print the cases that this build and machine can run");
  CLI::App* run = app.add_subcommand("run", "Measure, in interleaved rounds after a warm-up");
  run->add_option("--filter", filter, "Regular expression for the names of the cases");
  run->add_option("--out", out, "File for the records, one JSON line a case");
  run->add_flag("--quick", quick, "Small cases and few samples");
  const Arguments arguments = split_arguments(argc, argv);
  if (const std::string help = parse_command_line(app, arguments.program); !help.empty()) {
    std::fputs(help.c_str(), stdout);
    return ExitCode::ok;
  }
  if (version) {
    std::fputs(version_text("drogue-perf").c_str(), stdout);
    return ExitCode::ok;
  }
  if (list->parsed()) {
    for (const perf::Case& c : perf::gas_cases(false)) std::printf("%s\n", c.name.c_str());
    return ExitCode::ok;
  }
  if (!run->parsed()) throw Failure(ExitCode::usage, "say list or run; see drogue-perf --help");
  if (const auto reason = device::why_unavailable(device::fastest_backend()))
    throw Failure(ExitCode::no_backend, *reason);
  const device::Runtime runtime(arguments.kokkos);
  return run_cases(perf::gas_cases(quick), filter, quick, out, device::device_facts());
}

}  // namespace

int main(int argc, char** argv) {
  return drogue::run_program("drogue-perf", [&] { return run_program_body(argc, argv); });
}
