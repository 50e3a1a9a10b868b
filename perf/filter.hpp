#pragma once

#include <regex>
#include <string>

namespace drogue::perf {

/// The regular expression of a --filter. Throws Failure(usage) if it is none.
std::regex filter_of(const std::string& text);

}  // namespace drogue::perf
