#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drogue::perf {

/// Runs `words`, the first of which is searched in PATH, in `folder`, without standard input, and waits.
/// Standard error is appended to the file `log`, standard output too with `log_output`, else it is discarded.
/// Returns the exit status, or 128 + signal if a signal ended it. Throws Failure(io_error) if the program
/// cannot be started.
int run_child(const std::vector<std::string>& words, const std::filesystem::path& folder,
              const std::filesystem::path& log, bool log_output = false);

/// Last line of a file that is not empty, such as the reason of a failure in a log; empty without one. Throws
/// only std::bad_alloc.
std::string last_line(const std::filesystem::path& file);

}  // namespace drogue::perf
