#include "common/program/program.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <CLI/Error.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>
#include <thread>

#include "common/program/mpi_guard.hpp"

namespace drogue {
namespace {

/// First line of what(): libraries append stack traces.
std::string first_line(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\n");
  if (begin == std::string::npos) return "no description";
  return text.substr(begin, text.find('\n', begin) - begin);
}

/// Discards stdout for the life of the object if `silent`.
class Silence {
 public:
  explicit Silence(bool silent) {
    if (!silent) return;
    std::fflush(stdout);
    _before = ::dup(STDOUT_FILENO);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    ::dup2(nowhere, STDOUT_FILENO);
    ::close(nowhere);
  }
  ~Silence() {
    if (_before < 0) return;
    std::fflush(stdout);
    ::dup2(_before, STDOUT_FILENO);
    ::close(_before);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int _before = -1;
};

}  // namespace

Failure current_failure() {
  try {
    throw;
  } catch (const Failure& failure) {
    return failure;
  } catch (const CLI::Error& error) {
    return {ExitCode::usage, first_line(error.what())};
  } catch (const std::bad_alloc&) {
    return {ExitCode::io_error, "out of memory: use fewer cells, or run where there is more memory"};
  } catch (const std::filesystem::filesystem_error& error) {
    return {ExitCode::io_error, "cannot use '" + error.path1().string() + "': " + error.code().message()};
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again)
      return {ExitCode::io_error,
              "a thread could not start: the limit of threads or memory is reached (ulimit -u, ulimit -v)"};
    return {ExitCode::io_error, "the operating system refused: " + first_line(error.what())};
  } catch (const std::exception& error) {
    return {ExitCode::io_error, "unexpected error: " + first_line(error.what())};
  } catch (...) {
    return {ExitCode::io_error, "unexpected error of unknown kind"};
  }
}

void print_notice(const std::string& program, const std::string& sentence) {
  if (launched_rank().rank != 0) return;
  std::fflush(stdout);  // what was printed before stands before it, also where both go to one pipe
  std::fprintf(stderr, "%s: %s\n", program.c_str(), sentence.c_str());
}

int run_program(const std::string& program, const std::function<ExitCode()>& body) {
  ExitCode code = ExitCode::ok;
  const Silence silence(launched_rank().rank != 0);
  try {
    code = body();
  } catch (...) {
    const Failure failure = current_failure();
    code = failure.code();
    if (launched_rank().rank == 0) {
      std::fflush(stdout);
      const bool located = code == ExitCode::invalid_scene;
      std::fprintf(stderr, "%s%s%s\n", located ? "" : program.c_str(), located ? "" : ": ", failure.what());
    } else {
      // A launcher ends all ranks as soon as one fails: give rank 0 time to print the reason.
      std::this_thread::sleep_for(std::chrono::seconds(1));
    }
  }
  // Lost output, say of --print-scene to a full disk, is a failure, also if an earlier write lost it.
  const bool is_lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  if (is_lost && code == ExitCode::ok) {
    std::fprintf(stderr, "%s: cannot write to standard output\n", program.c_str());
    code = ExitCode::io_error;
  }
  return static_cast<int>(code);
}

}  // namespace drogue
