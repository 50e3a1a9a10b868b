#include "perf/rows/transfer_row.hpp"

#include <cstdio>

#include "common/run/statistics.hpp"
#include "perf/rows/timed_columns.hpp"

namespace drogue::perf {
namespace {

/// Column of a table: a text, and behind it the value of [Shi] by `format`, if there is one.
std::string column(int width, int printed_width, const std::string& text, const char* format,
                   const std::optional<double>& printed) {
  char brackets[32] = "", both[96];
  if (printed) std::snprintf(brackets, sizeof brackets, format, *printed);
  std::snprintf(both, sizeof both, " %*s %-*s", width, text.c_str(), printed_width, brackets);
  return both;
}

/// Value by `format`, `-` if it is not known.
std::string known(const char* format, const std::optional<double>& value) {
  char text[32] = "-";
  if (value) std::snprintf(text, sizeof text, format, *value);
  return text;
}

std::string time_column(const std::string& text, const std::optional<double>& printed) {
  return column(10, 10, text, "(%.0f)", printed);
}

std::string time_column(const std::optional<double>& seconds, const std::optional<double>& printed) {
  return time_column(known("%.1f", seconds ? std::optional(1e6 * *seconds) : std::nullopt), printed);
}

std::string ratio_column(const std::optional<double>& value, const std::optional<double>& printed) {
  return column(11, 8, known("%.3g", value), "(%.3g)", printed);
}

/// Quotient of times that may be unknown.
std::optional<double> ratio(const std::optional<double>& time, const std::optional<double>& over) {
  return time && over ? std::optional(*time / *over) : std::nullopt;
}

}  // namespace

std::string transfer_heading(const std::string& row) {
  std::string text =
      "CPU: the computation of the row on one core (Serial), and its ratios to compute and total; -: not "
      "measured, or of a failed row\n" +
      row;
  char heading[64];
  for (const char* time : {"H2D", "compute", "D2H", "total", "CPU"}) {
    std::snprintf(heading, sizeof heading, " %10s %-10s", time, "");
    text += heading;
  }
  for (const char* over : {"CPU/compute", "CPU/total"}) {
    std::snprintf(heading, sizeof heading, " %11s %-8s", over, "");
    text += heading;
  }
  std::snprintf(heading, sizeof heading, " %-26s  error\n", "95 % of the total");
  return text + heading;
}

std::string transfer_row(const std::string& row, const Record& record,
                         const std::optional<PrintedTimes>& printed, const std::optional<double>& core) {
  const auto of = [&](double PrintedTimes::*part) {
    return printed ? std::optional(*printed.*part) : std::nullopt;
  };
  const bool passed = record.passed();
  const auto part = [&](const char* name) {
    return passed ? std::optional(run::median(record.parts.at(name))) : std::nullopt;
  };
  const std::optional<double> printed_core = printed ? printed->cpu : std::nullopt;
  const std::optional<double> total = passed ? std::optional(run::median(record.samples)) : std::nullopt;
  char end[64];
  std::snprintf(end, sizeof end, " %-26s  %.3g  %s\n", interval_text(record, 1e6, 1).c_str(), record.error,
                passed ? "passed" : failed_text);
  return row + time_column(part("h2d"), of(&PrintedTimes::h2d)) +
         time_column(part("compute"), of(&PrintedTimes::compute)) +
         time_column(part("d2h"), of(&PrintedTimes::d2h)) +
         time_column(median_text(record, 1e6, 1), of(&PrintedTimes::total)) +
         time_column(core, printed_core) +
         ratio_column(ratio(core, part("compute")), ratio(printed_core, of(&PrintedTimes::compute))) +
         ratio_column(ratio(core, total), ratio(printed_core, of(&PrintedTimes::total))) + end;
}

}  // namespace drogue::perf
