#include "perf/tables/transfer.hpp"

#include <algorithm>
#include <cstdio>

#include "common/run/statistics.hpp"
#include "perf/measure/record.hpp"

namespace drogue::perf {
namespace {

/// Rounds on one core, after one of warm-up: a core takes seconds for what a GPU does in milliseconds.
constexpr int core_rounds = 3;

/// Prints a column: a value by `format`, `-` if it is not known, and behind it that of [Shi].
void print_column(int width, int printed_width, const char* format, const std::optional<double>& value,
                  const char* printed_format, const std::optional<double>& printed) {
  char text[32] = "-", brackets[32] = "";
  if (value) std::snprintf(text, sizeof text, format, *value);
  if (printed) std::snprintf(brackets, sizeof brackets, printed_format, *printed);
  std::printf(" %*s %-*s", width, text, printed_width, brackets);
}

void print_time(const std::optional<double>& microseconds, const std::optional<double>& printed) {
  print_column(10, 10, "%.1f", microseconds, "(%.0f)", printed);
}

void print_ratio(const std::optional<double>& value, const std::optional<double>& printed) {
  print_column(11, 8, "%.3g", value, "(%.3g)", printed);
}

/// Quotient of times of which the first may be unknown.
std::optional<double> ratio(const std::optional<double>& time, double over) {
  return time ? std::optional(*time / over) : std::nullopt;
}

}  // namespace

std::vector<HostMemory> host_memories(device::Backend backend) {
  if (device::needs_device(backend)) return {HostMemory::pageable, HostMemory::pinned};
  return {HostMemory::pageable};
}

std::string transfer_bound(device::Backend backend, const std::string& on_host) {
  return device::needs_device(backend) ? "latency of copies between host and device" : on_host;
}

Transfers measure_transfers(device::Backend backend, const std::vector<Case>& cases,
                            const std::vector<Case>& on_core, int warm_up, int rounds) {
  // First, since a signal ends a measurement with the samples that there are.
  const bool is_core = backend == device::Backend::serial;
  std::vector<Record> measured_on_core;
  if (!is_core && !device::why_unavailable(device::Backend::serial)) {
    std::vector<Case> distinct;
    for (const Case& row : on_core)
      if (std::ranges::find(distinct, row.name, &Case::name) == distinct.end()) distinct.push_back(row);
    measured_on_core = measure(distinct, 1, core_rounds);
  }
  Transfers measured = {measure(cases, warm_up, rounds), std::vector<std::optional<double>>(on_core.size())};
  const std::vector<Record>& known = is_core ? measured.records : measured_on_core;
  for (std::size_t i = 0; i < on_core.size(); ++i) {
    const auto record = std::ranges::find(known, on_core[i].name, &Record::name);
    if (record != known.end() && record->passed())
      measured.core[i] = run::median(record->parts.at("compute"));
  }
  return measured;
}

nlohmann::json transfer_facts(device::Backend backend, HostMemory memory, const Record& record,
                              const std::optional<PrintedTimes>& printed, const std::optional<double>& core) {
  nlohmann::json facts = {{"backend", device::name(backend)},
                          {"memory", name(memory)},
                          {"h2d_s", run::median(record.parts.at("h2d"))},
                          {"compute_s", run::median(record.parts.at("compute"))},
                          {"d2h_s", run::median(record.parts.at("d2h"))}};
  if (core) facts["cpu_s"] = *core;
  if (printed)
    facts["thesis"] = {{"h2d_us", printed->h2d},
                       {"compute_us", printed->compute},
                       {"d2h_us", printed->d2h},
                       {"total_us", printed->total}};
  if (printed && printed->cpu) facts["thesis"]["cpu_us"] = *printed->cpu;
  return facts;
}

void print_transfer_heading(const std::string& row) {
  std::printf(
      "CPU: the computation of the row on one core (Serial), and its ratios to compute and total; -: not "
      "measured\n%s",
      row.c_str());
  for (const char* time : {"H2D", "compute", "D2H", "total", "CPU"}) std::printf(" %10s %-10s", time, "");
  for (const char* over : {"CPU/compute", "CPU/total"}) std::printf(" %11s %-8s", over, "");
  std::printf(" %-26s  error\n", "95 % of the total");
}

void print_transfer(const std::string& row, const Record& record, const std::optional<PrintedTimes>& printed,
                    const std::optional<double>& core) {
  const auto of = [&](double PrintedTimes::*part) {
    return printed ? std::optional(*printed.*part) : std::nullopt;
  };
  const auto part = [&](const char* name) { return run::median(record.parts.at(name)); };
  const std::optional<double> printed_core = printed ? printed->cpu : std::nullopt;
  const run::MedianInterval total = run::median_interval(record.samples);
  std::printf("%s", row.c_str());
  print_time(1e6 * part("h2d"), of(&PrintedTimes::h2d));
  print_time(1e6 * part("compute"), of(&PrintedTimes::compute));
  print_time(1e6 * part("d2h"), of(&PrintedTimes::d2h));
  print_time(1e6 * total.median, of(&PrintedTimes::total));
  print_time(ratio(core, 1e-6), printed_core);
  print_ratio(ratio(core, part("compute")), printed ? ratio(printed_core, printed->compute) : std::nullopt);
  print_ratio(ratio(core, total.median), printed ? ratio(printed_core, printed->total) : std::nullopt);
  char interval[64];
  std::snprintf(interval, sizeof interval, "[%.1f .. %.1f]", 1e6 * total.low, 1e6 * total.high);
  std::printf(" %-26s  %.3g  %s\n", interval, record.error, verdict(record));
}

}  // namespace drogue::perf
