#include "perf/process/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "common/program/failure.hpp"

namespace drogue::perf {

namespace {

/// Descriptors and folder of a child.
class FileActions {
 public:
  FileActions() { posix_spawn_file_actions_init(&_actions); }
  ~FileActions() { posix_spawn_file_actions_destroy(&_actions); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;

  void enter(const std::filesystem::path& folder) {
    posix_spawn_file_actions_addchdir_np(&_actions, folder.c_str());
  }
  void open(int descriptor, const std::filesystem::path& file, int flags) {
    posix_spawn_file_actions_addopen(&_actions, descriptor, file.c_str(), flags, 0666);
  }
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &_actions; }

 private:
  posix_spawn_file_actions_t _actions{};
};

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

int run_child(const std::vector<std::string>& words, const std::filesystem::path& folder,
              const std::filesystem::path& log, bool log_output) {
  FileActions actions;
  actions.open(0, "/dev/null", O_RDONLY);
  actions.open(1, log_output ? log : "/dev/null", O_WRONLY | O_CREAT | O_APPEND);
  actions.open(2, log, O_WRONLY | O_CREAT | O_APPEND);
  actions.enter(folder);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments[0], actions.get(), nullptr, arguments.data(), environ);
  if (error != 0)
    throw Failure(ExitCode::io_error, "'" + words[0] + "' cannot be started: " + std::strerror(error));
  return wait_for(child);
}

std::string last_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = line;
  return last;
}

}  // namespace drogue::perf
