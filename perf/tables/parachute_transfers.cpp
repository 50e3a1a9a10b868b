#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "perf/problems/inflation.hpp"
#include "perf/problems/streams.hpp"
#include "perf/rows/printed.hpp"
#include "perf/tables/transfer.hpp"

namespace drogue::perf {
namespace {

/// Numbers of steps of the flow between two copies: as the programs of [Shi] do it, and as between outputs.
constexpr long steps_between_copies[] = {1, 20};

Case case_of(device::Backend backend, HostMemory memory, const std::array<int, 3>& cells, long steps,
             double lead) {
  return {.name = "parachute-transfers/" + std::string(device::name(backend)) + "/" + name(memory) + "/" +
                  streams::text(cells) + "/" + std::to_string(steps),
          .backend = backend,
          .unit_of_work = "step",
          .bound = transfer_bound(backend, "FP64 issue of the cores, for cells and triangles"),
          .tolerance = inflation::largest_imbalance,
          .prepare = [=] {
            return inflation::copied_steps(backend, inflation::problem({.cells = cells}), lead, steps,
                                           memory);
          }};
}

}  // namespace

Table print_parachute_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  TransferTable table{
      .title =
          "A C-9 that opens, with the air around it, on " + std::string(device::name(backend)) +
          ", microseconds per step of the flow; [Shi] has no such table\nThe whole state of cloth and air "
          "is copied before and after so many steps. The error is that of parachute-flight\n",
      .heading = "memory           cells  steps",
      .rows = {},
      .on_core = false,
      .warm_up = warm_up_rounds,
      .rounds = kept_rounds(quick)};
  std::vector<std::array<int, 3>> grids = {{12, 12, 24}};
  if (!quick) grids = {{24, 24, 48}};
  if (!quick && device::needs_device(backend)) grids = {{30, 30, 60}, {60, 60, 120}};
  for (const HostMemory memory : host_memories(backend))
    for (const std::array<int, 3>& cells : grids)
      for (const long steps : steps_between_copies) {
        const std::string grid = streams::text(cells);
        table.rows.push_back(
            {.columns = printed("%-8s  %12s  %5ld", name(memory), grid.c_str(), steps),
             .memory = memory,
             .make = [=](device::Backend on,
                         HostMemory from) { return case_of(on, from, cells, steps, quick ? 0.02 : 0.2); },
             .facts = {{"cells", static_cast<std::int64_t>(cells[0]) * cells[1] * cells[2]},
                       {"grid", grid},
                       {"substeps", steps}}});
      }
  return print_transfers(backend, table, provenance);
}

}  // namespace drogue::perf
