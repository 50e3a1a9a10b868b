#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>

#include "common/program/command_line.hpp"
#include "common/program/signals.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/run/files/temporary_folder.hpp"
#include "perf/benchmark/benchmark.hpp"
#include "perf/command/command.hpp"
#include "perf/process/child_process.hpp"

namespace drogue::perf {
namespace {

struct BenchmarkOptions {
  std::string size = "small", backend = "auto", filter, launcher, keep, out;
  int ranks = 1, threads = 0;
  bool weak = false;
};

/// Words of the launcher of the user.
std::vector<std::string> launcher_of(const BenchmarkOptions& options) {
  if (options.ranks == 1 && !options.launcher.empty())
    throw Failure(ExitCode::usage, "--launcher starts several ranks: give their number by --ranks");
  if (options.weak && !options.launcher.empty() && options.launcher.find("{ranks}") == std::string::npos)
    throw Failure(ExitCode::usage,
                  "--weak runs on 1, 2, 4, ... ranks: write {ranks} for their number in --launcher");
  if (options.launcher.empty() && options.ranks > 1) require_launcher(options.ranks);
  std::istringstream text(options.launcher);
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  return words;
}

/// Throws Failure if the folder cannot be made, or holds files, which the runs might replace.
void make_new_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw Failure(ExitCode::io_error,
                  "the folder '" + folder.string() + "' cannot be made: " + error.message());
  if (!std::filesystem::is_empty(folder))
    throw Failure(ExitCode::usage,
                  "the folder '" + folder.string() + "' of --keep holds files; name a new one");
}

/// Rows of a request that the filter takes. Throws Failure(usage) if there are none, or none of the ranks.
std::vector<benchmark::Row> rows_of(const BenchmarkOptions& options, const benchmark::Request& request) {
  const std::regex filter = filter_of(options.filter);
  std::vector<benchmark::Row> rows = benchmark::rows(request);
  std::string known;
  for (const benchmark::Row& row : rows)
    if (known.find(row.problem.name) == std::string::npos)
      known += (known.empty() ? "" : ", ") + row.problem.name;
  std::erase_if(rows,
                [&](const benchmark::Row& row) { return !std::regex_search(row.problem.name, filter); });
  if (rows.empty())
    throw Failure(ExitCode::usage, "no problem matches '" + options.filter + "'; there are " + known);
  if (options.ranks > 1 &&
      std::ranges::none_of(rows, &benchmark::Problem::parallel, &benchmark::Row::problem))
    throw Failure(ExitCode::usage,
                  "--ranks are those of taylor-green, and --filter '" + options.filter + "' leaves it out");
  return rows;
}

ExitCode run_benchmark(const BenchmarkOptions& options) {
  const auto size = std::ranges::find(benchmark::size_names, options.size) - benchmark::size_names.begin();
  const device::Backend backend = device::wanted_backend(options.backend);
  require(backend);
  if (options.threads > 0 && backend == device::Backend::serial)
    throw Failure(ExitCode::usage, "the backend serial has one thread; give --backend openmp");
  benchmark::Request request{.size = static_cast<benchmark::Size>(size),
                             .backend = backend,
                             .weak = options.weak,
                             .ranks = options.ranks,
                             .threads = options.threads,
                             .launcher = {},
                             .folder = options.keep};
  const std::vector<benchmark::Row> rows = rows_of(options, request);
  request.launcher = launcher_of(options);
  if (std::filesystem::is_regular_file(options.out))
    throw Failure(ExitCode::usage, "the file '" + options.out + "' of --out exists; name a new one");
  run::require_writable(options.out);
  std::optional<run::TemporaryFolder> temporary;
  if (options.keep.empty())
    request.folder = temporary.emplace("drogue-benchmark").path();
  else
    make_new_folder(options.keep);
  install_signal_handlers();
  Table table;
  try {
    benchmark::run(request, rows, table);
  } catch (...) {
    if (!table.records.empty()) write_records(options.out, table.records);
    throw;
  }
  write_records(options.out, table.records);
  return code_of(table.passed);
}

}  // namespace

Command benchmark_command(CLI::App& program) {
  const auto options = std::make_shared<BenchmarkOptions>();
  CLI::App* app = program.add_subcommand(
      "benchmark",
      "Run one problem of each program, check the answers, and print a table to submit (docs/benchmark.md)");
  app->add_option("--size", options->size, "small: one core; medium: a node; large: one GPU")
      ->check(CLI::IsMember(benchmark::size_names))
      ->capture_default_str();
  app->add_option("--backend", options->backend, "Where to run: auto takes the fastest present")
      ->check(CLI::IsMember(backend_choices()))
      ->capture_default_str();
  app->add_option("--filter", options->filter, "Regular expression for the names of the problems");
  app->add_option("--ranks", options->ranks, "Ranks of the flow; all else has one")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app->add_flag("--weak", options->weak,
                "The flow alone on 1, 2, 4, ... and --ranks ranks, with equal cells on each");
  app->add_option(
         "--threads", options->threads,
         "Threads of a rank; default, of OpenMP: OMP_NUM_THREADS, else one with --launcher, else all "
         "processors over the ranks, with --weak over --ranks")
      ->check(CLI::Range(1, 4096));
  app->add_option("--launcher", options->launcher,
                  "Words that start the ranks, as 'srun -n {ranks}'; default: mpirun -n {ranks}");
  app->add_option("--keep", options->keep, "Folder for the files of the runs; without it they are removed");
  app->add_option("--out", options->out, "New file for the records, one JSON line a row");
  return {app, [options](const std::vector<std::string>& /*kokkos*/) { return run_benchmark(*options); }};
}

}  // namespace drogue::perf
