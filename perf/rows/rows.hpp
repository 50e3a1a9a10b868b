#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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

/// Messages between ranks in a step, s: measured alone and by the model, and the time of the step by it where
/// that of one rank is known.
struct MessageTimes {
  double measured, modelled;
  std::optional<double> step;
};

/// Columns of a scaling table with their line end: time of `record` on some units, us, interval, and
/// efficiency against the time `of_one` unit, s, `-` where that is not known; of several ranks the time of
/// the messages, us, their share of the step, and both by the model. A failed record has `FAILED` in place of
/// the time, and by how much it failed.
std::string scaling_columns(const Record& record, bool weak, int units, const std::optional<double>& of_one,
                            const std::optional<MessageTimes>& messages = {});

/// Columns of speed-up over one unit and efficiency in strong scaling; `-` where the time of one is not
/// known.
std::string speed_up_columns(const std::optional<double>& of_one, double time, int units);

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
                         const std::optional<PrintedTimes>& theirs, const std::optional<double>& core);

/// Row of a table of block sizes without its line end: size and the medians of its blocks, us, `FAILED` for
/// records that failed their check, then whether the order of the speeds is that of the `occupancies`, by
/// those that passed. Sides have the same length. Does not throw.
std::string block_row(std::int64_t cells, const std::vector<const Record*>& records,
                      const std::vector<double>& occupancies);

}  // namespace drogue::perf
