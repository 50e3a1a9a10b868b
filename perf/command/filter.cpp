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
                      "' is no regular expression; a bracket or a star that stands for itself "
                      "needs a backslash before it");
  }
}

}  // namespace drogue::perf
