#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/program/failure.hpp"
#include "perf/compare/speed.hpp"
#include "perf/measure/record.hpp"
#include "perf/problems/sheet.hpp"
#include "perf/problems/sod.hpp"
#include "perf/problems/streams.hpp"
#include "perf/raw/kernel_pair.hpp"
#include "perf/rows/rows.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {

namespace {

using raw::KernelPair;
using raw::Launches;
using raw::Version;

/// Size from which the goal applies: cells or vertices.
constexpr std::int64_t goal_size = 1'000'000;

/// Size of a kernel, and the function that makes its pair.
struct Size {
  std::string name;  ///< kernel and size, as in the name of a record
  std::int64_t cells;
  double round_off;  ///< largest difference that it explains
  std::function<std::unique_ptr<KernelPair>()> make;
};

/// Differences that round-off explains; a wrong term gives one of order 1e-3 or more. Steps of cloth follow
/// one another, and their velocities are small against its waves.
constexpr double round_off_of_one = 1e-12, round_off_of_many = 1e-11;

const char* name_of(Version version) { return version == Version::kokkos ? "kokkos" : "hand-written"; }
const char* name_of(Launches launches) { return launches == Launches::plain ? "plain" : "graph"; }

/// A shock tube after some steps, so that no part of it is at rest by symmetry.
raw::GasProblem gas_problem(device::Backend backend, std::int64_t cells) {
  raw::GasProblem problem{sod::parameters(cells), {}, 0.0};
  const std::shared_ptr<gas::Solver> solver = gas::create_solver(backend, problem.parameters);
  const Sample sample = sod::steps(problem.parameters, backend, solver, 50);
  sample.reset();
  static_cast<void>(sample.work());
  for (std::vector<double>& field : problem.fields) field.resize(static_cast<std::size_t>(cells));
  solver->download(0, {problem.fields[0], problem.fields[1], problem.fields[2]});
  problem.dt = solver->restart_state().last_dt;
  return problem;
}

raw::FabricProblem fabric_problem(device::Backend backend, std::int64_t vertices) {
  raw::FabricProblem problem{sheet::parameters(static_cast<int>(vertices)), {}, {}, 0.0};
  const sheet::State from = sheet::start(problem.parameters);
  problem.x = from.x, problem.v = from.v;
  problem.dt = sheet::default_dt(problem.parameters, *fabric::create_solver(backend, problem.parameters));
  return problem;
}

std::vector<Size> sizes_of(const std::string& app, device::Backend backend, bool quick) {
  std::vector<Size> sizes;
  if (app == "flow") {
    using Box = std::array<int, 3>;
    for (const Box& cells :
         {Box{16, 8, 8}, Box{32, 32, 16}, Box{64, 64, 32}, Box{128, 128, 64}, Box{256, 256, 256}})
      sizes.push_back({"flow-momentum/" + streams::text(cells),
                       static_cast<std::int64_t>(cells[0]) * cells[1] * cells[2], round_off_of_one, [=] {
                         return raw::create_pair(
                             backend, raw::FlowProblem{streams::parameters(cells, streams::Sides::periodic)});
                       }});
  } else {
    for (const std::int64_t cells : {1024, 16'384, 131'072, 1'048'576}) {
      const std::string text = std::to_string(cells);
      if (app == "gas")
        sizes.push_back({"gas-step/" + text, cells, round_off_of_one,
                         [=] { return raw::create_pair(backend, gas_problem(backend, cells)); }});
      else
        sizes.push_back({"springs-step/" + text, cells, round_off_of_many,
                         [=] { return raw::create_pair(backend, fabric_problem(backend, cells)); }});
    }
  }
  if (quick) sizes.resize(2);
  return sizes;
}

/// Steps of a sample of some milliseconds, in whole graphs.
long steps_of(std::int64_t cells) {
  const auto steps = std::clamp<std::int64_t>((std::int64_t{1} << 26) / cells, raw::graph_steps, 512);
  return static_cast<long>(steps / raw::graph_steps * raw::graph_steps);
}

/// Case of a version. `difference` holds that of both, once one of them has computed it.
Case version_case(const std::shared_ptr<KernelPair>& pair, const std::string& name, Version version,
                  Launches launches, const Size& size,
                  const std::shared_ptr<std::optional<double>>& difference) {
  return {.name = name,
          .backend = device::Backend::cuda,
          .unit_of_work = "step",
          .bound = size.cells < 100'000 ? "launch latency" : "that of the kernel of the suite",
          .tolerance = size.round_off,
          .prepare = [=, steps = steps_of(size.cells)] {
            return Sample{[=] { pair->reset(version); },
                          [=] {
                            pair->run(version, launches, steps);
                            return steps;
                          },
                          [=] {
                            if (!*difference) *difference = pair->difference(launches);
                            return **difference;
                          }};
          }};
}

/// Prints the row of two versions.
void print_row(const Size& size, Launches launches, const Record& kokkos, const Record& hand_written,
               const SpeedChange& cost) {
  std::printf("%-26s %-6s", size.name.c_str(), name_of(launches));
  // A wrong result has no time.
  if (!kokkos.passed() || !hand_written.passed()) {
    std::printf("  the results differ by %.2g, more than round-off (%.0e): no times\n",
                std::max(kokkos.error, hand_written.error), size.round_off);
    return;
  }
  for (const Record* record : {&kokkos, &hand_written})
    std::printf("  %11s %s", median_text(*record, 1e6, 3).c_str(), interval_text(*record, 1e6, 3).c_str());
  std::printf("  %6.3f [%.3f .. %.3f]  %8.1e", cost.ratio, cost.low, cost.high, kokkos.error);
  if (size.cells >= goal_size) std::printf("  goal <= %.2f %s", largest_version_cost, name(goal(cost)));
  std::printf("\n");
}

/// Measures a size with both forms of launches, versions in turn.
void add_size(const Size& size, device::Backend backend, bool quick, const nlohmann::json& provenance,
              Table& table) {
  const std::shared_ptr<KernelPair> pair = size.make();
  const std::string backend_name(device::name(backend));
  std::vector<Case> cases;
  for (const Launches launches : {Launches::plain, Launches::graph}) {
    const auto difference = std::make_shared<std::optional<double>>();
    for (const Version version : {Version::kokkos, Version::hand_written})
      cases.push_back(version_case(
          pair,
          "abstraction/" + backend_name + "/" + size.name + "/" + name_of(launches) + "/" + name_of(version),
          version, launches, size, difference));
  }
  const std::vector<Record> records = measure(cases, warm_up_rounds, kept_rounds(quick), {&device_clocks()});
  for (std::size_t row = 0; row < 2; ++row) {
    const Launches launches = row == 0 ? Launches::plain : Launches::graph;
    const Record &kokkos = records[2 * row], &hand_written = records[2 * row + 1];
    const SpeedChange cost = compare_speed({hand_written.samples}, {kokkos.samples});
    print_row(size, launches, kokkos, hand_written, cost);
    for (const Version version : {Version::kokkos, Version::hand_written}) {
      nlohmann::json facts = {{"backend", backend_name},     {"cells", pair->cells()},
                              {"version", name_of(version)}, {"launches", name_of(launches)},
                              {"block", pair->block()},      {"steps", steps_of(size.cells)}};
      if (version == Version::kokkos) {
        facts["ratio"] = cost.ratio;
        facts["ratio_low"] = cost.low;
        facts["ratio_high"] = cost.high;
      }
      table.add(version == Version::kokkos ? kokkos : hand_written, provenance, facts);
    }
  }
  std::fflush(stdout);
}

}  // namespace

Table print_abstraction(const std::string& app, device::Backend backend, bool quick,
                        const nlohmann::json& provenance) {
  std::printf(
      "Kernels in Kokkos and the same algorithm in CUDA (perf/raw), in turn, on %s: us per step (median), 95 "
      "%%\n"
      "%-26s %-6s  %-34s  %-34s  %-24s  %s\n",
      provenance["gpu"].get<std::string>().c_str(), "kernel and size", "launch", "Kokkos", "hand-written",
      "ratio", "difference");
  Table table;
  for (const Size& size : sizes_of(app, backend, quick)) {
    try {
      add_size(size, backend, quick, provenance, table);
    } catch (const Failure&) {
      throw;
    } catch (const std::exception& error) {
      // Other sizes may still fit the device.
      std::printf("%-26s  %s\n", size.name.c_str(), error.what());
      table.passed = false;
    }
  }
  std::printf(
      "plain: with the host's part of each launch; graph: captured, %ld steps a launch.\n"
      "Both versions have the same layout, block size and shared memory.\n",
      raw::graph_steps);
  return table;
}

}  // namespace drogue::perf
