#include "perf/command/filter.hpp"

#include <algorithm>
#include <string_view>

#include "common/program/failure.hpp"
#include "kernels/device/backend.hpp"

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

std::optional<std::string> missing_backend(const std::string& filter) {
  constexpr std::string_view separators = "/^$|()";
  for (std::size_t begin = 0; begin < filter.size();) {
    const std::size_t end = std::min(filter.find_first_of(separators, begin), filter.size());
    if (const auto backend = device::backend_from_name(filter.substr(begin, end - begin)))
      if (const auto reason = device::why_unavailable(*backend)) return reason;
    begin = end + 1;
  }
  return {};
}

}  // namespace drogue::perf
