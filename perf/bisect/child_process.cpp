#include "perf/bisect/child_process.hpp"

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
  void duplicate(int from, int to) { posix_spawn_file_actions_adddup2(&_actions, from, to); }
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &_actions; }

 private:
  posix_spawn_file_actions_t _actions{};
};

std::string read_all(int descriptor) {
  std::string all;
  char part[4096];
  for (;;) {
    const ssize_t count = read(descriptor, part, sizeof part);
    if (count > 0)
      all.append(part, static_cast<std::size_t>(count));
    else if (count == 0 || errno != EINTR)
      return all;
  }
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ChildResult run_child(const std::vector<std::string>& words, const std::filesystem::path& folder,
                      const std::filesystem::path& log, bool log_output) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw Failure(ExitCode::io_error, std::string("a pipe cannot be made: ") + std::strerror(errno));
  FileActions actions;
  actions.open(0, "/dev/null", O_RDONLY);
  actions.open(2, log, O_WRONLY | O_CREAT | O_APPEND);
  actions.duplicate(log_output ? 2 : ends[1], 1);
  actions.enter(folder);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments[0], actions.get(), nullptr, arguments.data(), environ);
  close(ends[1]);
  ChildResult result;
  if (error == 0) result.output = read_all(ends[0]), result.status = wait_for(child);
  close(ends[0]);
  if (error != 0)
    throw Failure(ExitCode::io_error, "'" + words[0] + "' cannot be started: " + std::strerror(error));
  return result;
}

std::string last_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = line;
  return last;
}

}  // namespace drogue::perf
