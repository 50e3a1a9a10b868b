#pragma once

#include <string>
#include <vector>

#include "perf/compare/record_file.hpp"

/// Records in formats of other programs. No function throws.
namespace drogue::perf {

/// CSV with a header, one record a row: name, unit, median and interval (s), number of samples, their least
/// and largest, error, check, size, machine and commit. Fields that a record lacks are empty.
std::string to_csv(const std::vector<MeasuredCase>& records);

/// JSON in the layout of a report of ReFrame (session_info, runs, testcases with perfvars): a test case per
/// record, its median time as the variable `time` without a reference, which passes or fails by its check.
std::string to_reframe(const std::vector<MeasuredCase>& records);

}  // namespace drogue::perf
