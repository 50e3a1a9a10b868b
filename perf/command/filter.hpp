#pragma once

#include <regex>
#include <string>

namespace drogue::perf {

/// Regular expression of the option --filter. Throws Failure(usage) for a malformed or an overlong text.
std::regex filter_of(const std::string& text);

}  // namespace drogue::perf
