#include "perf/models/occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "kernels/gas/tile/team_shape.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

nlohmann::json facts_of(const Architecture& on, const Block& block, const Occupancy& o) {
  return {{"architecture", on.name},
          {"block", block.threads},
          {"registers", block.registers},
          {"shared_bytes", block.shared_bytes},
          {"blocks_by_registers", o.by_registers},
          {"blocks_by_shared_memory", o.by_shared_memory},
          {"blocks_by_threads", o.by_threads},
          {"blocks_by_limit", o.by_limit},
          {"blocks", o.blocks},
          {"threads_sm", o.threads},
          {"threads_device", o.device_threads},
          {"occupancy", o.occupancy}};
}

/// Record without samples; its error is the number of mismatches.
Record untimed(const Architecture& on, const Block& block, const std::string& kernel, int mismatches) {
  Record record;
  record.name = "occupancy/" + on.name + "/" + std::to_string(block.threads) + kernel;
  record.unit_of_work = "step";
  record.bound = "what a multiprocessor holds";
  record.error = mismatches;
  return record;
}

nlohmann::json printed_facts(const dissertation::OccupancyRow& row) {
  return {{"shared_bytes", row.shared_bytes},
          {"blocks_by_registers", row.by_registers},
          {"blocks_by_shared_memory", row.by_shared_memory},
          {"blocks_by_limit", row.by_limit},
          {"blocks", row.blocks},
          {"threads_sm", row.threads},
          {"threads_device", row.device_threads},
          {"occupancy_percent", row.percent}};
}

/// Number of entries of a printed row that differ from the model.
int differences(const dissertation::OccupancyRow& printed, const Block& block, const Occupancy& o) {
  int mismatches = 0;
  for (const auto& [ours, theirs] : {std::pair{block.shared_bytes, printed.shared_bytes},
                                     {o.by_registers, printed.by_registers},
                                     {o.by_shared_memory, printed.by_shared_memory},
                                     {o.by_limit, printed.by_limit},
                                     {o.blocks, printed.blocks},
                                     {o.threads, printed.threads},
                                     {o.device_threads, printed.device_threads}})
    mismatches += ours == theirs ? 0 : 1;
  return mismatches + (std::round(1000.0 * o.occupancy) == std::round(10.0 * printed.percent) ? 0 : 1);
}

void print_table_4_2(Table& table, const nlohmann::json& provenance) {
  const Architecture on = fermi();
  std::printf(
      "Table 4.2: the flux kernel of [Shi] on compute capability 2.0, %d registers per thread;\n"
      "computed (printed)\n\n"
      "block  shared bytes    by registers  by shared  by limit  blocks  threads/SM  threads/device    %% "
      "of the threads\n",
      dissertation::flux_registers);
  for (const dissertation::OccupancyRow& printed : dissertation::table_4_2) {
    const Block block{printed.block, dissertation::flux_registers,
                      dissertation::flux_shared_bytes(printed.block)};
    const Occupancy o = occupancy(on, block);
    const Record record = untimed(on, block, "", differences(printed, block, o));
    std::printf(
        "%5d  %5d (%5d)   %6d (%2d)   %4d (%2d)  %3d (%d)  %3d (%d)   %3d (%3d)     %4d (%4d)     %4.1f "
        "(%4.1f)%s\n",
        block.threads, block.shared_bytes, printed.shared_bytes, o.by_registers, printed.by_registers,
        o.by_shared_memory, printed.by_shared_memory, o.by_limit, printed.by_limit, o.blocks, printed.blocks,
        o.threads, printed.threads, o.device_threads, printed.device_threads, 100.0 * o.occupancy,
        printed.percent, record.passed() ? "" : "  FAILED");
    nlohmann::json facts = facts_of(on, block, o);
    facts["thesis"] = printed_facts(printed);
    table.add(record, provenance, facts);
  }
}

/// Launch configuration of a step kernel.
struct StepKernel {
  int team, slots;
  int registers;    ///< largest number per thread under the launch bounds
  int least_teams;  ///< resident teams that the launch bounds require
  const char* name;
};

std::vector<StepKernel> step_kernels() {
  std::vector<StepKernel> kernels;
  for (const int team : {32, 64, 96, 128, 192, 256, 384, 512}) {
    const bool small = team <= gas::default_team;
    kernels.push_back({team, gas::fitting_slots(gas::device_rows, team, team), small ? 168 : 128,
                       small ? gas::default_teams : gas::largest_teams, ""});
  }
  kernels.push_back({gas::default_team, gas::largest_tile, 128, gas::dense_teams, "/large-mesh"});
  return kernels;
}

void print_step_kernels(Table& table, const nlohmann::json& provenance) {
  const Architecture on = hopper();
  std::printf(
      "\nThe fused step of drogue-gas on %s, %d multiprocessors; the last row is that of %lld cells and "
      "more\n\n"
      "block  slots  registers  shared bytes  by registers  by shared  by threads  by limit  blocks  "
      "threads/SM  "
      "threads/device    %% of the threads\n",
      on.name.c_str(), on.multiprocessors, static_cast<long long>(gas::large_mesh));
  for (const StepKernel& kernel : step_kernels()) {
    const Block block{kernel.team, kernel.registers,
                      gas::shared_bytes(gas::device_rows, kernel.slots, kernel.team)};
    const Occupancy o = occupancy(on, block);
    const Record record = untimed(on, block, kernel.name, std::max(0, kernel.least_teams - o.blocks));
    std::printf("%5d  %5d  %9d  %12d  %12d  %9d  %10d  %8d  %6d  %10d  %14d  %5.1f%s\n", block.threads,
                kernel.slots, block.registers, block.shared_bytes, o.by_registers, o.by_shared_memory,
                o.by_threads, o.by_limit, o.blocks, o.threads, o.device_threads, 100.0 * o.occupancy,
                record.passed() ? "" : "  FAILED");
    nlohmann::json facts = facts_of(on, block, o);
    facts["slots"] = kernel.slots;
    facts["least_blocks"] = kernel.least_teams;
    table.add(record, provenance, facts);
  }
}

}  // namespace

Table print_occupancy(const nlohmann::json& provenance) {
  Table table;
  print_table_4_2(table, provenance);
  print_step_kernels(table, provenance);
  return table;
}

}  // namespace drogue::perf
