#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kernels/device/runtime.hpp"
#include "perf/measurement.hpp"

/// Records of measurements: JSON, schema drogue.perf/1 (docs/perf.md).
namespace drogue::perf {

/// What all records of a process share: the build, the machine and the date.
nlohmann::json provenance(const device::DeviceFacts& device);

/// A record; `facts` are what its reader needs beside the time, null for none. Without samples its median and
/// interval are null.
nlohmann::json to_json(const Record& record, const nlohmann::json& provenance,
                       const nlohmann::json& facts = nullptr);

/// Writes one JSON line a record, whole or not at all; nothing if `file` is empty. Throws Failure(io_error).
void write_records(const std::string& file, const std::vector<nlohmann::json>& records);

/// "passed" or "FAILED"
const char* verdict(const Record& record);

}  // namespace drogue::perf
