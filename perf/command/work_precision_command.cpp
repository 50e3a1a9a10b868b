#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "common/program/command_line.hpp"
#include "common/program/program.hpp"
#include "common/program/signals.hpp"
#include "common/program/stopwatch.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/run/files/output_path.hpp"
#include "common/run/result_document.hpp"
#include "common/run/statistics.hpp"
#include "perf/ceilings/ceilings.hpp"
#include "perf/command/command.hpp"
#include "perf/measure/measurement.hpp"
#include "perf/measure/record.hpp"
#include "perf/work_precision/solution.hpp"

namespace drogue::perf {
namespace {

struct WorkPrecisionOptions {
  std::string filter, out;
  std::string app = "gas", backend = "auto";
  bool quick = false;
};

/// Benchmark of a mini-app: its function, and the unit and bound in its records.
struct WorkPrecision {
  const char* app;
  bool (*solve)(const Selection&, const SolutionSink&);
  const char *unit = "solution", *bound = "time to the end of the run";
};
constexpr WorkPrecision apps[] = {
    {"gas", gas_work_precision},
    {"springs", springs_work_precision},
    {"flow", flow_work_precision},
    {"parachute", parachute_work_precision},
    {"options", options_work_precision, "option", "time of a batch, by option"}};

const WorkPrecision& work_precision_of(const std::string& name) {
  require_app(name);
  return *std::ranges::find(apps, name, &WorkPrecision::app);
}

nlohmann::json to_json(const WorkPrecision& app, const Solution& solution, const nlohmann::json& provenance) {
  const std::string backend(device::name(solution.backend));
  Record record{.name = std::string(app.app) + "-solution/" + solution.problem + "/" + backend + "/" +
                        solution.label + "/" + std::to_string(solution.cells),
                .unit_of_work = app.unit,
                .bound = app.bound,
                .samples = solution.samples,
                .error = solution.error};
  if (device::needs_device(solution.backend))
    if (auto reading = device_clocks().read()) record.clocks.push_back(std::move(*reading));
  // A scheme that fails on a problem gives a failed record.
  record.tolerance = solution.sound ? solution.error : -1.0;
  nlohmann::json facts = solution.scheme;
  facts.update({{"problem", solution.problem},
                {"backend", backend},
                {"cells", solution.cells},
                {"steps", solution.steps},
                {"status", run::status_name(solution.code)},
                {"message", solution.message}});
  return to_json(record, provenance, facts);
}

void print(const Solution& solution) {
  std::printf("%-14s %-7s %-32s %6lld  ", solution.problem.c_str(),
              std::string(device::name(solution.backend)).c_str(), solution.label.c_str(),
              static_cast<long long>(solution.cells));
  if (solution.code == ExitCode::ok)
    std::printf("%10.4g s  error %.4g\n", run::median(solution.samples), solution.error);
  else
    std::printf("%s\n", solution.message.c_str());
  std::fflush(stdout);
}

/// Raises the clock of a GPU, which idles at a fraction of it, by `warm_up_seconds` of arithmetic. Blocks.
void warm_up_gpu() {
  const std::unique_ptr<CeilingKernel> kernel = create_ceiling(device::Backend::cuda, Ceiling::fp64);
  const Stopwatch stopwatch;
  while (stopwatch.seconds() < warm_up_seconds) {
    kernel->reset();
    kernel->run();
  }
}

ExitCode measure_solutions(const WorkPrecisionOptions& options, const std::vector<std::string>& kokkos) {
  const WorkPrecision& app = work_precision_of(options.app);
  const std::regex filter = filter_of(options.filter);
  std::string known;
  const auto wants = [&](const std::string& problem) {
    known += (known.empty() ? "" : ", ") + problem;
    return std::regex_search(problem, filter);
  };
  run::require_writable(options.out);
  const Selection selection{backends_of(options.backend), options.quick, wants};
  const device::Runtime runtime(kokkos);
  install_signal_handlers();
  const nlohmann::json here = provenance(device::device_facts());
  if (std::ranges::find(selection.backends, device::Backend::cuda) != selection.backends.end()) warm_up_gpu();
  std::vector<nlohmann::json> lines;
  const bool finished = app.solve(selection, [&](const Solution& solution) {
    print(solution);
    lines.push_back(to_json(app, solution, here));
    // Writes early, to detect an unwritable file at once, and often, so that an aborted run keeps most
    // records.
    if (lines.size() % 32 == 1 && run::is_replaced(options.out)) write_records(options.out, lines);
  });
  if (finished && lines.empty())
    throw Failure(ExitCode::usage, "no problem matches '" + options.filter + "'; " +
                                       (options.quick ? "with --quick there are " : "there are ") + known);
  // An interrupted run keeps its finished records.
  write_records(options.out, lines);
  if (!finished)
    print_notice("drogue-perf",
                 "interrupted by a signal; " + std::to_string(lines.size()) + " runs are finished");
  return finished ? ExitCode::ok : ExitCode::interrupted;
}

}  // namespace

Command work_precision_command(CLI::App& program) {
  const auto options = std::make_shared<WorkPrecisionOptions>();
  CLI::App* app = program.add_subcommand(
      "work-precision",
      "Time to solution and error over meshes, schemes and backends; of gas beside a second-order scheme, of "
      "options for known prices, of flow for vortices of Taylor and Green and a lid-driven cavity, of "
      "parachute "
      "for a canopy that opens");
  app->add_option("--app", options->app, app_help("Kernels whose problems are run"))->capture_default_str();
  app->add_option("--backend", options->backend, "auto takes all that are present")
      ->check(CLI::IsMember(backend_choices()))
      ->capture_default_str();
  app->add_option("--filter", options->filter, "Regular expression for the names of the problems");
  app->add_option("--out", options->out, "File for the records, one JSON line a run to solution");
  app->add_flag("--quick", options->quick, "Two small meshes of two problems");
  return {app,
          [options](const std::vector<std::string>& kokkos) { return measure_solutions(*options, kokkos); }};
}

}  // namespace drogue::perf
