#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/program/failure.hpp"

namespace drogue::perf {

/// Runs `words`, the first of which is searched in PATH, in `folder`, without standard input, and waits.
/// Standard error is appended to the file `log`, standard output too with `log_output`, else it is discarded.
/// Returns the exit status, or 128 + signal if a signal ended it. Throws Failure(io_error) if the program
/// cannot be started.
int run_child(const std::vector<std::string>& words, const std::filesystem::path& folder,
              const std::filesystem::path& log, bool log_output = false);

/// Failure of `what`, such as "a run on 2 ranks", a run of a program of this suite that ended with `status`
/// and wrote `log`. Its code is that of the program; usage if mpirun refused to start it; io_error for a
/// signal, a foreign code, or an end without a result. Its sentence holds that of the program or of mpirun;
/// the ways out if mpirun refused root, or counted fewer slots than ranks. Throws only std::bad_alloc.
Failure failed_run(const std::string& what, int status, const std::filesystem::path& log);

/// Throws Failure(no_backend) if no folder of PATH holds mpirun, and as `failed_run` if it does not start
/// `true` on that many ranks.
void require_launcher(int ranks);

/// Words that start what follows on some ranks: `mpirun -n RANKS`. Throws only std::bad_alloc.
std::vector<std::string> launcher_words(int ranks, int threads);

/// File of a program of this suite, which stands beside this one. Throws std::filesystem::filesystem_error
/// without /proc.
std::filesystem::path program_file(const std::string& program);

/// Words that start a program of this suite, which stands beside this one, with some threads of OpenMP and
/// other `settings` NAME=VALUE of its environment, by the words of a launcher, if there are any. Throws
/// std::filesystem::filesystem_error without /proc.
std::vector<std::string> program_words(const std::vector<std::string>& launcher, int threads,
                                       const std::string& program, const std::vector<std::string>& arguments,
                                       const std::vector<std::string>& settings = {});

}  // namespace drogue::perf
