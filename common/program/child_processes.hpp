#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace drogue {

/// A process to start.
struct ChildProcess {
  std::filesystem::path program;
  std::vector<std::string> command;                ///< its name and its arguments
  std::map<std::string, std::string> environment;  ///< beside that of this process, which it replaces
  std::filesystem::path log;                       ///< file that takes its output and errors
};

/// Path of the program that runs. Throws `Failure` (io_error) where the system does not tell.
[[nodiscard]] std::filesystem::path this_program();

/// Runs processes, at most `jobs` at once and in their order, and calls `ended` with the number of each one
/// that ends and its exit code, 128 plus its number after a signal. Blocks until all that were started have
/// ended. Once `interrupted()`, no more are started, and those that run receive SIGINT, once: Ctrl-C of a
/// terminal does not reach them. On Linux they end with this process. Returns false if some were not started.
/// Not for processes with several threads. Throws `Failure` (io_error) if a process cannot be started.
bool run_processes(const std::vector<ChildProcess>& processes, int jobs,
                   const std::function<void(std::size_t process, int exit_code)>& ended);

}  // namespace drogue
