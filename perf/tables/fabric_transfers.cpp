#include <algorithm>
#include <map>
#include <memory>
#include <memory_resource>
#include <vector>

#include "perf/measure/parts.hpp"
#include "perf/problems/sheet.hpp"
#include "perf/rows/printed.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/transfer.hpp"

namespace drogue::perf {
namespace {

/// Energy drift of up to a hundred steps: five times the largest of
/// docs/evidence/springs-transfers-h100.jsonl.
constexpr double drift_tolerance = 2.5e-10;

Case case_of(device::Backend backend, HostMemory memory, int vertices, int substeps) {
  struct Run {
    std::shared_ptr<std::pmr::memory_resource> memory;
    fabric::Parameters p;
    std::unique_ptr<fabric::Solver> solver;
    std::pmr::vector<fabric::Vector> x, v;
    std::map<std::string, double> parts;
  };
  return {.name = "springs-transfers/" + std::string(device::name(backend)) + "/" + std::to_string(vertices) +
                  "/" + std::to_string(substeps) + (memory == HostMemory::pinned ? "/pinned" : ""),
          .backend = backend,
          .unit_of_work = "step",
          .bound = transfer_bound(backend, "loads of neighbours by the cores"),
          .tolerance = drift_tolerance,
          .prepare = [=] {
            const fabric::Parameters p = sheet::parameters(vertices);
            const sheet::State start = sheet::start(p);
            const auto resource = host_memory(backend, memory);
            const auto run = std::make_shared<Run>(Run{.memory = resource,
                                                       .p = p,
                                                       .solver = fabric::create_solver(backend, p),
                                                       .x = {start.x.begin(), start.x.end(), resource.get()},
                                                       .v = {start.v.begin(), start.v.end(), resource.get()},
                                                       .parts = {}});
            run->solver->set_dt(sheet::default_dt(p, *run->solver));
            return Sample{[=] {
                            std::ranges::copy(start.x, run->x.begin());
                            std::ranges::copy(start.v, run->v.begin());
                          },
                          [=] {
                            run->parts = timed_parts([&] { run->solver->upload(run->x, run->v); },
                                                     [&] {
                                                       run->solver->enqueue_steps(substeps);
                                                       static_cast<void>(run->solver->failure());  // blocks
                                                     },
                                                     [&] { run->solver->download(run->x, run->v); });
                            return 1L;
                          },
                          [=] {
                            return sheet::energy_drift(
                                run->p, {{run->x.begin(), run->x.end()}, {run->v.begin(), run->v.end()}});
                          },
                          [=] { return run->parts; }};
          }};
}

}  // namespace

Table print_fabric_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  TransferTable table{
      .title =
          "Table 5.6: a stretched sheet on " + std::string(device::name(backend)) +
          ", microseconds from host to host; in brackets [Shi], on a Quadro 6000\nIts steps take a number "
          "of substeps that is not recorded: no ratio to it means anything without that number\nThe error "
          "is the drift of the energy\n",
      .heading = "memory    vertices  substeps",
      .rows = {},
      .warm_up = warm_up_rounds,
      .rounds = kept_rounds(quick)};
  for (const HostMemory memory : host_memories(backend))
    for (const auto& row : dissertation::table_5_6)
      for (const int substeps : dissertation::table_5_6_substeps) {
        if (quick && (row.vertices != 2641 || substeps > 10)) continue;
        table.rows.push_back(
            {.columns = printed("%-8s  %8d  %8d", name(memory), row.vertices, substeps),
             .memory = memory,
             .make = [=](device::Backend on,
                         HostMemory from) { return case_of(on, from, row.vertices, substeps); },
             .facts = {{"cells", row.vertices}, {"substeps", substeps}},
             .printed = printed_times(row)});
      }
  return print_transfers(backend, table, provenance);
}

}  // namespace drogue::perf
