#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kernels/device/backend.hpp"
#include "perf/measure/measurement.hpp"
#include "perf/memory/host_memory.hpp"
#include "perf/rows/transfer_row.hpp"

/// Rows of the tables of transfers: copy to the device, compute, copy to the host.
namespace drogue::perf {

/// Kinds of memory that differ for a backend: a host backend copies within the host. Does not throw.
std::vector<HostMemory> host_memories(device::Backend backend);

/// Limiting resource of copies around the work of a backend, in words; `on_host` that of the work on a host.
std::string transfer_bound(device::Backend backend, const std::string& on_host);

/// Times of a row of a table of [Shi], whose `cpu` is 0 where none is printed.
template <class Row>
PrintedTimes printed_times(const Row& row) {
  return {.h2d = row.h2d,
          .compute = row.compute,
          .d2h = row.d2h,
          .total = row.total,
          .cpu = row.cpu > 0.0 ? std::optional(row.cpu) : std::nullopt};
}

/// Measured rows of a table.
struct Transfers {
  std::vector<Record> records;
  /// Medians of the computation on one core, s. Empty: Serial is not compiled in, or the row failed its check
  /// there.
  std::vector<std::optional<double>> core;
};

/// Measures `cases` of `backend`, and before them the same rows on Serial, `on_core`, of which those of one
/// name are measured once, in few rounds. Blocks and throws as `measure`.
Transfers measure_transfers(device::Backend backend, const std::vector<Case>& cases,
                            const std::vector<Case>& on_core, int warm_up, int rounds);

/// Measures rows of which `case_of` makes cases; on Serial they do not differ in their memory.
template <class Row>
Transfers measure_transfers(device::Backend backend, const std::vector<Row>& rows,
                            Case (*case_of)(device::Backend, const Row&), int warm_up, int rounds) {
  std::vector<Case> cases, on_core;
  for (Row row : rows) {
    cases.push_back(case_of(backend, row));
    row.memory = HostMemory::pageable;
    on_core.push_back(case_of(device::Backend::serial, row));
  }
  return measure_transfers(backend, cases, on_core, warm_up, rounds);
}

/// Facts of all rows of transfers: backend, memory, medians of the parts and, if given, the times of [Shi]
/// and that of one core. Does not throw.
nlohmann::json transfer_facts(device::Backend backend, HostMemory memory, const Record& record,
                              const std::optional<PrintedTimes>& printed, const std::optional<double>& core);

}  // namespace drogue::perf
