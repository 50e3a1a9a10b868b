#include <cstdio>

#include "perf/measure/record.hpp"
#include "perf/problems/pressure_solves.hpp"
#include "perf/rows/printed.hpp"
#include "perf/rows/rows.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

// Iterative solvers run on the host, where 128^3 cells take too long for a table.
constexpr std::int64_t most_iterated_cells = 1 << 19;
// The range of six samples holds the median with a probability of 1 - 2^-5, the least number above 95 %.
constexpr int iterative_warm_up_rounds = 1, iterative_rounds = 6;

/// Times the direct solves, and then the iterative ones in fewer rounds; in the order of `solves`.
std::vector<Record> measure_solves(const std::vector<PressureSolve>& solves, const std::vector<Case>& cases,
                                   bool quick) {
  std::vector<Record> records(solves.size());
  for (const bool iterative : {false, true}) {
    std::vector<Case> chosen;
    for (std::size_t i = 0; i < solves.size(); ++i)
      if (solves[i].method.iterates() == iterative) chosen.push_back(cases[i]);
    if (chosen.empty()) continue;
    const std::vector<Record> measured =
        iterative ? measure(chosen, iterative_warm_up_rounds, iterative_rounds, {&device_clocks()})
                  : measure(chosen, warm_up_rounds, kept_rounds(quick), {&device_clocks()});
    for (std::size_t i = 0, next = 0; i < solves.size(); ++i)
      if (solves[i].method.iterates() == iterative) records[i] = measured[next++];
  }
  return records;
}

/// Cells per axis.
std::vector<std::array<int, 3>> pressure_grids(bool gpu, bool quick) {
  if (quick) return {{16, 16, 16}};
  std::vector<std::array<int, 3>> grids = {{32, 32, 32}, {64, 64, 64}, {60, 60, 120}, {128, 128, 128}};
  if (gpu) grids.push_back({256, 256, 256});
  return grids;
}

}  // namespace

Table print_flow_pressure(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  const std::string name(device::name(backend));
  std::printf(
      "Pressure solvers on %s\n"
      "grid         sides     solver                 tolerance          ms     95 %% interval    iterations  "
      "residual\n",
      name.c_str());
  Table table;
  for (const std::array<int, 3>& grid : pressure_grids(backend == device::Backend::cuda, quick)) {
    const std::vector<PressureSolve> solves = pressure_solves(
        backend, grid, {streams::Sides::periodic, streams::Sides::walls, streams::Sides::tunnel},
        most_iterated_cells);
    std::vector<Case> cases;
    for (const PressureSolve& solve : solves) cases.push_back(pressure_case(solve));
    const std::vector<Record> records = measure_solves(solves, cases, quick);
    for (std::size_t i = 0; i < solves.size(); ++i) {
      const PressureSolve& solve = solves[i];
      const int iterations = records[i].facts.iterations;
      const std::string iterated = iterations > 0 ? std::to_string(iterations) : "direct";
      const std::string tolerance =
          solve.method.iterates() ? printed("%g", solve.method.tolerance) : "round-off";
      std::printf("%-11s  %-8s  %-21s  %-9s  %10s  %-20s  %10s  %.2g  %s\n", streams::text(grid).c_str(),
                  streams::name(solve.sides), solve.method.name, tolerance.c_str(),
                  median_text(records[i], 1e3, 4).c_str(), interval_text(records[i], 1e3, 4).c_str(),
                  iterated.c_str(), records[i].error, verdict(records[i]));
      nlohmann::json facts = {{"backend", name},
                              {"cells", solve.cell_count()},
                              {"variant", records[i].facts.variant},
                              {"grid", streams::text(grid)},
                              {"sides", streams::name(solve.sides)},
                              {"solver", solve.method.name}};
      if (solve.method.iterates())
        facts.update({{"tolerance", solve.method.tolerance}, {"iterations", iterations}});
      table.add(records[i], provenance, facts);
    }
  }
  return table;
}

}  // namespace drogue::perf
