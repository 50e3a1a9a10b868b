#include "perf/measure/record.hpp"

#include "common/run/files/atomic_file.hpp"
#include "common/run/result_document.hpp"
#include "common/run/statistics.hpp"
#include "perf/memory/memory.hpp"

namespace drogue::perf {

nlohmann::json provenance(const device::DeviceFacts& device) {
  const run::ResultDocument facts = run::new_result("drogue-perf", "");
  return {{"version", facts.version},
          {"git", facts.git},
          {"compiler", facts.provenance.compiler},
          {"flags", facts.provenance.flags},
          {"kokkos", device.kokkos_version},
          {"cpu", facts.provenance.cpu},
          {"gpu", device.gpu},
          {"driver", device.driver},
          {"threads", device.threads},
          {"date", facts.provenance.date}};
}

nlohmann::json provenance_of(const nlohmann::json& result) {
  const nlohmann::json& from = result["provenance"];
  nlohmann::json facts = provenance({.kokkos_version = from.value("kokkos", device::kokkos_version()),
                                     .gpu = from.value("gpu", ""),
                                     .driver = from.value("driver", ""),
                                     .threads = result["threads"].get<int>()});
  for (const char* of_build : {"version", "git"})
    if (result.contains(of_build)) facts[of_build] = result[of_build];
  for (const char* of_build : {"compiler", "flags", "cpu"})
    if (from.contains(of_build)) facts[of_build] = from[of_build];
  return facts;
}

nlohmann::json to_json(const Record& record, const nlohmann::json& provenance, const nlohmann::json& facts) {
  nlohmann::json json = {{"schema", "drogue.perf/1"},
                         {"case", record.name},
                         {"unit", "s per " + record.unit_of_work},
                         {"bound", record.bound},
                         {"samples", record.samples},
                         {"median", nullptr},
                         {"interval", nullptr},
                         {"error", record.error},
                         {"check", record.passed() ? "passed" : "failed"},
                         {"provenance", provenance}};
  if (!record.samples.empty()) {
    const run::MedianInterval time = run::median_interval(record.samples);
    json["median"] = time.median;
    json["interval"] = {time.low, time.high};
  }
  if (!facts.is_null()) json["facts"] = facts;
  if (!record.clocks.empty()) {
    const ClockReading seen = summarize(record.clocks);
    json["clocks"] = {
        {"sm_mhz", seen.sm_mhz}, {"memory_mhz", seen.memory_mhz}, {"throttled", seen.throttled}};
  }
  return json;
}

void write_records(const std::string& file, const std::vector<nlohmann::json>& records) {
  if (file.empty()) return;
  std::string lines;
  for (const nlohmann::json& record : records) lines += record.dump() + "\n";
  run::write_file_atomically(file, lines);
}

const char* verdict(const Record& record) { return record.passed() ? "passed" : "FAILED"; }

void Table::add(const Record& record, const nlohmann::json& provenance, const nlohmann::json& facts) {
  records.push_back(to_json(record, provenance, facts));
  passed = passed && record.passed();
}

const GpuClocks& device_clocks() {
  static const GpuClocks clocks(device_address());
  return clocks;
}

}  // namespace drogue::perf
