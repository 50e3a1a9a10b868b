#include "perf/rows/timed_columns.hpp"

#include <cstdio>

#include "common/run/statistics.hpp"
#include "perf/models/scaling.hpp"

namespace drogue::perf {

std::string median_text(const Record& record, double scale, int digits) {
  if (!record.passed()) return failed_text;
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, scale * run::median(record.samples));
  return text;
}

std::string interval_text(const Record& record, double scale, int digits) {
  if (!record.passed()) return "";
  const run::MedianInterval time = run::median_interval(record.samples);
  char text[64];
  std::snprintf(text, sizeof text, "[%.*f .. %.*f]", digits, scale * time.low, digits, scale * time.high);
  return text;
}

std::string scaling_columns(const Record& record, bool weak, int units, const std::optional<double>& of_one) {
  char text[128];
  if (!record.passed()) {
    std::snprintf(text, sizeof text, "%14s  a check is %.2g times its tolerance\n", failed_text,
                  record.error / record.tolerance);
    return text;
  }
  char share[32] = "-";
  if (of_one)
    std::snprintf(share, sizeof share, "%.0f %%",
                  100.0 * efficiency(weak, *of_one, run::median(record.samples), units));
  std::snprintf(text, sizeof text, "%14s  %-28s %11s\n", median_text(record, 1e6, 2).c_str(),
                interval_text(record, 1e6, 2).c_str(), share);
  return text;
}

std::string speed_up_columns(const std::optional<double>& of_one, double time, int units) {
  char gain[32] = "-", share[32] = "-", text[80];
  if (of_one) {
    std::snprintf(gain, sizeof gain, "%.2fx", *of_one / time);
    std::snprintf(share, sizeof share, "%.0f %%", 100.0 * efficiency(false, *of_one, time, units));
  }
  std::snprintf(text, sizeof text, "%9s %11s\n", gain, share);
  return text;
}

}  // namespace drogue::perf
