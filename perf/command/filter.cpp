#include "perf/command/filter.hpp"

#include "common/program/failure.hpp"

namespace drogue::perf {

std::regex filter_of(const std::string& text) {
  // std::regex recurses for nested brackets: a bound on the length bounds the stack.
  constexpr std::size_t longest = 1000;
  if (text.size() > longest)
    throw Failure(ExitCode::usage, "--filter has more than " + std::to_string(longest) + " characters");
  try {
    return std::regex(text);
  } catch (const std::regex_error&) {
    throw Failure(ExitCode::usage,
                  "--filter '" + text +
                      "' is not a valid regular expression; literal brackets and stars need a "
                      "backslash before them");
  }
}

}  // namespace drogue::perf
