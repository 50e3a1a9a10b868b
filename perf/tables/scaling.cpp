#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/program/failure.hpp"
#include "common/program/signals.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/run/files/temporary_folder.hpp"
#include "common/run/statistics.hpp"
#include "perf/compare/record_file.hpp"
#include "perf/measure/record.hpp"
#include "perf/memory/memory.hpp"
#include "perf/models/messages.hpp"
#include "perf/models/scaling.hpp"
#include "perf/problems/streams.hpp"
#include "perf/process/child_process.hpp"
#include "perf/rows/printed.hpp"
#include "perf/rows/rows.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {

namespace {

std::string described(int units, ScalingUnit unit) {
  return "a run on " + std::to_string(units) + " " + name(unit);
}

/// Runs a program of this suite, `what` in words. Returns the exit status of one that may have a result.
/// Throws Failure as the program does, and interrupted after a signal.
int run_program(const std::string& what, const std::vector<std::string>& words,
                const std::filesystem::path& folder, const std::filesystem::path& log,
                bool log_output = false) {
  const int status = run_child(words, folder, log, log_output);
  if (interrupted()) throw Failure(ExitCode::interrupted, "interrupted by a signal");
  if (status != 0 && status != static_cast<int>(ExitCode::verification_failed))
    throw failed_run(what, status, log);
  return status;
}

/// Pattern of the plain cases of a mini-app on a backend, one per size.
std::string cases_of(const std::string& app, device::Backend backend) {
  const std::string name(device::name(backend));
  if (app == "options") return "^options/" + name + "/[0-9]+/[0-9]+x[0-9]+$";
  return "^" + app + "-step/" + name + (app == "flow" ? "/[0-9x]+/periodic$" : "/[0-9]+$");
}

/// 1, 2, 4, ... and the number of processors for a backend with threads, else 1.
std::vector<int> thread_counts(device::Backend backend) {
  return unit_counts(
      backend == device::Backend::openmp ? static_cast<int>(std::thread::hardware_concurrency()) : 1);
}

/// Records of `drogue-perf run` with a number of threads, in a process of its own: the number is fixed when
/// OpenMP starts. Throws Failure as that process does.
std::vector<MeasuredCase> run_with_threads(const std::string& pattern, int threads, bool quick) {
  const run::TemporaryFolder folder("drogue-scaling");
  const std::string file = (folder.path() / "records.jsonl").string(), log = (folder.path() / "log").string();
  std::vector<std::string> words = {"env",
                                    "OMP_NUM_THREADS=" + std::to_string(threads),
                                    std::filesystem::read_symlink("/proc/self/exe").string(),
                                    "run",
                                    "--filter",
                                    pattern,
                                    "--out",
                                    file};
  if (quick) words.emplace_back("--quick");
  run_program(described(threads, ScalingUnit::threads), words, folder.path(), log);
  return read_records(file);
}

}  // namespace

Table print_scaling(const std::string& app, const std::vector<device::Backend>& backends, bool quick) {
  std::printf("%-34s %8s %14s  %-28s %9s %11s\n", "case", "threads", "us", "95 %", "speed-up", "efficiency");
  Table table;
  for (const device::Backend backend : backends) {
    std::map<std::string, double> of_one;  // median time with one thread by case, s
    for (const int threads : thread_counts(backend))
      for (const MeasuredCase& record : run_with_threads(cases_of(app, backend), threads, quick)) {
        nlohmann::json line = record.document;
        line["case"] = "scaling/" + record.name + "/" + std::to_string(threads);
        line["facts"]["threads"] = threads;
        table.records.push_back(line);
        table.passed = table.passed && record.passed;
        std::printf("%-34s %8d ", record.name.c_str(), threads);
        // A wrong result has no time.
        if (!record.passed) {
          std::printf("%14s\n", failed_text);
          continue;
        }
        const run::MedianInterval time = run::median_interval(record.samples);
        if (threads == 1) of_one[record.name] = time.median;
        const auto one = of_one.find(record.name);
        std::printf("%14.2f  %-28s %s", 1e6 * time.median,
                    printed("[%.2f .. %.2f]", 1e6 * time.low, 1e6 * time.high).c_str(),
                    speed_up_columns(one == of_one.end() ? std::nullopt : std::optional(one->second),
                                     time.median, threads)
                        .c_str());
        std::fflush(stdout);
      }
  }
  return table;
}

namespace {

/// Point of a curve: the program on some units.
struct ScalingPoint {
  int units;
  std::array<int, 3> cells;
  std::filesystem::path scene;
  std::vector<double> samples;   ///< s per step
  double error = 0.0;            ///< largest check over its tolerance
  nlohmann::json result;         ///< of the last run
  nlohmann::json messages = {};  ///< facts on the messages of a step; null for one rank, and for threads
};

int most_units(const ScalingRequest& request, device::Backend backend) {
  if (request.unit == ScalingUnit::threads && backend != device::Backend::openmp) return 1;
  if (request.most > 0) return request.most;
  if (request.unit == ScalingUnit::ranks && device::needs_device(backend)) return device_count();
  return static_cast<int>(std::thread::hardware_concurrency());
}

/// Words that start a program of this suite on the units of a point. A rank has one thread.
std::vector<std::string> command_of(ScalingUnit unit, int units, const std::string& program,
                                    const std::vector<std::string>& arguments) {
  const bool ranks = unit == ScalingUnit::ranks;
  return program_words(ranks ? launcher_words(units, 1) : std::vector<std::string>(), ranks ? 1 : units,
                       program, arguments);
}

/// Runs the program once and adds a sample. Throws Failure as the program does.
void run_point(const ScalingRequest& request, device::Backend backend, const std::filesystem::path& folder,
               ScalingPoint& point) {
  const std::filesystem::path out = folder / "out", log = folder / "log";
  const std::string what = described(point.units, request.unit);
  const int status = run_program(what,
                                 command_of(request.unit, point.units, "drogue-parachute",
                                            {point.scene.string(), "--quiet", "--overwrite", "--backend",
                                             std::string(device::name(backend)), "--out", out.string()}),
                                 folder, log, true);
  std::ifstream file(out / "result.json");
  point.result = nlohmann::json::parse(file, nullptr, false);
  if (point.result.is_discarded() || point.result.value("ranks", 0) < 1) throw failed_run(what, status, log);
  point.samples.push_back(point.result["timing"]["compute_s"].get<double>() /
                          point.result["steps"].get<double>());
  for (const nlohmann::json& check : point.result["checks"])
    point.error = std::max(point.error, check["value"].get<double>() / check["tolerance"].get<double>());
  std::filesystem::remove_all(out);
}

/// Measures the messages of a point alone, and models them. Throws Failure as `drogue-perf messages` does.
void measure_messages(device::Backend backend, const std::filesystem::path& folder, bool quick,
                      ScalingPoint& point) {
  const std::filesystem::path out = folder / "messages.jsonl", log = folder / "log";
  std::vector<std::string> arguments = {"messages", "--backend",  std::string(device::name(backend)),
                                        "--out",    out.string(), "--cells"};
  for (const int cells : point.cells) arguments.push_back(std::to_string(cells));
  if (quick) arguments.emplace_back("--quick");
  run_program(described(point.units, ScalingUnit::ranks),
              command_of(ScalingUnit::ranks, point.units, "drogue-perf", arguments), folder, log);
  const std::vector<MeasuredCase> records = read_records(out.string());
  const MeasuredCase &shortest = records.at(0), &exchange = records.at(1), &step = records.at(2);
  if (!step.passed) throw Failure(ExitCode::verification_failed, step.name + ": ranks received wrong values");
  const Link link = make_link(run::median(shortest.samples), run::median(exchange.samples),
                              exchange.facts["bytes"].get<double>());
  const double bytes = step.facts["bytes"].get<double>(), rounds = step.facts["rounds"].get<double>();
  point.messages = {{"transport", step.facts["transport"]},
                    {"bytes", bytes},
                    {"rounds", rounds},
                    {"latency_s", link.latency},
                    {"bandwidth", link.bandwidth},
                    {"messages_s", run::median(step.samples)},
                    {"model_s", message_time(link, rounds, bytes)}};
}

/// Times of the messages of a point; none for one rank, and for threads.
std::optional<MessageTimes> message_times(const ScalingPoint& point, bool weak,
                                          const std::optional<double>& of_one) {
  if (point.messages.is_null()) return {};
  const double model = point.messages["model_s"].get<double>();
  MessageTimes times{.measured = point.messages["messages_s"].get<double>(), .modelled = model, .step = {}};
  if (of_one) times.step = *of_one / (weak ? 1 : point.units) + model;
  return times;
}

Record record_of(const ScalingRequest& request, device::Backend backend, const ScalingPoint& point) {
  return {.name = "scaling/flow-step/" + std::string(device::name(backend)) + "/" +
                  streams::text(point.cells) + "/" + name(request.unit) + "/" + std::to_string(point.units) +
                  (request.weak ? "/weak" : "/strong"),
          .unit_of_work = "step",
          .bound = request.unit == ScalingUnit::ranks ? "messages of few cells per rank" : "memory bandwidth",
          .samples = point.samples,
          .error = point.error,
          .tolerance = 1.0};
}

/// Measures one backend, all numbers of units in turn.
void add_backend(const ScalingRequest& request, device::Backend backend, bool quick, Table& table) {
  const run::TemporaryFolder folder("drogue-scaling");
  const bool gpu = device::needs_device(backend);
  // Steps of a GPU are short beside the capture of a graph, and each run takes seconds to start.
  const int edge = quick ? 24 : gpu ? 256 : 64, steps = gpu ? 400 : 20, rounds = quick || gpu ? 3 : 7;
  std::vector<ScalingPoint> points;
  for (const int units : unit_counts(most_units(request, backend))) {
    const std::array<int, 3> cells = scaled_cells({edge, edge, edge}, request.weak, units);
    const std::filesystem::path scene = folder.path() / ("scene-" + std::to_string(units) + ".toml");
    run::write_file_atomically(scene.string(), flow_scene(cells, steps));
    points.push_back({.units = units, .cells = cells, .scene = scene, .samples = {}, .result = {}});
  }
  for (int round = 0; round < rounds; ++round)
    for (ScalingPoint& point : points) run_point(request, backend, folder.path(), point);
  for (ScalingPoint& point : points)
    if (request.unit == ScalingUnit::ranks && point.units > 1)
      measure_messages(backend, folder.path(), quick, point);
  std::optional<double> of_one;  // median time on one unit, s
  for (const ScalingPoint& point : points) {
    const Record record = record_of(request, backend, point);
    if (point.units == 1 && record.passed()) of_one = run::median(record.samples);
    nlohmann::json facts = {
        {"backend", device::name(backend)},
        {"cells", static_cast<std::int64_t>(point.cells[0]) * point.cells[1] * point.cells[2]},
        {"ranks", point.result["ranks"]},
        {"threads", point.result["threads"]},
        {"scaling", request.weak ? "weak" : "strong"}};
    if (!point.messages.is_null()) facts.update(point.messages);
    table.add(record, provenance_of(point.result), facts);
    std::printf(
        "%-52s%s", record.name.c_str(),
        scaling_columns(record, request.weak, point.units, of_one, message_times(point, request.weak, of_one))
            .c_str());
    std::fflush(stdout);
  }
}

}  // namespace

const char* name(ScalingUnit unit) { return unit == ScalingUnit::ranks ? "ranks" : "threads"; }

Table print_program_scaling(const ScalingRequest& request, const std::vector<device::Backend>& backends,
                            bool quick) {
  if (request.unit == ScalingUnit::ranks)
    for (const device::Backend backend : backends) require_launcher(most_units(request, backend));
  std::printf("Steps of drogue-parachute, %s scaling over %s\n%-52s%14s  %-28s %11s",
              request.weak ? "weak" : "strong", name(request.unit), "case", "us per step", "95 %",
              "efficiency");
  if (request.unit == ScalingUnit::ranks)
    std::printf(" %12s %9s %12s %12s", "messages us", "share", "by model us", "step us");
  std::printf("\n");
  Table table;
  for (const device::Backend backend : backends) add_backend(request, backend, quick, table);
  return table;
}

}  // namespace drogue::perf
