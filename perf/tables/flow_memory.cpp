#include <cstdio>
#include <limits>
#include <memory>

#include "kernels/device/profiling_counters.hpp"
#include "kernels/flow/solver.hpp"
#include "perf/measure/record.hpp"
#include "perf/memory/memory.hpp"
#include "perf/problems/streams.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

/// Change of the standard parameters that needs memory.
struct MemoryVariant {
  const char* name;
  streams::Sides sides;
  void (*apply)(flow::Parameters&);
};
const MemoryVariant memory_variants[] = {
    {"periodic", streams::Sides::periodic, [](flow::Parameters&) {}},
    {"tunnel", streams::Sides::tunnel, [](flow::Parameters&) {}},
    {"periodic/crank-nicolson", streams::Sides::periodic,
     [](flow::Parameters& p) { p.diffusion = flow::Diffusion::crank_nicolson; }},
    {"tunnel/force", streams::Sides::tunnel, [](flow::Parameters& p) { p.external_force = true; }}};

/// Memory of a solver after its first step.
struct Memory {
  std::int64_t arrays = 0;  ///< bytes of all Views
  std::int64_t device = 0;  ///< bytes that the driver counts; 0 on a host
};

Memory memory_of(device::Backend backend, flow::Parameters p) {
  p.fixed_dt = 1e-6;
  const std::int64_t arrays = device::profiling_counters().device_bytes, used = used_device_memory();
  const auto solver = flow::create_solver(backend, p);
  for (const stepping::StateArray& array : solver->state())
    solver->upload(array.name, std::vector<double>(array.size()));
  solver->start();
  solver->advance(std::numeric_limits<double>::max(), 1, {});
  return {device::profiling_counters().device_bytes - arrays,
          backend == device::Backend::cuda ? used_device_memory() - used : 0};
}

}  // namespace

Table print_flow_memory(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  const bool gpu = backend == device::Backend::cuda;
  const std::string name(device::name(backend));
  // Loads what a process needs once, such as kernels and the contexts of libraries.
  for (const MemoryVariant& variant : memory_variants) {
    flow::Parameters p = streams::parameters({8, 8, 8}, variant.sides);
    variant.apply(p);
    memory_of(backend, p);
  }
  device::start_profiling();
  std::printf(
      "Memory of a flow solver on %s, bytes per cell\ngrid         case                      arrays%s\n",
      name.c_str(), gpu ? "    driver" : "");
  Table table;
  for (const int n : quick ? std::vector{32, 64}
                     : gpu ? std::vector{64, 128, 256, 512}
                           : std::vector{64, 128})
    for (const MemoryVariant& variant : memory_variants) {
      const std::array<int, 3> cells = {n, n, n};
      flow::Parameters p = streams::parameters(cells, variant.sides);
      variant.apply(p);
      const Memory memory = memory_of(backend, p);
      const std::int64_t count = static_cast<std::int64_t>(n) * n * n;
      const auto a_cell = [&](std::int64_t bytes) {
        return static_cast<double>(bytes) / static_cast<double>(count);
      };
      const std::string grid = streams::text(cells);
      std::printf("%-11s  %-24s  %6.1f", grid.c_str(), variant.name, a_cell(memory.arrays));
      gpu ? std::printf("    %6.1f\n", a_cell(memory.device)) : std::printf("\n");
      nlohmann::json facts = {
          {"backend", name}, {"cells", count}, {"variant", variant.name}, {"array_bytes", memory.arrays}};
      if (gpu) facts["driver_bytes"] = memory.device;
      table.add({"flow-memory/" + name + "/" + grid + "/" + variant.name, "step", "memory of the device"},
                provenance, facts);
    }
  return table;
}

}  // namespace drogue::perf
