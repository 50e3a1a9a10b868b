#include "perf/benchmark/benchmark.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <thread>

#include <unistd.h>

#include "common/program/failure.hpp"
#include "common/program/program.hpp"
#include "common/program/signals.hpp"
#include "common/program/stopwatch.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/run/statistics.hpp"
#include "kernels/device/host_cores.hpp"
#include "perf/models/scaling.hpp"
#include "perf/problems/known_puts.hpp"
#include "perf/problems/puts.hpp"
#include "perf/process/child_process.hpp"
#include "perf/process/shell_word.hpp"
#include "perf/rows/printed.hpp"
#include "perf/rows/rows.hpp"

namespace drogue::perf::benchmark {

namespace {

/// A run is repeated while that takes this time in all, s, up to this number of runs.
constexpr double repeated_seconds = 5.0;
constexpr std::size_t most_runs = 7;

/// Figure of merit in words.
struct Merit {
  double scale;
  const char* unit;
};
const std::map<std::string, Merit> merits = {{"cell_steps_per_s", {1e-6, "M cell-steps/s"}},
                                             {"vertex_steps_per_s", {1e-6, "M vertex-steps/s"}},
                                             {"options_per_s", {1.0, "options/s"}},
                                             {"simulated_s_per_s", {1.0, "s of flight/s"}}};

/// All runs of a problem.
struct Answers {
  std::vector<double> seconds, merits;
  double found = 0.0;  ///< largest error
  bool passed = true;  ///< all programs ended with passed checks
  std::int64_t bytes = 0;
  device::HostCores cores;  ///< before the first run
  nlohmann::json result;    ///< of the last run
};

void write_batch(const std::filesystem::path& file, std::size_t count) {
  std::string text = "spot,strike,rate,maturity,lambda,alpha,beta,delta,variance\n";
  for (const options::Contract& c : puts::distinct(count))
    text += printed("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", c.spot, c.strike, c.rate,
                    c.maturity, c.jump[0], c.jump[1], c.jump[2], c.jump[3], c.variance);
  run::write_file_atomically(file.string(), text);
}

/// Largest error of the known prices, which come first; infinite if one exceeds the error that its row
/// states.
double error_of_prices(const std::filesystem::path& file) {
  std::ifstream rows(file);
  std::string line, id, price, stated;
  std::getline(rows, line);
  double largest = 0.0;
  for (const double known : thesis_puts().prices) {
    std::getline(rows, line);
    std::istringstream fields(line);
    for (std::string* field : {&id, &price, &stated}) std::getline(fields, *field, ',');
    const double error = std::abs(std::strtod(price.c_str(), nullptr) - known);
    if (!(error <= std::strtod(stated.c_str(), nullptr))) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, error);
  }
  return largest;
}

/// Size of the named check; infinite without it.
double error_of_check(const nlohmann::json& result, const std::string& name) {
  for (const nlohmann::json& check : result.value("checks", nlohmann::json::array()))
    if (check["name"] == name && check["value"].is_number()) return std::abs(check["value"].get<double>());
  return std::numeric_limits<double>::infinity();
}

/// Variables of OpenMP, which the programs inherit.
std::map<std::string, std::string> openmp_variables() {
  std::map<std::string, std::string> found;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    const std::size_t end = text.find('=');
    if (text.starts_with("OMP_") && end != std::string::npos)
      found[text.substr(0, end)] = text.substr(end + 1);
  }
  return found;
}

/// Threads of a rank that the user gives; 0 if they are not given.
int given_threads(const Request& request) {
  const char* variable = std::getenv("OMP_NUM_THREADS");
  return request.threads > 0 || variable == nullptr ? request.threads : std::max(0, std::atoi(variable));
}

/// Ranks that share the processors. All rows of weak scaling have the threads of the largest, since their
/// ranks are compared.
int sharing_ranks(const Request& request, int ranks) { return request.weak ? request.ranks : ranks; }

/// Whether only a launcher of the user knows how many ranks share the processors of a node.
bool on_unknown_nodes(const Request& request, int ranks) {
  return request.backend == device::Backend::openmp && !request.launcher.empty() &&
         sharing_ranks(request, ranks) > 1 && given_threads(request) == 0;
}

int threads_of(const Request& request, int ranks) {
  if (request.threads > 0) return request.threads;
  if (request.backend != device::Backend::openmp || on_unknown_nodes(request, ranks)) return 1;
  if (const int given = given_threads(request); given > 0) return given;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / sharing_ranks(request, ranks));
}

/// Words that start the ranks of a row.
std::vector<std::string> launcher_of(const Request& request, int ranks, int threads) {
  if (ranks == 1) return {};
  if (request.launcher.empty()) return launcher_words(ranks, threads);
  std::vector<std::string> words = request.launcher;
  constexpr std::string_view place = "{ranks}";
  for (std::string& word : words)
    if (const std::size_t at = word.find(place); at != std::string::npos)
      word.replace(at, place.size(), std::to_string(ranks));
  return words;
}

std::vector<std::string> command_of(const Request& request, const Row& row) {
  std::vector<std::string> arguments = row.problem.arguments;
  arguments.insert(arguments.end(),
                   {"--quiet", "--backend", std::string(device::name(request.backend)), "--out"});
  if (row.problem.puts > 0)
    arguments.insert(arguments.end(), {row.name + ".csv", "--result", row.name + ".json"});
  else
    arguments.insert(arguments.end(), {row.name, "--overwrite"});
  // Who repeats the command has the same binding of threads.
  std::vector<std::string> settings;
  for (const auto& [name, value] : openmp_variables())
    if (name != "OMP_NUM_THREADS") settings.push_back(name + "=" + value);
  const int threads = threads_of(request, row.ranks);
  return program_words(launcher_of(request, row.ranks, threads), threads, row.problem.program, arguments,
                       settings);
}

/// A row in the sentence of a failure.
std::string described(const Row& row) {
  return row.problem.name + " on " + std::to_string(row.ranks) + (row.ranks == 1 ? " rank" : " ranks");
}

/// One run. Throws Failure as the program does.
void run_once(const Request& request, const Row& row, const std::vector<std::string>& command,
              Answers& answers) {
  const Problem& problem = row.problem;
  const std::filesystem::path out = request.folder / row.name, prices = out.string() + ".csv",
                              log = out.string() + ".log",
                              result = out.string() + (problem.puts > 0 ? ".json" : "/result.json");
  for (const std::filesystem::path& old : {out, prices, log, result}) std::filesystem::remove_all(old);
  const int status = run_child(command, request.folder, log, true);
  if (interrupted()) throw Failure(ExitCode::interrupted, "interrupted by a signal");
  const bool wrong = status == static_cast<int>(ExitCode::verification_failed) ||
                     status == static_cast<int>(ExitCode::numerical_failure);
  if (status != 0 && !wrong) throw failed_run(described(row), status, log);
  std::ifstream file(result);
  answers.result = nlohmann::json::parse(file, nullptr, false);
  if (answers.result.is_discarded() || answers.result.value("ranks", 0) < 1)
    throw failed_run(described(row), status, log);
  if (answers.result["ranks"] != row.ranks)
    throw Failure(ExitCode::usage,
                  described(row) + ": the launcher started " + answers.result["ranks"].dump() + " of them");
  answers.found =
      std::max(answers.found,
               problem.puts > 0 ? error_of_prices(prices) : error_of_check(answers.result, problem.quantity));
  const double seconds = answers.result["timing"]["compute_s"].get<double>();
  answers.passed = answers.passed && !wrong && seconds > 0.0;
  if (seconds > 0.0) answers.seconds.push_back(seconds);
  if (answers.result.contains("figure_of_merit"))
    answers.merits.push_back(answers.result["figure_of_merit"].value(problem.merit, 0.0));
  const char* place = device::needs_device(request.backend) ? "device" : "host";
  answers.bytes = std::max(answers.bytes, answers.result["peak_bytes"][place].get<std::int64_t>());
}

Answers run_row(const Request& request, const Row& row, const std::vector<std::string>& command) {
  if (row.problem.puts > 0) write_batch(request.folder / row.problem.arguments[1], row.problem.puts);
  Answers answers;
  answers.cores = device::host_cores();
  const Stopwatch watch;
  do run_once(request, row, command, answers);
  while (answers.passed && answers.seconds.size() < most_runs &&
         watch.seconds() * (1.0 + 1.0 / static_cast<double>(answers.seconds.size())) < repeated_seconds);
  return answers;
}

/// The command in the words of a shell, without the folder of the programs.
std::string shown(std::vector<std::string> command, const std::string& program) {
  std::string text;
  for (const std::string& word : command)
    text += (text.empty() ? "" : " ") + (word.ends_with("/" + program) ? program : shell_word(word));
  return text;
}

/// Columns of the table.
constexpr const char* columns = "%-17s %-13s %-24s %-8s %15s %11s %10s  %-22s %-34s %s\n";

/// Median of the figures of merit, and in weak scaling its share of that of one rank times the ranks; neither
/// belongs to a wrong answer.
struct Figures {
  std::optional<double> merit, efficiency;
};

std::string figures_text(const Problem& problem, const Figures& figures) {
  if (!figures.merit) return "-";
  const Merit merit = merits.at(problem.merit);
  const std::string text = printed("%.4g %s", merit.scale * *figures.merit, merit.unit);
  return figures.efficiency ? text + printed(", %.1f %%", 100.0 * *figures.efficiency) : text;
}

/// Prints the columns of a row: what runs, and these.
void print_columns(const Request& request, const Row& row, const std::string& memory, const std::string& time,
                   const std::string& interval, const std::string& figures, const std::string& answer) {
  const Problem& problem = row.problem;
  std::printf(columns, problem.program.c_str(), problem.name.c_str(), problem.extent.c_str(),
              std::string(device::name(request.backend)).c_str(),
              printed("%d x %d", row.ranks, threads_of(request, row.ranks)).c_str(), memory.c_str(),
              time.c_str(), interval.c_str(), figures.c_str(), answer.c_str());
}

void print_row(const Request& request, const Row& row, const Record& record, const Answers& answers,
               const Figures& figures) {
  const Problem& problem = row.problem;
  const std::string answer = printed("%s %.3g, expected %.3g to %.3g: %s", problem.quantity.c_str(),
                                     answers.found, problem.low, problem.high, verdict(record));
  print_columns(request, row, printed("%.0f", 1e-6 * static_cast<double>(answers.bytes)),
                median_text(record, 1.0, 3),
                record.passed() && record.samples.size() == 1 ? "one run" : interval_text(record, 1.0, 3),
                figures_text(problem, figures), answer);
  const bool local = row.ranks == 1 || request.launcher.empty();
  const int others = answers.cores.running - 1, online = answers.cores.online,
            threads = row.ranks * threads_of(request, row.ranks);
  if (local && threads > answers.cores.allowed)
    std::printf("  too slow: %d threads on %d cores\n", threads, answers.cores.allowed);
  else if (local && others > 0 && others + threads > online)
    std::printf("  too slow: threads of other programs ran when it began, %d on %d cores\n", others, online);
  if (const std::string reason = answers.result.value("message", ""); !reason.empty())
    std::printf("  %s\n", reason.c_str());
  std::fflush(stdout);
}

nlohmann::json or_null(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

/// Runs a row, prints its line and adds its record. `of_one` is the figure of merit of the row of one rank in
/// weak scaling; `text`, the command in words.
void add_row(const Request& request, const Row& row, const std::vector<std::string>& command,
             const std::string& text, std::optional<double>& of_one, Table& table) {
  const Problem& problem = row.problem;
  const Answers answers = run_row(request, row, command);
  const std::string backend(device::name(request.backend)),
      size = size_names[static_cast<std::size_t>(request.size)];
  Record record{.name = "benchmark/" + problem.name + "/" + backend + "/" + size + "/ranks/" +
                        std::to_string(row.ranks) + (request.weak ? "/weak" : ""),
                .unit_of_work = "run",
                .bound = "time of the steps",
                .samples = answers.seconds,
                .error = answers.found,
                .tolerance = answers.passed && answers.found >= problem.low ? problem.high : -1.0};
  Figures figures;
  if (!record.passed())
    record.samples.clear();
  else if (!answers.merits.empty())
    figures.merit = run::median(answers.merits);
  if (request.weak && row.ranks == 1) of_one = figures.merit;
  if (figures.merit && of_one) figures.efficiency = *figures.merit / (*of_one * row.ranks);
  table.add(record, provenance_of(answers.result),
            {{"backend", backend},
             {"cells", problem.items},
             {"program", problem.program},
             {"problem", problem.name},
             {"size", size},
             {"extent", problem.extent},
             {"ranks", row.ranks},
             {"threads", answers.result["threads"]},
             {"device", answers.result["device"]},
             {"memory_bytes", answers.bytes},
             {"other_threads", answers.cores.running - 1},
             {"quantity", problem.quantity},
             {"expected", {problem.low, problem.high}},
             {"merit", problem.merit},
             {"figure_of_merit", or_null(figures.merit)},
             {"efficiency", or_null(figures.efficiency)},
             {"environment", openmp_variables()},
             {"command", text}});
  print_row(request, row, record, answers, figures);
}

}  // namespace

std::vector<Row> rows(const Request& request) {
  std::vector<Row> found;
  if (request.weak)
    for (const int ranks : unit_counts(request.ranks)) {
      const Problem problem = flow_problem(request.size, ranks);
      found.push_back({problem, ranks, problem.name + "-ranks-" + std::to_string(ranks)});
    }
  else
    for (const Problem& problem : problems(request.size))
      found.push_back({problem, problem.parallel ? request.ranks : 1, problem.name});
  return found;
}

void run(const Request& request, const std::vector<Row>& rows, Table& table) {
  for (const Row& row : rows)
    if (const std::string& program = row.problem.program; !std::filesystem::exists(program_file(program)))
      throw Failure(ExitCode::io_error,
                    "needs " + program + ": build target " + program + " beside drogue-perf");
  std::printf(columns, "program", "problem", "size", "backend", "ranks x threads",
              device::needs_device(request.backend) ? "arrays, MB" : "process, MB", "time, s",
              "95 % of the median", request.weak ? "figure of merit, efficiency" : "figure of merit",
              "error of the answer");
  if (std::ranges::any_of(rows, [&](const Row& row) { return on_unknown_nodes(request, row.ranks); }))
    std::printf("  one thread per rank with --launcher: --threads or OMP_NUM_THREADS gives other numbers\n");
  std::fflush(stdout);
  std::string commands;
  std::optional<double> of_one;
  std::optional<Failure> failure;  // the first one
  for (const Row& row : rows) {
    const std::vector<std::string> command = command_of(request, row);
    const std::string text = shown(command, row.problem.program);
    commands += "  " + text + "\n";
    try {
      add_row(request, row, command, text, of_one, table);
    } catch (...) {
      const Failure of_row = current_failure();
      if (of_row.code() == ExitCode::interrupted) throw;
      print_columns(request, row, "-", "-", "-", "-", of_row.what());
      std::fflush(stdout);
      if (!failure) failure = of_row;
    }
  }
  if (table.records.empty()) throw *failure;
  const nlohmann::json& from = table.records.back()["provenance"];
  std::printf(
      "drogue %s, commit %s; Kokkos %s; %s; %s; %s\ncommands, in a folder with the batch of options:\n%s",
      from["version"].get<std::string>().c_str(), from["git"].get<std::string>().c_str(),
      from["kokkos"].get<std::string>().c_str(), from["compiler"].get<std::string>().c_str(),
      table.records.back()["facts"]["device"].get<std::string>().c_str(),
      from["date"].get<std::string>().c_str(), commands.c_str());
  if (failure) throw *failure;
}

}  // namespace drogue::perf::benchmark
