#include "common/program/child_processes.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>
#include <thread>

#include "common/program/failure.hpp"
#include "common/program/signals.hpp"

extern char** environ;

namespace drogue {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw Failure(ExitCode::io_error, what + ": " + std::generic_category().message(errno));
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// The environment of this process, with other values of some variables.
std::vector<std::string> environment_with(const std::map<std::string, std::string>& values) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    if (!values.contains(text.substr(0, text.find('=')))) all.push_back(text);
  }
  for (const auto& [name, value] : values) all.push_back(name + "=" + value);
  return all;
}

/// Starts a process in a group of its own. Between fork and exec, only calls that are safe in signal
/// handlers.
pid_t start(const ChildProcess& process) {
  std::vector<std::string> command = process.command, variables = environment_with(process.environment);
  const std::vector<char*> arguments = pointers_to(command), environment = pointers_to(variables);
  const pid_t parent = getpid(), child = fork();
  if (child < 0) fail("a process cannot be started");
  if (child > 0) return child;
  std::signal(SIGINT, SIG_DFL);  // the handler of this process would take it without an effect
  setpgid(0, 0);
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGTERM);
#endif
  const int log = open(process.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (log >= 0 && getppid() == parent) {
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    close(log);
    execve(process.program.c_str(), arguments.data(), environment.data());
  }
  _exit(static_cast<int>(ExitCode::io_error));
}

}  // namespace

std::filesystem::path this_program() {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw Failure(ExitCode::io_error, "the path of this program is not known: " + error.message());
  return path;
}

bool run_processes(const std::vector<ChildProcess>& processes, int jobs,
                   const std::function<void(std::size_t process, int exit_code)>& ended) {
  using namespace std::chrono_literals;
  std::map<pid_t, std::size_t> running;
  std::size_t next = 0;
  bool is_told = false;
  while (next < processes.size() || !running.empty()) {
    if (interrupted() && !is_told) {
      is_told = true;
      for (const auto& [child, process] : running) kill(child, SIGINT);
    }
    if (is_told && running.empty()) break;
    if (!is_told && next < processes.size() && running.size() < static_cast<std::size_t>(std::max(jobs, 1))) {
      running.emplace(start(processes[next]), next);
      ++next;
      continue;
    }
    int status = 0;
    const pid_t child = waitpid(-1, &status, WNOHANG);
    const auto found = running.find(child);
    if (found == running.end()) {
      std::this_thread::sleep_for(20ms);
      continue;
    }
    const std::size_t process = found->second;
    running.erase(found);
    ended(process, WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
  }
  return next == processes.size();
}

}  // namespace drogue
