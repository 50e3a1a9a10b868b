#include "perf/tables/transfer.hpp"

#include <algorithm>
#include <cstdio>

#include "common/run/statistics.hpp"
#include "perf/measure/record.hpp"

namespace drogue::perf {
namespace {

/// Rounds on one core, after one of warm-up: a core takes seconds for what a GPU does in milliseconds.
constexpr int core_rounds = 3;

double median_of(const Record& record, const char* part) { return run::median(record.parts.at(part)); }

nlohmann::json facts_of(device::Backend backend, const TransferRow& row, const Record& record,
                        const std::optional<double>& core) {
  nlohmann::json facts = {{"backend", device::name(backend)},
                          {"memory", name(row.memory)},
                          {"h2d_s", median_of(record, "h2d")},
                          {"compute_s", median_of(record, "compute")},
                          {"d2h_s", median_of(record, "d2h")}};
  if (core) facts["cpu_s"] = *core;
  if (row.printed)
    facts["thesis"] = {{"h2d_us", row.printed->h2d},
                       {"compute_us", row.printed->compute},
                       {"d2h_us", row.printed->d2h},
                       {"total_us", row.printed->total}};
  if (row.printed && row.printed->cpu) facts["thesis"]["cpu_us"] = *row.printed->cpu;
  facts.update(row.facts);
  return facts;
}

}  // namespace

std::vector<HostMemory> host_memories(device::Backend backend) {
  if (device::needs_device(backend)) return {HostMemory::pageable, HostMemory::pinned};
  return {HostMemory::pageable};
}

std::string transfer_bound(device::Backend backend, const std::string& on_host) {
  return device::needs_device(backend) ? "latency of copies between host and device" : on_host;
}

Table print_transfers(device::Backend backend, const TransferTable& table, const nlohmann::json& provenance) {
  const bool is_core = backend == device::Backend::serial;
  std::vector<Case> cases, distinct;
  std::vector<std::string> names_on_core;
  for (const TransferRow& row : table.rows) {
    cases.push_back(row.make(backend, row.memory));
    const Case on_core = row.make(device::Backend::serial, HostMemory::pageable);
    if (std::ranges::find(names_on_core, on_core.name) == names_on_core.end()) distinct.push_back(on_core);
    names_on_core.push_back(on_core.name);
  }
  // On the core first, since a signal ends a measurement with the samples that there are.
  std::vector<Record> known;
  if (table.on_core && !is_core && !device::why_unavailable(device::Backend::serial))
    known = measure(distinct, 1, core_rounds);
  const std::vector<Record> records = measure(cases, table.warm_up, table.rounds, {&device_clocks()});
  if (table.on_core && is_core) known = records;
  std::printf("%s%s", table.title.c_str(), transfer_heading(table.heading).c_str());
  Table result;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const TransferRow& row = table.rows[i];
    const auto on_core = std::ranges::find(known, names_on_core[i], &Record::name);
    std::optional<double> core;
    if (on_core != known.end() && on_core->passed()) core = median_of(*on_core, "compute");
    std::fputs(transfer_row(row.columns, records[i], row.printed, core).c_str(), stdout);
    result.add(records[i], provenance, facts_of(backend, row, records[i], core));
  }
  return result;
}

}  // namespace drogue::perf
