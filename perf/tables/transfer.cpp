#include "perf/tables/transfer.hpp"

#include <algorithm>

#include "common/run/statistics.hpp"
#include "perf/measure/device_clocks.hpp"

namespace drogue::perf {
namespace {

/// Rounds on one core, after one of warm-up: a core takes seconds for what a GPU does in milliseconds.
constexpr int core_rounds = 3;

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
  Transfers measured = {measure(cases, warm_up, rounds, {&device_clocks()}),
                        std::vector<std::optional<double>>(on_core.size())};
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

}  // namespace drogue::perf
