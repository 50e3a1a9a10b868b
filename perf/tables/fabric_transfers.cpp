#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <memory_resource>
#include <optional>
#include <vector>

#include "perf/measure/record.hpp"
#include "perf/measure/timed_parts.hpp"
#include "perf/problems/sheet.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/tables.hpp"
#include "perf/tables/transfer.hpp"

namespace drogue::perf {
namespace {

/// Line of the table: one mesh, one number of steps between two copies, one kind of host memory.
struct FabricTransfer {
  dissertation::FabricTransferRow printed;
  int substeps;
  HostMemory memory;
};

/// Energy drift of up to a hundred steps: five times the largest of
/// docs/evidence/springs-transfers-h100.jsonl.
constexpr double drift_tolerance = 2.5e-10;

std::vector<FabricTransfer> fabric_transfers_of(device::Backend backend, bool quick) {
  std::vector<FabricTransfer> rows;
  for (const HostMemory memory : host_memories(backend))
    for (const auto& printed : dissertation::table_5_6)
      for (const int substeps : dissertation::table_5_6_substeps)
        if (!quick || (printed.vertices == 2641 && substeps <= 10))
          rows.push_back({printed, substeps, memory});
  return rows;
}

Case case_of(device::Backend backend, const FabricTransfer& row) {
  struct Run {
    std::shared_ptr<std::pmr::memory_resource> memory;
    fabric::Parameters p;
    std::unique_ptr<fabric::Solver> solver;
    std::pmr::vector<fabric::Vector> x, v;
    std::map<std::string, double> parts;
  };
  const auto run = std::make_shared<std::optional<Run>>();
  return {
      .name = "springs-transfers/" + std::string(device::name(backend)) + "/" +
              std::to_string(row.printed.vertices) + "/" + std::to_string(row.substeps) +
              (row.memory == HostMemory::pinned ? "/pinned" : ""),
      .on_device = device::needs_device(backend),
      .unit_of_work = "step",
      .bound = transfer_bound(backend, "loads of neighbours by the cores"),
      .prepare =
          [=] {
            const fabric::Parameters p = sheet::parameters(row.printed.vertices);
            const sheet::State start = sheet::start(p);
            const auto memory = host_memory(backend, row.memory);
            run->emplace(Run{.memory = memory,
                             .p = p,
                             .solver = fabric::create_solver(backend, p),
                             .x = {start.x.begin(), start.x.end(), memory.get()},
                             .v = {start.v.begin(), start.v.end(), memory.get()},
                             .parts = {}});
            (*run)->solver->set_dt(sheet::default_dt(p, *(*run)->solver));
            return Sample{[=] {
                            std::ranges::copy(start.x, (*run)->x.begin());
                            std::ranges::copy(start.v, (*run)->v.begin());
                          },
                          [=] {
                            Run& now = **run;
                            now.parts = timed_parts([&] { now.solver->upload(now.x, now.v); },
                                                    [&] {
                                                      now.solver->enqueue_steps(row.substeps);
                                                      static_cast<void>(now.solver->failure());  // blocks
                                                    },
                                                    [&] { now.solver->download(now.x, now.v); });
                            return 1L;
                          },
                          [=] { return (*run)->parts; }};
          },
      .error =
          [=] {
            const Run& now = **run;
            return sheet::energy_drift(now.p, {{now.x.begin(), now.x.end()}, {now.v.begin(), now.v.end()}});
          },
      .tolerance = drift_tolerance};
}

}  // namespace

Table print_fabric_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  const std::vector<FabricTransfer> rows = fabric_transfers_of(backend, quick);
  const auto [records, core] = measure_transfers(backend, rows, case_of, warm_up_rounds, kept_rounds(quick));
  std::printf(
      "Table 5.6: a stretched sheet on %s, microseconds from host to host; in brackets [Shi], on a "
      "Quadro 6000\nIts steps take a number of substeps that is not recorded: no ratio to it means anything "
      "without that number\nThe error is the drift of the energy\n",
      std::string(device::name(backend)).c_str());
  std::fputs(transfer_heading("memory    vertices  substeps").c_str(), stdout);
  Table table;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const PrintedTimes printed = printed_times(rows[i].printed);
    char name[64];
    std::snprintf(name, sizeof name, "%-8s  %8d  %8d", perf::name(rows[i].memory), rows[i].printed.vertices,
                  rows[i].substeps);
    std::fputs(transfer_row(name, records[i], printed, core[i]).c_str(), stdout);
    nlohmann::json facts = transfer_facts(backend, rows[i].memory, records[i], printed, core[i]);
    facts.update({{"cells", rows[i].printed.vertices}, {"substeps", rows[i].substeps}});
    table.add(records[i], provenance, facts);
  }
  return table;
}

}  // namespace drogue::perf
