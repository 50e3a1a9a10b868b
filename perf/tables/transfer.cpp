#include "perf/tables/transfer.hpp"

#include <cstdio>

#include "common/run/statistics.hpp"
#include "perf/measure/record.hpp"

namespace drogue::perf {
namespace {

void print_part(double seconds, const std::optional<double>& printed) {
  char brackets[32] = "";
  if (printed) std::snprintf(brackets, sizeof brackets, "(%.0f)", *printed);
  std::printf(" %10.1f %-10s", 1e6 * seconds, brackets);
}

}  // namespace

std::vector<HostMemory> host_memories(device::Backend backend) {
  if (device::needs_device(backend)) return {HostMemory::pageable, HostMemory::pinned};
  return {HostMemory::pageable};
}

std::string transfer_bound(device::Backend backend, const std::string& on_host) {
  return device::needs_device(backend) ? "latency of copies between host and device" : on_host;
}

nlohmann::json transfer_facts(device::Backend backend, HostMemory memory, const Record& record,
                              const std::optional<PrintedTimes>& printed) {
  nlohmann::json facts = {{"backend", device::name(backend)},
                          {"memory", name(memory)},
                          {"h2d_s", run::median(record.parts.at("h2d"))},
                          {"compute_s", run::median(record.parts.at("compute"))},
                          {"d2h_s", run::median(record.parts.at("d2h"))}};
  if (printed) {
    facts["thesis"] = {{"h2d_us", printed->h2d},
                       {"compute_us", printed->compute},
                       {"d2h_us", printed->d2h},
                       {"total_us", printed->total}};
    if (printed->cpu > 0.0) facts["thesis"]["cpu_us"] = printed->cpu;
  }
  return facts;
}

void print_transfer_heading(const std::string& row) {
  std::printf("%s %12s %10s %-10s %10s %-10s %10s %-10s %10s %-10s %-26s  error\n", row.c_str(), "(CPU)",
              "H2D", "", "compute", "", "D2H", "", "total", "", "95 % of the total");
}

void print_transfer(const std::string& row, const Record& record,
                    const std::optional<PrintedTimes>& printed) {
  const auto of = [&](double PrintedTimes::*part) {
    return printed ? std::optional(*printed.*part) : std::nullopt;
  };
  const run::MedianInterval total = run::median_interval(record.samples);
  char cpu[32] = "";
  if (printed && printed->cpu > 0.0) std::snprintf(cpu, sizeof cpu, "(%.0f)", printed->cpu);
  std::printf("%s %12s", row.c_str(), cpu);
  print_part(run::median(record.parts.at("h2d")), of(&PrintedTimes::h2d));
  print_part(run::median(record.parts.at("compute")), of(&PrintedTimes::compute));
  print_part(run::median(record.parts.at("d2h")), of(&PrintedTimes::d2h));
  print_part(total.median, of(&PrintedTimes::total));
  char interval[64];
  std::snprintf(interval, sizeof interval, "[%.1f .. %.1f]", 1e6 * total.low, 1e6 * total.high);
  std::printf(" %-26s  %.3g  %s\n", interval, record.error, verdict(record));
}

}  // namespace drogue::perf
