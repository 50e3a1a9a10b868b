#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <memory_resource>
#include <optional>
#include <vector>

#include "perf/measure/record.hpp"
#include "perf/measure/timed_parts.hpp"
#include "perf/problems/baseline_case.hpp"
#include "perf/problems/sod.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/tables.hpp"
#include "perf/tables/transfer.hpp"

namespace drogue::perf {
namespace {

/// Line of the table: one mesh, one kind of host memory, the baseline or our solver.
struct GasTransfer {
  dissertation::TransferRow printed;
  HostMemory memory;
  bool ours;
  [[nodiscard]] const char* method() const { return ours ? "ours" : "seed"; }
};

std::vector<GasTransfer> gas_transfers_of(device::Backend backend, bool quick) {
  std::vector<GasTransfer> rows;
  for (const bool ours : {false, true})
    for (const HostMemory memory : host_memories(backend))
      for (const dissertation::TransferRow& printed : dissertation::table_5_5)
        if (!quick || printed.cells == 1024 || printed.cells == 8192) rows.push_back({printed, memory, ours});
  return rows;
}

/// Case of our solver: the state stays on the device for the steps between two copies.
Case our_case(const std::string& name, const std::string& bound, device::Backend backend,
              const gas::Parameters& p, HostMemory memory) {
  struct Run {
    std::shared_ptr<std::pmr::memory_resource> memory;
    std::unique_ptr<gas::Solver> solver;
    std::array<std::pmr::vector<double>, 3> fields;
    std::map<std::string, double> parts;
  };
  const auto run = std::make_shared<std::optional<Run>>();
  return {.name = name,
          .on_device = device::needs_device(backend),
          .unit_of_work = "step",
          .bound = bound,
          .prepare =
              [=] {
                const sod::Fields start = sod::start(p);
                const auto resource = host_memory(backend, memory);
                const auto copy = [&](std::size_t k) {
                  return std::pmr::vector<double>(start[k].begin(), start[k].end(), resource.get());
                };
                run->emplace(Run{resource, gas::create_solver(backend, p), {copy(0), copy(1), copy(2)}, {}});
                return Sample{[=] {
                                for (std::size_t k = 0; k < 3; ++k)
                                  std::ranges::copy(start[k], (*run)->fields[k].begin());
                              },
                              [=] {
                                gas::Solver& solver = *(*run)->solver;
                                auto& [rho, momentum, energy] = (*run)->fields;
                                (*run)->parts = timed_parts(
                                    [&] {
                                      solver.upload(0, {rho, momentum, energy});
                                    },
                                    [&] {
                                      solver.start();
                                      solver.advance(1.0, baseline_steps, 0, {}, {});
                                    },
                                    [&] {
                                      solver.download(0, {rho, momentum, energy});
                                    });
                                return baseline_steps;
                              },
                              [=] { return (*run)->parts; }};
              },
          .error =
              [=] {
                const std::vector<double> rho((*run)->fields[0].begin(), (*run)->fields[0].end());
                return sod::l1_error(p, rho, (*run)->solver->restart_state().time);
              },
          .tolerance = sod::tolerance(p)};
}

Case case_of(device::Backend backend, const GasTransfer& row) {
  gas::Parameters p = sod::parameters(row.printed.cells);
  const std::string name = "gas-transfers/" + std::string(device::name(backend)) + "/" +
                           perf::name(row.memory) + "/" + std::to_string(p.cells) + (row.ours ? "/ours" : "");
  const std::string bound = transfer_bound(backend, "memory and FP64 issue of the cores");
  if (row.ours) return our_case(name, bound, backend, p, row.memory);
  p.pinned = row.memory == HostMemory::pinned;
  return baseline_case(name, bound, backend, p, all_phases);
}

}  // namespace

Table print_gas_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  const std::vector<GasTransfer> rows = gas_transfers_of(backend, quick);
  const auto [records, core] = measure_transfers(backend, rows, case_of, warm_up_rounds, kept_rounds(quick));
  std::printf(
      "Table 5.5: steps of gas on %s, microseconds per step; in brackets [Shi], on a Quadro 6000\nseed: its "
      "scheme (--seed-mode), which copies the state to the device and the fluxes back in each of three "
      "stages\nours: the state stays on the device for %ld steps between two copies\n%s",
      std::string(device::name(backend)).c_str(), baseline_steps,
      device::needs_device(backend) ? ""
                                    : "(a host backend copies within the host, and has no pinned memory)\n");
  std::fputs(transfer_heading("method  memory     cells").c_str(), stdout);
  Table table;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const PrintedTimes printed = printed_times(rows[i].printed);
    char name[64];
    std::snprintf(name, sizeof name, "%-6s  %-8s  %6d", rows[i].method(), perf::name(rows[i].memory),
                  rows[i].printed.cells);
    std::fputs(transfer_row(name, records[i], printed, core[i]).c_str(), stdout);
    nlohmann::json facts = transfer_facts(backend, rows[i].memory, records[i], printed, core[i]);
    facts.update({{"cells", rows[i].printed.cells}, {"method", rows[i].method()}});
    table.add(records[i], provenance, facts);
  }
  return table;
}

}  // namespace drogue::perf
