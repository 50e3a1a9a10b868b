#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kernels/device/runtime.hpp"
#include "perf/measure/measurement.hpp"

/// Records of measurements: JSON, schema drogue.perf/1 (docs/perf-records.md).
namespace drogue::perf {

/// Facts that all records of a process share: the build, the machine and the date. Does not throw.
nlohmann::json provenance(const device::DeviceFacts& device);

/// Those of a run of another program of this build, whose result.json is `result`. Throws
/// nlohmann::json::exception without its provenance.
nlohmann::json provenance_of(const nlohmann::json& result);

/// JSON object of a record; `facts` are further facts for its reader, null for none. The median and interval
/// of a record without samples are null. Does not throw.
nlohmann::json to_json(const Record& record, const nlohmann::json& provenance,
                       const nlohmann::json& facts = nullptr);

/// Writes one JSON line per record, atomically; nothing if `file` is empty. Throws Failure(io_error).
void write_records(const std::string& file, const std::vector<nlohmann::json>& records);

/// "passed" or "FAILED". Does not throw.
const char* verdict(const Record& record);

/// Records of a printed table.
struct Table {
  std::vector<nlohmann::json> records;
  bool passed = true;  ///< all records are within their tolerances

  /// Appends a record as JSON. Does not throw.
  void add(const Record& record, const nlohmann::json& provenance, const nlohmann::json& facts);
};

/// Clocks of the GPU of this process; without readings where there is none. Requires an initialised runtime.
/// Does not throw.
[[nodiscard]] const GpuClocks& device_clocks();

}  // namespace drogue::perf
