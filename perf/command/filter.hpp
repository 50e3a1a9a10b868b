#pragma once

#include <optional>
#include <regex>
#include <string>

namespace drogue::perf {

/// Regular expression of the option --filter. Throws Failure(usage) for a malformed or an overlong text.
std::regex filter_of(const std::string& text);

/// Reason why a backend that a filter or the name of a case names between slashes cannot run here. Does not
/// throw.
std::optional<std::string> missing_backend(const std::string& filter);

}  // namespace drogue::perf
