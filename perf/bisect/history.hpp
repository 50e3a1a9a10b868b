#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/run/files/temporary_folder.hpp"
#include "perf/bisect/child_process.hpp"

namespace drogue::perf {

/// Git repository whose commits are searched, in working trees of its own below a temporary folder: the
/// user's tree and a bisection there are left alone. Functions throw Failure(io_error) with the last words of
/// git if it fails.
class History {
 public:
  /// Throws Failure(usage) if `repository` is in no repository.
  explicit History(const std::filesystem::path& repository);
  /// Removes the working trees.
  ~History();
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  /// Full hash of a commit. Throws Failure(usage) if there is none of that name.
  std::string find_commit(const std::string& name);
  /// True if `ancestor` is an ancestor of `commit`, and another one.
  bool is_ancestor(const std::string& ancestor, const std::string& commit);
  /// Folder that holds the repository's own working tree.
  std::filesystem::path top_folder();
  /// Short hash and subject of a commit.
  std::string describe(const std::string& commit);
  /// Checks a commit out into a new working tree; returns its folder.
  std::filesystem::path add_tree(const std::string& commit, const std::string& name);
  /// Removes changes of tracked files from a working tree.
  void clean(const std::filesystem::path& tree);

  /// Result of a step of `git bisect`: the commit to test next, or the first bad one.
  struct Step {
    bool is_found = false;
    std::string commit;                 ///< hash
    std::vector<std::string> suspects;  ///< if only skipped commits are left, the possible first bad ones
  };
  /// Starts a bisection in a working tree.
  Step start(const std::filesystem::path& tree, const std::string& good, const std::string& bad);
  /// Judges the commit of the working tree: "good", "bad" or "skip".
  Step judge(const std::filesystem::path& tree, const std::string& word);

  /// Temporary folder for files of the caller, removed with the working trees.
  [[nodiscard]] const std::filesystem::path& folder() const { return _folder.path(); }

 private:
  ChildResult git(const std::filesystem::path& tree, std::vector<std::string> words);
  std::string required(const std::filesystem::path& tree, const std::vector<std::string>& words);
  Step step_of(const std::filesystem::path& tree, const ChildResult& result);

  std::filesystem::path _repository;
  run::TemporaryFolder _folder;
};

}  // namespace drogue::perf
