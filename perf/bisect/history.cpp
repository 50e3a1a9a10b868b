#include "perf/bisect/history.hpp"

#include <sstream>

#include "common/program/failure.hpp"

namespace drogue::perf {

namespace {

namespace fs = std::filesystem;

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

History::History(const fs::path& repository) : _repository(repository), _folder("drogue-bisect") {
  if (!fs::is_directory(repository) || git(repository, {"rev-parse", "--git-dir"}).status != 0)
    throw Failure(ExitCode::usage, "'" + repository.string() + "' is in no git repository");
}

History::~History() {
  _folder.remove();
  try {
    run_child({"git", "worktree", "prune"}, _repository, "/dev/null");
  } catch (const Failure&) {
    // The entries of removed working trees do no harm; git removes them later.
    return;
  }
}

ChildResult History::git(const fs::path& tree, std::vector<std::string> words) {
  words.insert(words.begin(), "git");
  return run_child(words, tree, _folder.path() / "git.log");
}

std::string History::required(const fs::path& tree, const std::vector<std::string>& words) {
  const ChildResult result = git(tree, words);
  if (result.status != 0)
    throw Failure(ExitCode::io_error,
                  "git " + words.front() + " failed: " + last_line(_folder.path() / "git.log"));
  return first_line(result.output);
}

std::string History::find_commit(const std::string& name) {
  const ChildResult result =
      git(_repository, {"rev-parse", "--verify", "--quiet", "--end-of-options", name + "^{commit}"});
  if (result.status != 0)
    throw Failure(ExitCode::usage, "there is no commit '" + name + "' in '" + _repository.string() + "'");
  return first_line(result.output);
}

bool History::is_ancestor(const std::string& ancestor, const std::string& commit) {
  return ancestor != commit &&
         git(_repository, {"merge-base", "--is-ancestor", ancestor, commit}).status == 0;
}

fs::path History::top_folder() { return required(_repository, {"rev-parse", "--show-toplevel"}); }

std::string History::describe(const std::string& commit) {
  return required(_repository, {"log", "-1", "--format=%h %s", commit});
}

fs::path History::add_tree(const std::string& commit, const std::string& name) {
  const fs::path tree = _folder.path() / name;
  required(_repository, {"worktree", "add", "--quiet", "--detach", tree.string(), commit});
  return tree;
}

void History::clean(const fs::path& tree) { required(tree, {"reset", "--hard", "--quiet"}); }

History::Step History::start(const fs::path& tree, const std::string& good, const std::string& bad) {
  return step_of(tree, git(tree, {"bisect", "start", bad, good}));
}

History::Step History::judge(const fs::path& tree, const std::string& word) {
  return step_of(tree, git(tree, {"bisect", word}));
}

History::Step History::step_of(const fs::path& tree, const ChildResult& result) {
  constexpr const char* found = " is the first bad commit";
  Step step;
  std::istringstream lines(result.output);
  for (std::string line; std::getline(lines, line);) {
    if (const auto end = line.find(found); end != std::string::npos) return {true, line.substr(0, end), {}};
    // After "There are only 'skip'ped commits left to test." the candidates are listed.
    if (result.status == 2 && line.size() >= 40 &&
        line.find_first_not_of("0123456789abcdef") == std::string::npos)
      step.suspects.push_back(line);
  }
  if (!step.suspects.empty()) return step;
  if (result.status != 0)
    throw Failure(ExitCode::io_error, "git bisect failed: " + last_line(_folder.path() / "git.log"));
  step.commit = required(tree, {"rev-parse", "HEAD"});
  return step;
}

}  // namespace drogue::perf
