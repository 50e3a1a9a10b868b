#pragma once

#include <optional>
#include <string>

#include "perf/measure/measurement.hpp"

/// Columns of tables that show the time of a record. A record that failed its check has no time: a wrong
/// result can be computed in any time. No function throws.
namespace drogue::perf {

/// Text in place of the time of a failed record.
inline constexpr const char* failed_text = "FAILED";

/// Median of the samples by `scale`, such as 1e6 for us, with `digits` behind the point; `FAILED` if the
/// check failed.
std::string median_text(const Record& record, double scale, int digits);

/// Interval of the median, "[low .. high]"; empty if the check failed.
std::string interval_text(const Record& record, double scale, int digits);

/// Columns of a scaling table with their line end: time of `record` on some units, us, interval, and
/// efficiency against the time `of_one` unit, s, `-` where that is not known. A failed record has `FAILED` in
/// place of the time, and by how much it failed.
std::string scaling_columns(const Record& record, bool weak, int units, const std::optional<double>& of_one);

/// Columns of speed-up over one unit and efficiency in strong scaling; `-` where the time of one is not
/// known.
std::string speed_up_columns(const std::optional<double>& of_one, double time, int units);

}  // namespace drogue::perf
