#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kernels/device/backend.hpp"
#include "perf/measure/measurement.hpp"
#include "perf/memory/host_memory.hpp"

/// Rows of the tables of transfers: copy to the device, compute, copy to the host.
namespace drogue::perf {

/// Kinds of memory that differ for a backend: a host backend copies within the host. Does not throw.
std::vector<HostMemory> host_memories(device::Backend backend);

/// Limiting resource of copies around the work of a backend, in words; `on_host` that of the work on a host.
std::string transfer_bound(device::Backend backend, const std::string& on_host);

/// Times that [Shi] prints, us; of the CPU 0 where none is printed.
struct PrintedTimes {
  double cpu, h2d, compute, d2h, total;
};

/// Times of a row of a table of [Shi].
template <class Row>
PrintedTimes printed_times(const Row& row) {
  return {row.cpu, row.h2d, row.compute, row.d2h, row.total};
}

/// Facts of all rows of transfers: backend, memory, medians of the parts and, if given, the times of [Shi].
/// Does not throw.
nlohmann::json transfer_facts(device::Backend backend, HostMemory memory, const Record& record,
                              const std::optional<PrintedTimes>& printed);

/// Prints the heading of the columns of `print_transfer` behind that of the names of rows.
void print_transfer_heading(const std::string& row);

/// Prints a row: medians of the parts and of their sum, us, each with the time of [Shi] in brackets, as its
/// time on a CPU, the interval of the sum, error and verdict.
void print_transfer(const std::string& row, const Record& record, const std::optional<PrintedTimes>& printed);

}  // namespace drogue::perf
