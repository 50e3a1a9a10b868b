#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <memory_resource>
#include <vector>

#include "perf/measure/parts.hpp"
#include "perf/problems/sod.hpp"
#include "perf/rows/printed.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/transfer.hpp"

namespace drogue::perf {
namespace {

/// Case of our solver: the state stays on the device for the steps between two copies.
Case our_case(const std::string& name, const std::string& bound, device::Backend backend,
              const gas::Parameters& p, HostMemory memory) {
  struct Run {
    std::shared_ptr<std::pmr::memory_resource> memory;
    std::unique_ptr<gas::Solver> solver;
    std::array<std::pmr::vector<double>, 3> fields;
    std::map<std::string, double> parts;
  };
  return {.name = name,
          .backend = backend,
          .unit_of_work = "step",
          .bound = bound,
          .tolerance = sod::tolerance(p),
          .prepare = [=] {
            const sod::Fields start = sod::start(p);
            const auto resource = host_memory(backend, memory);
            const auto copy = [&](std::size_t k) {
              return std::pmr::vector<double>(start[k].begin(), start[k].end(), resource.get());
            };
            const auto run = std::make_shared<Run>(
                Run{resource, gas::create_solver(backend, p), {copy(0), copy(1), copy(2)}, {}});
            return Sample{[=] {
                            for (std::size_t k = 0; k < 3; ++k)
                              std::ranges::copy(start[k], run->fields[k].begin());
                          },
                          [=] {
                            auto& [rho, momentum, energy] = run->fields;
                            run->parts = timed_parts(
                                [&] {
                                  run->solver->upload(0, {rho, momentum, energy});
                                },
                                [&] {
                                  run->solver->start();
                                  run->solver->advance(1.0, sod::baseline_steps, 0, {}, {});
                                },
                                [&] {
                                  run->solver->download(0, {rho, momentum, energy});
                                });
                            return sod::baseline_steps;
                          },
                          [=] {
                            const std::vector<double> rho(run->fields[0].begin(), run->fields[0].end());
                            return sod::l1_error(p, rho, run->solver->restart_state().time);
                          },
                          [=] { return run->parts; }};
          }};
}

Case case_of(device::Backend backend, HostMemory memory, int cells, bool ours) {
  gas::Parameters p = sod::parameters(cells);
  const std::string name = "gas-transfers/" + std::string(device::name(backend)) + "/" + perf::name(memory) +
                           "/" + std::to_string(cells) + (ours ? "/ours" : "");
  const std::string bound = transfer_bound(backend, "memory and FP64 issue of the cores");
  if (ours) return our_case(name, bound, backend, p, memory);
  p.pinned = memory == HostMemory::pinned;
  return sod::baseline_case(name, bound, backend, p);
}

}  // namespace

Table print_gas_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  TransferTable table{
      .title = printed(
          "Table 5.5: steps of gas on %s, microseconds per step; in brackets [Shi], on a Quadro 6000\nseed: "
          "its "
          "scheme (--seed-mode), which copies the state to the device and the fluxes back in each of three "
          "stages\nours: the state stays on the device for %ld steps between two copies\n%s",
          std::string(device::name(backend)).c_str(), sod::baseline_steps,
          device::needs_device(backend)
              ? ""
              : "(a host backend copies within the host, and has no pinned memory)\n"),
      .heading = "method  memory     cells",
      .rows = {},
      .warm_up = warm_up_rounds,
      .rounds = kept_rounds(quick)};
  for (const bool ours : {false, true})
    for (const HostMemory memory : host_memories(backend))
      for (const dissertation::TransferRow& row : dissertation::table_5_5) {
        if (quick && row.cells != 1024 && row.cells != 8192) continue;
        const char* method = ours ? "ours" : "seed";
        table.rows.push_back(
            {.columns = printed("%-6s  %-8s  %6d", method, name(memory), row.cells),
             .memory = memory,
             .make = [=](device::Backend on, HostMemory from) { return case_of(on, from, row.cells, ours); },
             .facts = {{"cells", row.cells}, {"method", method}},
             .printed = printed_times(row)});
      }
  return print_transfers(backend, table, provenance);
}

}  // namespace drogue::perf
