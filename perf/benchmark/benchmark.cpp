#include "perf/benchmark/benchmark.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string_view>
#include <thread>

#include "common/program/failure.hpp"
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

int threads_of(const Request& request, int ranks) {
  if (request.threads > 0) return request.threads;
  if (request.backend != device::Backend::openmp) return 1;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / ranks);
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

std::vector<std::string> command_of(const Request& request, const Problem& problem, int ranks) {
  std::vector<std::string> arguments = problem.arguments;
  arguments.insert(arguments.end(),
                   {"--quiet", "--backend", std::string(device::name(request.backend)), "--out"});
  if (problem.puts > 0)
    arguments.insert(arguments.end(), {problem.name + ".csv", "--result", problem.name + ".json"});
  else
    arguments.insert(arguments.end(), {problem.name, "--overwrite"});
  const int threads = threads_of(request, ranks);
  return program_words(launcher_of(request, ranks, threads), threads, problem.program, arguments);
}

/// One run. Throws Failure as the program does.
void run_once(const Request& request, const Problem& problem, int ranks,
              const std::vector<std::string>& command, Answers& answers) {
  const std::filesystem::path out = request.folder / problem.name, prices = out.string() + ".csv",
                              log = out.string() + ".log",
                              result = out.string() + (problem.puts > 0 ? ".json" : "/result.json");
  for (const std::filesystem::path& old : {out, prices, log, result}) std::filesystem::remove_all(old);
  const int status = run_child(command, request.folder, log, true);
  if (interrupted()) throw Failure(ExitCode::interrupted, "interrupted by a signal");
  const std::string units = problem.name + " on " + std::to_string(ranks) + (ranks == 1 ? " rank" : " ranks");
  const bool wrong = status == static_cast<int>(ExitCode::verification_failed) ||
                     status == static_cast<int>(ExitCode::numerical_failure);
  if (status != 0 && !wrong) throw failed_run(units, status, log);
  std::ifstream file(result);
  answers.result = nlohmann::json::parse(file, nullptr, false);
  if (answers.result.is_discarded() || answers.result.value("ranks", 0) < 1)
    throw failed_run(units, status, log);
  if (answers.result["ranks"] != ranks)
    throw Failure(ExitCode::usage,
                  units + ": the launcher started " + answers.result["ranks"].dump() + " of them");
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

Answers run_problem(const Request& request, const Problem& problem, int ranks,
                    const std::vector<std::string>& command) {
  if (problem.puts > 0) write_batch(request.folder / problem.arguments[1], problem.puts);
  Answers answers;
  answers.cores = device::host_cores();
  const Stopwatch watch;
  do run_once(request, problem, ranks, command, answers);
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
constexpr const char* columns = "%-17s %-13s %-24s %-8s %15s %11s %10s  %-22s %-26s %s\n";

void print_row(const Request& request, const Problem& problem, int ranks, const Record& record,
               const Answers& answers) {
  const Merit merit = merits.at(problem.merit);
  const std::string rate = record.passed() && !answers.merits.empty()
                               ? printed("%.4g %s", merit.scale * run::median(answers.merits), merit.unit)
                               : "-";
  const std::string answer = printed("%s %.3g, expected %.3g to %.3g: %s", problem.quantity.c_str(),
                                     answers.found, problem.low, problem.high, verdict(record));
  std::printf(
      columns, problem.program.c_str(), problem.name.c_str(), problem.extent.c_str(),
      std::string(device::name(request.backend)).c_str(),
      printed("%d x %d", ranks, threads_of(request, ranks)).c_str(),
      printed("%.0f", 1e-6 * static_cast<double>(answers.bytes)).c_str(), median_text(record, 1.0, 3).c_str(),
      record.passed() && record.samples.size() == 1 ? "one run" : interval_text(record, 1.0, 3).c_str(),
      rate.c_str(), answer.c_str());
  const int others = answers.cores.running - 1, online = answers.cores.online;
  if (others > 0 && others + ranks * threads_of(request, ranks) > online)
    std::printf("  too slow: threads of other programs ran when it began, %d on %d cores\n", others, online);
  if (const std::string reason = answers.result.value("message", ""); !reason.empty())
    std::printf("  %s\n", reason.c_str());
  std::fflush(stdout);
}

/// Runs a problem, prints its row and adds its record. Returns its command.
std::string add_row(const Request& request, const Problem& problem, int ranks, Table& table) {
  const std::vector<std::string> command = command_of(request, problem, ranks);
  const std::string text = shown(command, problem.program);
  const Answers answers = run_problem(request, problem, ranks, command);
  const std::string backend(device::name(request.backend)),
      size = size_names[static_cast<std::size_t>(request.size)];
  const Record record{.name = "benchmark/" + problem.name + "/" + backend + "/" + size + "/ranks/" +
                              std::to_string(ranks) + (request.weak ? "/weak" : ""),
                      .unit_of_work = "run",
                      .bound = "time of the steps",
                      .samples = answers.seconds,
                      .error = answers.found,
                      .tolerance = answers.passed && answers.found >= problem.low ? problem.high : -1.0};
  table.add(record, provenance_of(answers.result),
            {{"backend", backend},
             {"cells", problem.items},
             {"program", problem.program},
             {"problem", problem.name},
             {"size", size},
             {"extent", problem.extent},
             {"ranks", ranks},
             {"threads", answers.result["threads"]},
             {"device", answers.result["device"]},
             {"memory_bytes", answers.bytes},
             {"other_threads", answers.cores.running - 1},
             {"quantity", problem.quantity},
             {"expected", {problem.low, problem.high}},
             {"merit", problem.merit},
             {"figure_of_merit",
              answers.merits.empty() ? nlohmann::json() : nlohmann::json(run::median(answers.merits))},
             {"command", text}});
  print_row(request, problem, ranks, record, answers);
  return text;
}

}  // namespace

void run(const Request& request, Table& table) {
  std::string commands;
  std::printf(columns, "program", "problem", "size", "backend", "ranks x threads", "memory, MB", "time, s",
              "95 % of the median", "figure of merit", "error of the answer");
  const auto add = [&](const Problem& problem, int ranks) {
    if (request.wants(problem.name)) commands += "  " + add_row(request, problem, ranks, table) + "\n";
  };
  if (request.weak)
    for (const int ranks : unit_counts(request.ranks)) add(flow_problem(request.size, ranks), ranks);
  else
    for (const Problem& problem : problems(request.size)) add(problem, problem.parallel ? request.ranks : 1);
  if (table.records.empty()) return;
  const nlohmann::json& from = table.records.back()["provenance"];
  std::printf(
      "drogue %s, commit %s; Kokkos %s; %s; %s; %s\ncommands, in a folder with the batch of options:\n%s",
      from["version"].get<std::string>().c_str(), from["git"].get<std::string>().c_str(),
      from["kokkos"].get<std::string>().c_str(), from["compiler"].get<std::string>().c_str(),
      table.records.back()["facts"]["device"].get<std::string>().c_str(),
      from["date"].get<std::string>().c_str(), commands.c_str());
}

}  // namespace drogue::perf::benchmark
