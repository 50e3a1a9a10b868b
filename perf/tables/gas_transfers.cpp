#include <cstdio>
#include <memory>

#include "common/run/statistics.hpp"
#include "perf/measure/record.hpp"
#include "perf/problems/sod.hpp"
#include "perf/tables/baseline_case.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

/// Line of the table: one mesh, one kind of host memory.
struct GasTransfer {
  dissertation::TransferRow printed;
  bool pinned;
  [[nodiscard]] const char* memory() const { return pinned ? "pinned" : "pageable"; }
};

std::vector<GasTransfer> gas_transfers_of(device::Backend backend, bool quick) {
  std::vector<GasTransfer> rows;
  for (const bool pinned : {false, true})
    for (const dissertation::TransferRow& printed : dissertation::table_5_5)
      if ((!pinned || backend == device::Backend::cuda) &&
          (!quick || printed.cells == 1024 || printed.cells == 8192))
        rows.push_back({printed, pinned});
  return rows;
}

Case case_of(device::Backend backend, const GasTransfer& row) {
  gas::Parameters p = sod::parameters(row.printed.cells);
  p.pinned = row.pinned;
  return baseline_case("gas-transfers/" + std::string(device::name(backend)) + "/" + row.memory() + "/" +
                           std::to_string(p.cells),
                       backend == device::Backend::cuda ? "latency of copies between host and device"
                                                        : "memory and FP64 issue of the cores",
                       backend, p, [](const gas::PhaseTimes& times) {
                         return std::map<std::string, double>{
                             {"h2d", times.h2d}, {"compute", times.compute}, {"d2h", times.d2h}};
                       });
}

nlohmann::json facts_of(device::Backend backend, const GasTransfer& row, const Record& record) {
  return {{"backend", device::name(backend)},
          {"memory", row.memory()},
          {"cells", row.printed.cells},
          {"h2d_s", run::median(record.parts.at("h2d"))},
          {"compute_s", run::median(record.parts.at("compute"))},
          {"d2h_s", run::median(record.parts.at("d2h"))},
          {"thesis",
           {{"h2d_us", row.printed.h2d},
            {"compute_us", row.printed.compute},
            {"d2h_us", row.printed.d2h},
            {"total_us", row.printed.total}}}};
}

}  // namespace

Table print_gas_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  const std::vector<GasTransfer> rows = gas_transfers_of(backend, quick);
  std::vector<Case> cases;
  for (const GasTransfer& row : rows) cases.push_back(case_of(backend, row));
  const std::vector<Record> records = measure(cases, warm_up_rounds, kept_rounds(quick));
  std::printf(
      "Table 5.5: baseline (--seed-mode) on %s, microseconds per step; in brackets [Shi], on a Quadro "
      "6000\n%s\n"
      "memory     cells         H2D            compute         D2H            total        95 %% interval    "
      "L1 error\n",
      std::string(device::name(backend)).c_str(),
      backend == device::Backend::cuda
          ? ""
          : "(a host backend copies within the host, and has no pinned memory)\n");
  Table table;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Record& record = records[i];
    const dissertation::TransferRow& printed = rows[i].printed;
    const run::MedianInterval total = run::median_interval(record.samples);
    const auto part = [&](const char* name) { return 1e6 * run::median(record.parts.at(name)); };
    std::printf(
        "%-8s  %6d  %8.1f (%3.0f)  %8.1f (%3.0f)  %8.1f (%3.0f)  %8.1f (%4.0f)  [%.1f .. %.1f]  %.3g  %s\n",
        rows[i].memory(), printed.cells, part("h2d"), printed.h2d, part("compute"), printed.compute,
        part("d2h"), printed.d2h, 1e6 * total.median, printed.total, 1e6 * total.low, 1e6 * total.high,
        record.error, verdict(record));
    table.add(record, provenance, facts_of(backend, rows[i], record));
  }
  return table;
}

}  // namespace drogue::perf
