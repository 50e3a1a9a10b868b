#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "perf/measure/device_clocks.hpp"
#include "perf/measure/record.hpp"
#include "perf/problems/inflation.hpp"
#include "perf/problems/streams.hpp"
#include "perf/tables/tables.hpp"
#include "perf/tables/transfer.hpp"

namespace drogue::perf {
namespace {

/// Line of the table: one grid, one number of steps between two copies, one kind of host memory.
struct ParachuteTransfer {
  std::array<int, 3> cells;
  long steps;
  HostMemory memory;
};

/// Numbers of steps of the flow between two copies: as the programs of [Shi] do it, and as between outputs.
constexpr long steps_between_copies[] = {1, 20};

std::vector<ParachuteTransfer> parachute_transfers_of(device::Backend backend, bool quick) {
  std::vector<std::array<int, 3>> grids = {{12, 12, 24}};
  if (!quick) grids = {{24, 24, 48}};
  if (!quick && device::needs_device(backend)) grids = {{30, 30, 60}, {60, 60, 120}};
  std::vector<ParachuteTransfer> rows;
  for (const HostMemory memory : host_memories(backend))
    for (const std::array<int, 3>& cells : grids)
      for (const long steps : steps_between_copies) rows.push_back({cells, steps, memory});
  return rows;
}

Case case_of(device::Backend backend, const ParachuteTransfer& row, double lead) {
  const auto solver = std::make_shared<std::unique_ptr<coupling::Solver>>();
  const auto problem = std::make_shared<inflation::Problem>();
  return {.name = "parachute-transfers/" + std::string(device::name(backend)) + "/" + name(row.memory) + "/" +
                  streams::text(row.cells) + "/" + std::to_string(row.steps),
          .on_device = device::needs_device(backend),
          .unit_of_work = "step",
          .bound = transfer_bound(backend, "FP64 issue of the cores, for cells and triangles"),
          .prepare =
              [=] {
                *problem = inflation::problem({.cells = row.cells});
                *solver = coupling::create_solver(backend, problem->parameters);
                return inflation::copied_steps(*problem, **solver, lead, row.steps,
                                               host_memory(backend, row.memory));
              },
          .error = [=] { return inflation::imbalance(problem->parameters, **solver); },
          .tolerance = 1e-12};
}

}  // namespace

Table print_parachute_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  const std::vector<ParachuteTransfer> rows = parachute_transfers_of(backend, quick);
  std::vector<Case> cases;
  for (const ParachuteTransfer& row : rows) cases.push_back(case_of(backend, row, quick ? 0.02 : 0.2));
  const std::vector<Record> records = measure(cases, warm_up_rounds, kept_rounds(quick), {&device_clocks()});
  std::printf(
      "A C-9 that opens, with the air around it, on %s, microseconds per step of the flow; [Shi] has no such "
      "table\nThe whole state of cloth and air is copied before and after so many steps. The error is that "
      "of "
      "parachute-flight\n",
      std::string(device::name(backend)).c_str());
  std::fputs(transfer_heading("memory           cells  steps").c_str(), stdout);
  Table table;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string grid = streams::text(rows[i].cells);
    char text[64];
    std::snprintf(text, sizeof text, "%-8s  %12s  %5ld", name(rows[i].memory), grid.c_str(), rows[i].steps);
    std::fputs(transfer_row(text, records[i], std::nullopt, std::nullopt).c_str(), stdout);
    nlohmann::json facts = transfer_facts(backend, rows[i].memory, records[i], std::nullopt, std::nullopt);
    const auto& [nx, ny, nz] = rows[i].cells;
    facts.update(
        {{"cells", static_cast<std::int64_t>(nx) * ny * nz}, {"grid", grid}, {"substeps", rows[i].steps}});
    table.add(records[i], provenance, facts);
  }
  return table;
}

}  // namespace drogue::perf
