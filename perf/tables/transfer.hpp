#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "perf/memory/memory.hpp"
#include "perf/rows/rows.hpp"
#include "perf/tables/tables.hpp"

/// Tables of transfers: copy to the device, compute, copy to the host.
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

/// Row of a table: a case that is measured on the backend from `memory`, and on one core.
struct TransferRow {
  std::string columns;  ///< below the heading of the table
  HostMemory memory;
  std::function<Case(device::Backend, HostMemory)> make;
  nlohmann::json facts;                      ///< besides those of all rows
  std::optional<PrintedTimes> printed = {};  ///< in [Shi]
};

struct TransferTable {
  std::string title, heading;  ///< lines above; names of the first columns
  std::vector<TransferRow> rows;
  bool on_core = true;  ///< rows have a time on one core
  int warm_up, rounds;
};

/// Measures the rows on `backend` and, before, on Serial, where those of one name are measured once, in few
/// rounds; prints them, with the medians of the parts, the times of [Shi] and that of one core, which also
/// are facts of the records. Blocks and throws as `measure`.
Table print_transfers(device::Backend backend, const TransferTable& table, const nlohmann::json& provenance);

}  // namespace drogue::perf
