#pragma once

#include <cstdint>
#include <string>

namespace drogue {

/// Model name of the processor, `unknown` where the system does not tell.
std::string cpu_model();

/// Now, UTC, ISO 8601: `2025-01-31T12:00:00Z`.
std::string utc_date();

/// Largest resident set of this process so far, bytes.
std::int64_t host_peak_bytes();

/// What --version prints: the program, the commit, and what it was built with.
std::string version_text(const std::string& program);

}  // namespace drogue
