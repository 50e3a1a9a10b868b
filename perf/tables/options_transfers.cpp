
#include "perf/problems/puts.hpp"
#include "perf/rows/printed.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/transfer.hpp"

namespace drogue::perf {
namespace {

/// Fewer rounds than elsewhere: a put on the largest meshes takes seconds.
constexpr int options_rounds = 5, options_warm_up_rounds = 1;
/// Largest error of the baseline scheme, of first order, relative to the strike: 4.4e-4 at mesh 128
/// (docs/options-notebook.md).
constexpr double baseline_tolerance(int mesh) { return 4.4e-4 * 128 / mesh; }

/// Largest mesh on which the scheme of [Shi] is measured from either kind of memory: on larger ones a solve
/// takes thousands of times as long as the copies.
constexpr int baseline_largest_pinned_mesh = 1024;

const char* method_name(options::Method method) {
  return method == options::Method::baseline ? "seed" : "pide";
}

/// The baseline scheme with as many steps as intervals, or the `pide` method with a fourth of them, solved on
/// two grids for its error estimate.
Case case_of(device::Backend backend, HostMemory memory, const dissertation::OptionsRow& row,
             options::Method method) {
  const std::string name = "options-transfers/" + std::string(device::name(backend)) + "/" +
                           method_name(method) + "/" + std::to_string(row.options) + "/" +
                           std::to_string(row.mesh) + "/" + perf::name(memory);
  return puts::batch(
      name, backend, memory, static_cast<std::size_t>(row.options),
      {.method = method, .mesh = row.mesh, .time_copies = true},
      method == options::Method::baseline ? baseline_tolerance(row.mesh) : puts::tolerance(row.mesh));
}

}  // namespace

Table print_options_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  TransferTable table{
      .title =
          "Tables 5.7 and 5.8: American puts on " + std::string(device::name(backend)) +
          ", microseconds from host to host; in brackets [Shi], on a\nQuadro 6000, whose first copy holds "
          "the start of CUDA. Method seed is its scheme, pide ours, two solves for a stated error\n",
      .heading = "method  memory    options  mesh",
      .rows = {},
      .warm_up = options_warm_up_rounds,
      .rounds = options_rounds};
  const auto add = [&](const dissertation::OptionsRow& row) {
    if (quick && (row.mesh > 128 || row.options > 64)) return;
    for (const auto method : {options::Method::baseline, options::Method::pide})
      for (const HostMemory memory : host_memories(backend)) {
        if (memory != HostMemory::pageable && method != options::Method::pide &&
            row.mesh > baseline_largest_pinned_mesh)
          continue;
        const char* word = method_name(method);
        table.rows.push_back(
            {.columns = printed("%-6s  %-8s  %7d  %4d", word, name(memory), row.options, row.mesh),
             .memory = memory,
             .make = [=](device::Backend on, HostMemory from) { return case_of(on, from, row, method); },
             .facts = {{"cells", row.options}, {"mesh", row.mesh}, {"method", word}},
             .printed = printed_times(row)});
      }
  };
  for (const auto& row : dissertation::table_5_7) add(row);
  for (const auto& row : dissertation::table_5_8) add(row);
  return print_transfers(backend, table, provenance);
}

}  // namespace drogue::perf
