#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drogue::perf {

/// Finished child process.
struct ChildResult {
  int status = 0;      ///< exit status; 128 + signal if a signal ended it
  std::string output;  ///< standard output; empty if it went to a file
};

/// Runs `words`, the first of which is searched in PATH, in `folder`, without standard input, and waits.
/// Standard error goes to the file `log`; standard output is returned, or appended to `log` too with
/// `log_output`. Throws Failure(io_error) if the program cannot be started.
ChildResult run_child(const std::vector<std::string>& words, const std::filesystem::path& folder,
                      const std::filesystem::path& log, bool log_output = false);

/// Last line of a file that is not empty, such as the reason of a failure in a log; empty without one. Throws
/// only std::bad_alloc.
std::string last_line(const std::filesystem::path& file);

}  // namespace drogue::perf
