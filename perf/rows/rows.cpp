#include "perf/rows/rows.hpp"

#include <cmath>

#include "common/run/statistics.hpp"
#include "perf/models/rank_correlation.hpp"
#include "perf/models/scaling.hpp"
#include "perf/rows/printed.hpp"

namespace drogue::perf {

std::string median_text(const Record& record, double scale, int digits) {
  return record.passed() ? printed("%.*f", digits, scale * run::median(record.samples)) : failed_text;
}

std::string interval_text(const Record& record, double scale, int digits) {
  if (!record.passed()) return "";
  const run::MedianInterval time = run::median_interval(record.samples);
  return printed("[%.*f .. %.*f]", digits, scale * time.low, digits, scale * time.high);
}

namespace {

/// Columns of messages behind the time of a step, s.
std::string message_columns(const MessageTimes& messages, double step) {
  return printed(" %12.2f %7.0f %% %12.2f %12s", 1e6 * messages.measured, 100.0 * messages.measured / step,
                 1e6 * messages.modelled,
                 messages.step ? printed("%.2f", 1e6 * *messages.step).c_str() : "-");
}

}  // namespace

std::string scaling_columns(const Record& record, bool weak, int units, const std::optional<double>& of_one,
                            const std::optional<MessageTimes>& messages) {
  if (!record.passed())
    return printed("%14s  a check is %.2g times its tolerance\n", failed_text,
                   record.error / record.tolerance);
  const std::string share =
      of_one ? printed("%.0f %%", 100.0 * efficiency(weak, *of_one, run::median(record.samples), units))
             : "-";
  return printed("%14s  %-28s %11s%s\n", median_text(record, 1e6, 2).c_str(),
                 interval_text(record, 1e6, 2).c_str(), share.c_str(),
                 messages ? message_columns(*messages, run::median(record.samples)).c_str() : "");
}

std::string speed_up_columns(const std::optional<double>& of_one, double time, int units) {
  if (!of_one) return printed("%9s %11s\n", "-", "-");
  return printed("%8.2fx %9.0f %%\n", *of_one / time, 100.0 * efficiency(false, *of_one, time, units));
}

namespace {

/// A time, and behind it that of [Shi], if there is one.
std::string time_column(const std::string& text, const std::optional<double>& theirs) {
  return printed(" %10s %-10s", text.c_str(), theirs ? printed("(%.0f)", *theirs).c_str() : "");
}

std::string time_column(const std::optional<double>& seconds, const std::optional<double>& theirs) {
  return time_column(seconds ? printed("%.1f", 1e6 * *seconds) : "-", theirs);
}

std::string ratio_column(const std::optional<double>& value, const std::optional<double>& theirs) {
  return printed(" %11s %-8s", value ? printed("%.3g", *value).c_str() : "-",
                 theirs ? printed("(%.3g)", *theirs).c_str() : "");
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
  for (const char* time : {"H2D", "compute", "D2H", "total", "CPU"}) text += printed(" %10s %-10s", time, "");
  for (const char* over : {"CPU/compute", "CPU/total"}) text += printed(" %11s %-8s", over, "");
  return text + printed(" %-26s  error\n", "95 % of the total");
}

std::string transfer_row(const std::string& row, const Record& record,
                         const std::optional<PrintedTimes>& theirs, const std::optional<double>& core) {
  const auto of = [&](double PrintedTimes::*part) {
    return theirs ? std::optional(*theirs.*part) : std::nullopt;
  };
  const bool passed = record.passed();
  const auto part = [&](const char* name) {
    return passed ? std::optional(run::median(record.parts.at(name))) : std::nullopt;
  };
  const std::optional<double> their_core = theirs ? theirs->cpu : std::nullopt;
  const std::optional<double> total = passed ? std::optional(run::median(record.samples)) : std::nullopt;
  return row + time_column(part("h2d"), of(&PrintedTimes::h2d)) +
         time_column(part("compute"), of(&PrintedTimes::compute)) +
         time_column(part("d2h"), of(&PrintedTimes::d2h)) +
         time_column(median_text(record, 1e6, 1), of(&PrintedTimes::total)) + time_column(core, their_core) +
         ratio_column(ratio(core, part("compute")), ratio(their_core, of(&PrintedTimes::compute))) +
         ratio_column(ratio(core, total), ratio(their_core, of(&PrintedTimes::total))) +
         printed(" %-26s  %.3g  %s\n", interval_text(record, 1e6, 1).c_str(), record.error,
                 passed ? "passed" : failed_text);
}

namespace {

/// States whether the order of the speeds is that of the occupancies.
std::string explanation(const std::vector<const Record*>& records, const std::vector<double>& occupancies) {
  std::vector<double> known, speeds;
  for (std::size_t k = 0; k < records.size(); ++k) {
    if (!records[k]->passed() || records[k]->samples.empty()) continue;
    known.push_back(occupancies[k]);
    speeds.push_back(1.0 / run::median(records[k]->samples));
  }
  if (speeds.size() < 2) return "";
  const RankCorrelation found = rank_correlation(known, speeds);
  if (std::isnan(found.rho)) return "  one occupancy: it explains nothing";
  return printed("  rho %+.2f, p %.3f: occupancy %s the order", found.rho, found.probability,
                 found.probability <= 0.05 ? "explains" : "does not explain");
}

}  // namespace

std::string block_row(std::int64_t cells, const std::vector<const Record*>& records,
                      const std::vector<double>& occupancies) {
  std::string row = printed("%10lld", static_cast<long long>(cells));
  for (const Record* record : records) row += printed("%12s", median_text(*record, 1e6, 2).c_str());
  return row + explanation(records, occupancies);
}

}  // namespace drogue::perf
