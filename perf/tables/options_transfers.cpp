#include <cstdio>
#include <vector>

#include "perf/measure/record.hpp"
#include "perf/problems/puts.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/tables.hpp"
#include "perf/tables/transfer.hpp"

namespace drogue::perf {
namespace {

/// Line of a table: the baseline scheme with as many steps as intervals, or the `pide` method with a fourth
/// of them, solved on two grids for its error estimate.
struct OptionsTransfer {
  dissertation::OptionsRow printed;
  options::Method method;
  HostMemory memory;
};

/// Fewer rounds than elsewhere: a put on the largest meshes takes seconds.
constexpr int options_rounds = 5, options_warm_up_rounds = 1;
/// Largest error of the baseline scheme, of first order, relative to the strike: 4.4e-4 at mesh 128
/// (docs/options-notebook.md).
constexpr double baseline_tolerance(int mesh) { return 4.4e-4 * 128 / mesh; }

/// Largest mesh on which the scheme of [Shi] is measured from either kind of memory: on larger ones a solve
/// takes thousands of times as long as the copies.
constexpr int baseline_largest_pinned_mesh = 1024;

std::vector<OptionsTransfer> options_transfers_of(device::Backend backend, bool quick) {
  std::vector<OptionsTransfer> lines;
  const auto add = [&](const dissertation::OptionsRow& row) {
    if (quick && (row.mesh > 128 || row.options > 64)) return;
    for (const auto method : {options::Method::baseline, options::Method::pide})
      for (const HostMemory memory : host_memories(backend))
        if (memory == HostMemory::pageable || method == options::Method::pide ||
            row.mesh <= baseline_largest_pinned_mesh)
          lines.push_back({row, method, memory});
  };
  for (const auto& row : dissertation::table_5_7) add(row);
  for (const auto& row : dissertation::table_5_8) add(row);
  return lines;
}

const char* method_name(options::Method method) {
  return method == options::Method::baseline ? "seed" : "pide";
}

Case case_of(device::Backend backend, const OptionsTransfer& line) {
  const std::string name = "options-transfers/" + std::string(device::name(backend)) + "/" +
                           method_name(line.method) + "/" + std::to_string(line.printed.options) + "/" +
                           std::to_string(line.printed.mesh) + "/" + perf::name(line.memory);
  return puts::batch(name, backend, line.memory, static_cast<std::size_t>(line.printed.options),
                     {.method = line.method, .mesh = line.printed.mesh, .time_copies = true},
                     line.method == options::Method::baseline ? baseline_tolerance(line.printed.mesh)
                                                              : puts::tolerance(line.printed.mesh));
}

}  // namespace

Table print_options_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  const std::vector<OptionsTransfer> lines = options_transfers_of(backend, quick);
  const auto [records, core] =
      measure_transfers(backend, lines, case_of, options_warm_up_rounds, options_rounds);
  std::printf(
      "Tables 5.7 and 5.8: American puts on %s, microseconds from host to host; in brackets [Shi], "
      "on a\nQuadro 6000, whose first copy holds the start of CUDA. Method seed is its scheme, "
      "pide ours, two solves for a stated error\n",
      std::string(device::name(backend)).c_str());
  std::fputs(transfer_heading("method  memory    options  mesh").c_str(), stdout);
  Table table;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const PrintedTimes printed = printed_times(lines[i].printed);
    const char* method = method_name(lines[i].method);
    char name[64];
    std::snprintf(name, sizeof name, "%-6s  %-8s  %7d  %4d", method, perf::name(lines[i].memory),
                  lines[i].printed.options, lines[i].printed.mesh);
    std::fputs(transfer_row(name, records[i], printed, core[i]).c_str(), stdout);
    nlohmann::json facts = transfer_facts(backend, lines[i].memory, records[i], printed, core[i]);
    facts.update({{"cells", lines[i].printed.options}, {"mesh", lines[i].printed.mesh}, {"method", method}});
    table.add(records[i], provenance, facts);
  }
  return table;
}

}  // namespace drogue::perf
