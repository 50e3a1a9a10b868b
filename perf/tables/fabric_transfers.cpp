#include <chrono>
#include <cstdio>
#include <memory>

#include "common/run/statistics.hpp"
#include "perf/measure/record.hpp"
#include "perf/problems/sheet.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

/// Line of the table: one mesh, one number of steps between two copies.
struct FabricTransfer {
  dissertation::FabricTransferRow printed;
  int substeps;
};

std::vector<FabricTransfer> fabric_transfers_of(bool quick) {
  std::vector<FabricTransfer> rows;
  for (const auto& printed : dissertation::table_5_6)
    for (const int substeps : dissertation::table_5_6_substeps)
      if (!quick || (printed.vertices == 2641 && substeps <= 10)) rows.push_back({printed, substeps});
  return rows;
}

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Case case_of(device::Backend backend, const FabricTransfer& row) {
  struct Run {
    fabric::Parameters p;
    std::unique_ptr<fabric::Solver> solver;
    sheet::State state;
    std::map<std::string, double> parts;
  };
  const auto run = std::make_shared<Run>();
  const int substeps = row.substeps;
  return {"springs-transfers/" + std::string(device::name(backend)) + "/" +
              std::to_string(row.printed.vertices) + "/" + std::to_string(substeps),
          device::needs_device(backend),
          "step",
          backend == device::Backend::cuda ? "latency of copies between host and device"
                                           : "loads of neighbours by the cores",
          [=] {
            run->p = sheet::parameters(row.printed.vertices);
            run->solver = fabric::create_solver(backend, run->p);
            run->solver->set_dt(sheet::default_dt(run->p, *run->solver));
            return Sample{[=] { run->state = sheet::start(run->p); },
                          [=] {
                            fabric::Solver& solver = *run->solver;
                            sheet::State& state = run->state;
                            run->parts = {{"h2d", seconds_of([&] { solver.upload(state.x, state.v); })},
                                          {"compute", seconds_of([&] {
                                             solver.advance(substeps);
                                             static_cast<void>(solver.failure());  // blocks
                                           })},
                                          {"d2h", seconds_of([&] { solver.download(state.x, state.v); })}};
                            return 1L;
                          },
                          [=] { return run->parts; }};
          },
          [=] { return sheet::energy_drift(run->p, run->state); },
          sheet::tolerance(fabric::Integrator::rk4)};
}

nlohmann::json facts_of(device::Backend backend, const FabricTransfer& row, const Record& record) {
  return {{"backend", device::name(backend)},
          {"cells", row.printed.vertices},
          {"substeps", row.substeps},
          {"h2d_s", run::median(record.parts.at("h2d"))},
          {"compute_s", run::median(record.parts.at("compute"))},
          {"d2h_s", run::median(record.parts.at("d2h"))},
          {"thesis",
           {{"cpu_us", row.printed.cpu},
            {"h2d_us", row.printed.h2d},
            {"compute_us", row.printed.compute},
            {"d2h_us", row.printed.d2h},
            {"total_us", row.printed.total}}}};
}

}  // namespace

Table print_fabric_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  const std::vector<FabricTransfer> rows = fabric_transfers_of(quick);
  std::vector<Case> cases;
  for (const FabricTransfer& row : rows) cases.push_back(case_of(backend, row));
  const std::vector<Record> records = measure(cases, warm_up_rounds, kept_rounds(quick));
  std::printf(
      "Table 5.6: a stretched sheet on %s, microseconds from host to host; in brackets [Shi], on a "
      "Quadro 6000\nIts steps take a number of substeps that is not recorded: no ratio to it means anything "
      "without "
      "that number\n"
      "vertices  substeps  H2D            compute            D2H            total              energy "
      "drift\n",
      std::string(device::name(backend)).c_str());
  Table table;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Record& record = records[i];
    const dissertation::FabricTransferRow& printed = rows[i].printed;
    const auto part = [&](const char* name) { return 1e6 * run::median(record.parts.at(name)); };
    std::printf("%8d  %8d  %8.1f (%4.0f)  %8.1f (%5.0f)  %8.1f (%4.0f)  %8.1f (%5.0f)  %.3g  %s\n",
                printed.vertices, rows[i].substeps, part("h2d"), printed.h2d, part("compute"),
                printed.compute, part("d2h"), printed.d2h, 1e6 * run::median(record.samples), printed.total,
                record.error, verdict(record));
    table.add(record, provenance, facts_of(backend, rows[i], record));
  }
  return table;
}

}  // namespace drogue::perf
