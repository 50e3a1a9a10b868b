#pragma once

#include <cstdint>
#include <string>

namespace drogue {

/// Model name of the processor; `unknown` if the system does not provide it.
std::string cpu_model();

/// Current time in UTC, ISO 8601: `2025-01-31T12:00:00Z`.
std::string utc_date();

/// Peak resident set size of this process, bytes.
std::int64_t host_peak_bytes();

/// Text of --version: the program, the commit, compiler and libraries.
std::string version_text(const std::string& program);

}  // namespace drogue
