#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/program/failure.hpp"
#include "common/program/signals.hpp"
#include "common/run/files/temporary_folder.hpp"
#include "common/run/statistics.hpp"
#include "perf/compare/record_file.hpp"
#include "perf/models/scaling.hpp"
#include "perf/process/child_process.hpp"
#include "perf/process/failed_run.hpp"
#include "perf/rows/timed_columns.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {

namespace {

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
  const int status = run_child(words, folder.path(), log);
  if (interrupted()) throw Failure(ExitCode::interrupted, "interrupted by a signal");
  if (status != 0 && status != static_cast<int>(ExitCode::verification_failed))
    throw failed_run(std::to_string(threads) + " threads", status, log);
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
        char interval[64];
        std::snprintf(interval, sizeof interval, "[%.2f .. %.2f]", 1e6 * time.low, 1e6 * time.high);
        std::printf("%14.2f  %-28s %s", 1e6 * time.median, interval,
                    speed_up_columns(one == of_one.end() ? std::nullopt : std::optional(one->second),
                                     time.median, threads)
                        .c_str());
        std::fflush(stdout);
      }
  }
  return table;
}

}  // namespace drogue::perf
