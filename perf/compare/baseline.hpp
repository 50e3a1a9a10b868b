#pragma once

#include <string>

#include "perf/compare/record_file.hpp"

namespace drogue::perf {

/// File of records for a comparison: `path` itself, or, if it is a folder, its only file *.jsonl whose first
/// record has the processor, GPU and number of threads of `after`. Throws Failure: usage if a folder has none
/// or several, and as `read_records`.
std::string find_baseline(const std::string& path, const MeasuredCase& after);

/// Commit and date of a record in words. Does not throw.
std::string describe_origin(const MeasuredCase& record);

/// Words on how much later `after` was measured, opening with a semicolon; empty if a date is unknown. Does
/// not throw.
std::string describe_age(const MeasuredCase& before, const MeasuredCase& after);

}  // namespace drogue::perf
