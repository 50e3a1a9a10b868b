#include "perf/bisect/bisection.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <tuple>
#include <vector>

#include "common/program/failure.hpp"
#include "common/program/signals.hpp"
#include "common/scene/nearest.hpp"
#include "perf/bisect/history.hpp"
#include "perf/compare/annotation.hpp"
#include "perf/compare/comparison.hpp"

namespace drogue::perf {

namespace {

namespace fs = std::filesystem;

constexpr int first_turns = 2, most_turns = 4;

void stop_if_interrupted() {
  if (interrupted()) throw Failure(ExitCode::interrupted, "the search was interrupted by a signal");
}

/// Regular expression that a name alone matches.
std::string exact_pattern(const std::string& name) {
  std::string pattern = "^";
  for (const char c : name) {
    if (std::string("\\^$.|?*+()[]{}").find(c) != std::string::npos) pattern += '\\';
    pattern += c;
  }
  return pattern + "$";
}

/// Change of a case between two programs: none if it is in doubt or cannot be measured.
struct Change {
  std::optional<Verdict> verdict;
  std::string words;
};

class Search {
 public:
  explicit Search(const BisectOptions& options) : _options(options), _history(options.repository) {}

  void run() {
    const std::string good = _history.find_commit(_options.good), bad = _history.find_commit(_options.bad);
    if (!_history.is_ancestor(good, bad))
      throw Failure(ExitCode::usage,
                    "GOOD, '" + _options.good + "', is no ancestor of BAD, '" + _options.bad + "'");
    // scripts/build.sh looks for the dependencies below its own tree, which is new here.
    if (const fs::path own = _history.top_folder() / "build/deps"; fs::is_directory(own))
      setenv("DROGUE_DEPS", own.c_str(), 0);
    _reference = _history.add_tree(good, "good");
    _candidate = _history.add_tree(bad, "candidate");
    build_or_throw(_reference, _options.good);
    find_case();
    build_or_throw(_candidate, _options.bad);
    const Change whole = measure();
    report(bad, "bad", whole.words);
    if (!whole.verdict || *whole.verdict == Verdict::same)
      throw Failure(ExitCode::verification_failed, _options.name + " shows no change from '" + _options.good +
                                                       "' to '" + _options.bad + "': " + whole.words);
    conclude(search(good, bad, *whole.verdict));
  }

 private:
  History::Step search(const std::string& good, const std::string& bad, Verdict wanted) {
    History::Step step = _history.start(_candidate, good, bad);
    while (!step.is_found && step.suspects.empty()) {
      const std::string commit = step.commit;
      const Change change = build(_candidate) ? measure() : Change{{}, "does not build"};
      const char* word = change.verdict == wanted ? "bad" : change.verdict == Verdict::same ? "good" : "skip";
      report(commit, word, change.words);
      _history.clean(_candidate);
      step = _history.judge(_candidate, word);
    }
    return step;
  }

  void conclude(const History::Step& last) {
    if (last.is_found) {
      std::printf("first bad commit: %s\n", _history.describe(last.commit).c_str());
      return;
    }
    std::string all;
    for (const std::string& commit : last.suspects)
      all += (all.empty() ? "" : ", ") + _history.describe(commit);
    throw Failure(ExitCode::verification_failed,
                  "skipped commits hide the first bad one, which is among: " + all);
  }

  bool build(const fs::path& tree) {
    stop_if_interrupted();
    const int status =
        run_child({"/bin/sh", "-c", _options.build}, tree, _history.folder() / "build.log", true).status;
    stop_if_interrupted();
    return status == 0 && fs::exists(tree / _options.program);
  }

  void build_or_throw(const fs::path& tree, const std::string& commit) {
    if (!build(tree))
      throw Failure(ExitCode::io_error, "'" + _options.build + "' does not make '" + _options.program +
                                            "' of '" + commit + "'; give --build and --program");
  }

  ChildResult run_program(const fs::path& tree, std::vector<std::string> words) {
    words.insert(words.begin(), (tree / _options.program).string());
    ChildResult result = run_child(words, tree, _history.folder() / "run.log");
    stop_if_interrupted();
    return result;
  }

  /// Finds out whether `run` or `run --quick` has the case.
  void find_case() {
    std::vector<std::string> known;
    for (const bool quick : {false, true}) {
      std::istringstream lines(run_program(_reference, quick ? std::vector<std::string>{"list", "--quick"}
                                                             : std::vector<std::string>{"list"})
                                   .output);
      for (std::string line; std::getline(lines, line);) {
        known.push_back(line);
        if (line != _options.name) continue;
        _quick = quick;
        return;
      }
    }
    throw Failure(ExitCode::usage, "there is no case '" + _options.name + "' at '" + _options.good + "'; " +
                                       scene::suggestion(_options.name, known));
  }

  /// Records of one run, without provenance and facts: both programs run on this machine, and a commit that
  /// changes the flags of the compiler may be the one that is searched for. None if the program does not
  /// write any.
  std::vector<MeasuredCase> records_of(const fs::path& tree) {
    const std::string file = (_history.folder() / "records.jsonl").string();
    fs::remove(file);
    std::vector<std::string> words = {"run", "--filter", exact_pattern(_options.name), "--out", file};
    if (_quick) words.emplace_back("--quick");
    run_program(tree, words);
    if (!fs::exists(file)) return {};
    std::vector<MeasuredCase> records = read_records(file);
    for (MeasuredCase& record : records)
      record.provenance = record.facts = record.clocks = nlohmann::json::object();
    return records;
  }

  /// Without records too if the program of a commit cannot start, or writes invalid ones.
  std::vector<MeasuredCase> records_or_none(const fs::path& tree) {
    try {
      return records_of(tree);
    } catch (const Failure& failure) {
      if (failure.code() == ExitCode::interrupted) throw;
      return {};
    }
  }

  Change measure() {
    std::vector<MeasuredCase> before, after;
    Change change;
    for (int turn = 1; turn <= most_turns && !change.verdict; ++turn) {
      for (auto& [tree, records] : {std::tie(_reference, before), std::tie(_candidate, after)}) {
        const std::vector<MeasuredCase> more = records_or_none(tree);
        if (more.empty()) return {{}, "does not run"};
        records.insert(records.end(), more.begin(), more.end());
      }
      if (turn >= first_turns) change = change_between(before, after);
    }
    return change;
  }

  [[nodiscard]] static Change change_between(const std::vector<MeasuredCase>& before,
                                             const std::vector<MeasuredCase>& after) {
    const ComparedCase row = compare_records(before, after).front();
    const std::string words = row.speed ? describe_change(*row.speed) : row.reason;
    if (row.verdict == Verdict::ambiguous || row.verdict == Verdict::not_comparable) return {{}, words};
    return {row.verdict, words};
  }

  void report(const std::string& commit, const char* word, const std::string& words) {
    std::printf("%-4s  %s  (%s)\n", word, _history.describe(commit).c_str(), words.c_str());
    std::fflush(stdout);
  }

  const BisectOptions& _options;
  History _history;
  fs::path _reference, _candidate;
  bool _quick = false;
};

}  // namespace

void bisect(const BisectOptions& options) { Search(options).run(); }

}  // namespace drogue::perf
