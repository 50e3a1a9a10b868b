#pragma once

#include <optional>
#include <string>

#include "perf/measure/measurement.hpp"

namespace drogue::perf {

/// Times that [Shi] prints, us.
struct PrintedTimes {
  double h2d, compute, d2h, total;
  std::optional<double> cpu;  ///< of one core
};

/// Note on one core, and heading of the columns of `transfer_row` behind `row`, that of the names of rows.
/// Does not throw.
std::string transfer_heading(const std::string& row);

/// Row of a table of transfers: medians of the parts `h2d`, `compute` and `d2h` of a record and of their sum,
/// us, the computation on one core (`core`, s) and its ratios to compute and total, each with the value of
/// [Shi] in brackets, the interval of the sum, error and verdict; `-` where a time is not known. A record
/// that failed its check has `FAILED` in place of the sum, and no other times. Throws std::out_of_range for a
/// record without these parts.
std::string transfer_row(const std::string& row, const Record& record,
                         const std::optional<PrintedTimes>& printed, const std::optional<double>& core);

}  // namespace drogue::perf
