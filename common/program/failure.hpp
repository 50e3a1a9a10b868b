#pragma once

#include <stdexcept>
#include <string>

namespace drogue {

/// Process exit codes; part of the public interface of every program.
enum class ExitCode : int {
  ok = 0,
  usage = 2,
  invalid_scene = 3,
  numerical_failure = 4,
  verification_failed = 5,
  io_error = 6,
  no_backend = 77,
  interrupted = 130,
};

/// Error that ends the program with exit code `code()`. `what()` is one sentence for the user.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& sentence) : std::runtime_error(sentence), _code(code) {}

  [[nodiscard]] ExitCode code() const noexcept { return _code; }

 private:
  ExitCode _code;
};

/// Returns `make()`. Converts std::invalid_argument to a `Failure` (usage).
template <class Make>
auto with_usage_error(const Make& make) {
  try {
    return make();
  } catch (const std::invalid_argument& refused) {
    throw Failure(ExitCode::usage, refused.what());
  }
}

}  // namespace drogue
